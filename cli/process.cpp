#include "cli/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

#include "cli/image_files.h"
#include "models/base/say.h"
#include "traces/unfinished.h"

namespace quadrille::cli {
namespace {

std::optional<Stopwatch> process_watch;
constexpr double kRefreshSeconds = 0.1;

bool pipes_end_us = false;  // SIGPIPE was not ignored when the program started

/// Takes the numbers of closed standard streams. What is open for reading only fails a write, as a closed one
/// does.
void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // the lowest free number
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF) (void)open("/dev/null", O_RDONLY);
  }
}

}  // namespace

void start_process() {
  process_watch.emplace();
  hold_standard_streams();
  signal(SIGXFSZ, SIG_IGN);
  pipes_end_us = signal(SIGPIPE, SIG_IGN) != SIG_IGN;
  traces::remove_unfinished_at_signals();
}

void flush_output() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw std::system_error(errno != 0 ? errno : EIO, std::generic_category(),
                            "standard output cannot be written");
}

void end_by_pipe() {
  if (!pipes_end_us) return;
  signal(SIGPIPE, SIG_DFL);
  raise(SIGPIPE);
}

double wall_seconds() { return process_watch ? process_watch->seconds() : 0; }

Tables::Tables(bool wanted, const std::optional<std::string>& json)
    : place_(!wanted                             ? Place::kNowhere
             : json && is_standard_output(*json) ? Place::kError
                                                 : Place::kOutput) {}

void Tables::print(const std::string& text) const {
  switch (place_) {
    case Place::kOutput:
      (void)std::fwrite(text.data(), 1, text.size(), stdout);
      flush_output();
      return;
    case Place::kError: say(text); return;
    case Place::kNowhere: return;
  }
}

Progress::Progress() : enabled_(isatty(STDERR_FILENO) == 1) {}

void Progress::show(const std::string& text) {
  if (!enabled_) return;
  say(fmt::format("\r\x1b[K{}", text));
  shown_ = true;
}

void Progress::show_cycles(std::int64_t cycles) {
  if (!enabled_) return;
  if (!simulating_) simulating_.emplace();
  const double elapsed = simulating_->seconds();
  if (elapsed < next_ + kRefreshSeconds) return;
  next_ = elapsed;
  const double millions = static_cast<double>(cycles) * 1e-6;
  show(fmt::format("simulating: {:.2f} million cycles, {:.1f} s, {:.2f} million cycles a second", millions,
                   elapsed, millions / elapsed));
}

void Progress::clear() {
  if (!shown_) return;
  say("\r\x1b[K");
  shown_ = false;
}

}  // namespace quadrille::cli
