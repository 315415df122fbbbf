#include "studies/child_run.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "models/base/error.h"
#include "traces/unfinished.h"

namespace quadrille::studies {
namespace {

using Clock = std::chrono::steady_clock;

// First byte of what a child sends: how it ended.
constexpr char kSaidDone = 'd', kSaidRefused = 'r', kSaidFailed = 'f';

void send(int pipe, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = write(pipe, bytes.data(), bytes.size());
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return;  // the parent is gone
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

/// In the child: whatever ends `parent`, a signal included, ends this process too, by a signal that it can
/// use to remove what it was writing.
void end_with(pid_t parent) {
  for (const int number : {SIGABRT, SIGSEGV, SIGFPE, SIGILL, SIGBUS, SIGTERM, SIGINT})
    signal(number, SIG_DFL);  // handlers are the parent's
  traces::remove_unfinished_at_signals();
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(0);  // it ended before the call
}

[[noreturn]] void work_and_exit(int pipe, const std::function<std::string()>& work,
                                const ChildLimits& limits) {
  setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 1);
  char said = kSaidDone;
  std::string output;
  try {
    if (limits.memory_bytes > 0) {
      const rlimit limit{limits.memory_bytes, limits.memory_bytes};
      setrlimit(RLIMIT_AS, &limit);
    }
    output = work();
  } catch (const UserError& error) {
    said = kSaidRefused;
    output = error.what();
  } catch (const std::bad_alloc&) {
    said = kSaidRefused;
    output = "out of memory";
  } catch (const std::exception& error) {
    said = kSaidFailed;
    output = error.what();
  }
  send(pipe, {&said, 1});
  send(pipe, output);
  std::fflush(nullptr);
  _exit(0);  // destructors and exit handlers belong to the parent
}

/// A child at work, and what it has sent so far.
struct Child {
  pid_t pid = 0;
  int pipe = -1, log = -1;
  std::size_t number = 0;
  Clock::time_point start;
  ChildLimits limits;
  std::string bytes;
  [[nodiscard]] Clock::time_point end() const {
    return start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.seconds));
  }
};

constexpr off_t kLogBytes = 64 << 10;

/// A file without a name, which outlives the child that writes to it.
int open_log() {
  const int log = memfd_create("log", MFD_CLOEXEC);
  if (log < 0) throw user_error("cannot start a run: {}", std::strerror(errno));
  return log;
}

/// The end of it; closes it.
std::string take_log(int log) {
  if (log < 0) return {};
  const off_t size = lseek(log, 0, SEEK_END);
  std::string text(static_cast<std::size_t>(std::clamp<off_t>(size, 0, kLogBytes)), '\0');
  const ssize_t got = pread(log, text.data(), text.size(), std::max<off_t>(0, size - kLogBytes));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  close(log);
  return text;
}

Child start_child(const ChildWork& work, std::size_t number) {
  if (work.before) work.before();
  const int log = work.limits.keep_log ? open_log() : -1;
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw user_error("cannot start a run: {}", std::strerror(errno));
  std::fflush(nullptr);  // what is buffered would be written twice
  const auto start = Clock::now();
  // Until the child has put its own ways of ending in the place of its parent's, the signal that ends it
  // waits.
  sigset_t ending, before;
  sigemptyset(&ending);
  sigaddset(&ending, SIGTERM);
  sigprocmask(SIG_BLOCK, &ending, &before);
  const pid_t parent = getpid(), pid = fork();
  if (pid == 0) end_with(parent);
  const int reason = errno;
  sigprocmask(SIG_SETMASK, &before, nullptr);
  if (pid < 0) {
    close(ends[0]);
    close(ends[1]);
    if (log >= 0) close(log);
    throw user_error("cannot start a run: {}", std::strerror(reason));
  }
  if (pid == 0) {
    close(ends[0]);
    if (log >= 0) dup2(log, STDERR_FILENO);
    work_and_exit(ends[1], work.work, work.limits);
  }
  close(ends[1]);
  return {pid, ends[0], log, number, start, work.limits, {}};
}

/// Takes what the child has sent; false once it has closed its end.
bool receive(Child& child) {
  std::array<char, 1 << 16> part{};
  const ssize_t got = read(child.pipe, part.data(), part.size());
  if (got < 0 && errno == EINTR) return true;
  if (got <= 0) return false;
  child.bytes.append(part.data(), static_cast<std::size_t>(got));
  return true;
}

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

