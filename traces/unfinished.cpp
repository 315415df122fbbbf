#include "traces/unfinished.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <csignal>
#include <cstring>

namespace quadrille::traces {
namespace {

struct Place {
  std::array<char, PATH_MAX> path{};
  std::atomic<bool> taken = false;
};
std::array<Place, 8> places;  // a signal handler may not allocate, lock or call what does

/// Only calls that are safe in a handler. [POSIX.1-2017, 2.4.3]
void remove_and_end(int number) {
  for (std::size_t i = places.size(); i-- > 0;) {
    if (!places[i].taken) continue;
    if (unlink(places[i].path.data()) != 0) rmdir(places[i].path.data());
  }
  signal(number, SIG_DFL);
  raise(number);  // acts when this handler returns
}

}  // namespace

Unfinished::Unfinished(const std::string& path) : place_(0) {
  while (place_ < places.size() && places[place_].taken) ++place_;
  if (place_ == places.size() || path.size() >= PATH_MAX) {
    place_ = places.size();
    return;
  }
  std::memcpy(places[place_].path.data(), path.c_str(), path.size() + 1);
  places[place_].taken = true;
}

Unfinished::~Unfinished() {
  if (place_ < places.size()) places[place_].taken = false;
}

void remove_unfinished_at_signals() {
  for (const int number :
       {SIGHUP,  SIGINT,  SIGQUIT, SIGILL,  SIGTRAP, SIGABRT, SIGBUS,  SIGFPE,    SIGUSR1, SIGSEGV,
        SIGUSR2, SIGPIPE, SIGALRM, SIGTERM, SIGXCPU, SIGXFSZ, SIGPROF, SIGVTALRM, SIGSYS,  SIGPWR}) {
    struct sigaction old {};
    if (sigaction(number, nullptr, &old) != 0 || (old.sa_flags & SA_SIGINFO) != 0 ||
        old.sa_handler != SIG_DFL)
      continue;
    struct sigaction action {};
    action.sa_handler = remove_and_end;
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, nullptr);
  }
}

}  // namespace quadrille::traces