ChildEnd end_of(char said) {
  if (said == kSaidDone) return ChildEnd::kDone;
  return said == kSaidRefused ? ChildEnd::kRefused : ChildEnd::kFailed;
}

/// Reaps a child that has closed its end or has run out of time; the latter is ended by `signal`.
ChildRun finish_child(const Child& child, bool in_time, int signal = SIGKILL) {
  close(child.pipe);
  if (!in_time) kill(child.pid, signal);
  int status = 0;
  rusage usage{};
  while (wait4(child.pid, &status, 0, &usage) < 0 && errno == EINTR) {}
  ChildRun run;
  run.log = take_log(child.log);
  run.wall_s = std::chrono::duration<double>(Clock::now() - child.start).count();
  run.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.peak_rss_mib = static_cast<double>(usage.ru_maxrss) / 1024.0;
  if (!in_time) {
    run.end = ChildEnd::kTimedOut;
    run.output = fmt::format("still running after {:g} s", child.limits.seconds);
  } else if (WIFSIGNALED(status) || child.bytes.empty()) {
    run.end = ChildEnd::kCrashed;
    run.output = WIFSIGNALED(status)
                     ? fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))
                     : fmt::format("left with exit code {}", WEXITSTATUS(status));
  } else {
    run.end = end_of(child.bytes.front());
    run.output = child.bytes.substr(1);
  }
  return run;
}

/// Waits until a child has something to say or is out of time.
void wait_for_any(const std::vector<Child>& children, std::vector<pollfd>& ready) {
  Clock::time_point soonest = children.front().end();
  ready.clear();
  for (const Child& child : children) {
    soonest = std::min(soonest, child.end());
    ready.push_back({child.pipe, POLLIN, 0});
  }
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(soonest - Clock::now()).count();
  poll(ready.data(), ready.size(), static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000)));
}

}  // namespace

const char* child_end_name(ChildEnd end) {
  switch (end) {
    case ChildEnd::kDone: return "done";
    case ChildEnd::kRefused: return "refused";
    case ChildEnd::kFailed: return "failed";
    case ChildEnd::kCrashed: return "crashed";
    case ChildEnd::kTimedOut: return "timed out";
  }
  return "";
}

std::string output_of(const ChildRun& run, const std::string& about) {
  switch (run.end) {
    case ChildEnd::kDone: return run.output;
    case ChildEnd::kRefused:
    case ChildEnd::kTimedOut:
      throw UserError(run.output.starts_with(about + ":") ? run.output
                                                          : fmt::format("{}: {}", about, run.output));
    case ChildEnd::kFailed:
    case ChildEnd::kCrashed: break;
  }
  throw std::runtime_error(fmt::format("{}: {}: {}", about, child_end_name(run.end), run.output));
}

ChildRun run_in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  const ChildWork one{work, limits};
  ChildRun run;
  run_in_children({&one, 1}, 1, [&](std::size_t, const ChildRun& ended) { run = ended; });
  return run;
}

void run_in_children(std::span<const ChildWork> works, int jobs,
                     const std::function<void(std::size_t, const ChildRun&)>& done) {
  /// Children that still run when an exception passes are ended.
  struct Running : std::vector<Child> {
    Running() = default;
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() {
      // which leaves it time to remove what it was writing
      for (const Child& child : *this) (void)finish_child(child, false, SIGTERM);
    }
  } children;
  std::vector<pollfd> ready;
  std::size_t next = 0;
  while (next < works.size() || !children.empty()) {
    while (next < works.size() && children.size() < static_cast<std::size_t>(std::max(1, jobs))) {
      children.push_back(start_child(works[next], next));
      ++next;
    }
    wait_for_any(children, ready);
    for (std::size_t i = children.size(); i-- > 0;) {
      const bool ended = ready[i].revents != 0 && !receive(children[i]);
      if (!ended && Clock::now() < children[i].end()) continue;
      const Child child = std::move(children[i]);
      children.erase(children.begin() + static_cast<std::ptrdiff_t>(i));
      done(child.number, finish_child(child, ended));
    }
  }
}

}  // namespace quadrille::studies
