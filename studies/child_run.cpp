#include "studies/child_run.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <new>

#include <fmt/format.h>

#include "models/base/error.h"

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

[[noreturn]] void work_and_exit(int pipe, const std::function<std::string()>& work, const ChildLimits& limits) {
  for (const int number : {SIGABRT, SIGSEGV, SIGFPE, SIGILL, SIGBUS, SIGTERM, SIGINT})
    signal(number, SIG_DFL);  // handlers are the parent's
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

/// Reads until the child closes its end or the limit has passed; false when it has.
bool receive(int pipe, Clock::time_point limit, std::string& bytes) {
  std::array<char, 1 << 16> part{};
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(limit - Clock::now()).count();
    if (left <= 0) return false;
    pollfd ready{pipe, POLLIN, 0};
    if (poll(&ready, 1, static_cast<int>(std::min<std::int64_t>(left, 1'000'000))) <= 0) continue;
    const ssize_t got = read(pipe, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return true;
    bytes.append(part.data(), static_cast<std::size_t>(got));
  }
}

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

ChildEnd end_of(char said) {
  if (said == kSaidDone) return ChildEnd::kDone;
  return said == kSaidRefused ? ChildEnd::kRefused : ChildEnd::kFailed;
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

ChildRun run_in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw user_error("cannot start a run: {}", std::strerror(errno));
  std::fflush(nullptr);  // what is buffered would be written twice
  const auto start = Clock::now();
  const pid_t child = fork();
  if (child < 0) {
    const int reason = errno;
    close(ends[0]);
    close(ends[1]);
    throw user_error("cannot start a run: {}", std::strerror(reason));
  }
  if (child == 0) {
    close(ends[0]);
    work_and_exit(ends[1], work, limits);
  }
  close(ends[1]);
  std::string bytes;
  const bool in_time =
      receive(ends[0], start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.seconds)), bytes);
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {}
  ChildRun run;
  run.wall_s = std::chrono::duration<double>(Clock::now() - start).count();
  run.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.peak_rss_mib = static_cast<double>(usage.ru_maxrss) / 1024.0;
  if (!in_time) {
    run.end = ChildEnd::kTimedOut;
    run.output = fmt::format("still running after {:g} s", limits.seconds);
  } else if (WIFSIGNALED(status) || bytes.empty()) {
    run.end = ChildEnd::kCrashed;
    run.output = WIFSIGNALED(status) ? fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))
                                     : fmt::format("left with exit code {}", WEXITSTATUS(status));
  } else {
    run.end = end_of(bytes.front());
    run.output = bytes.substr(1);
  }
  return run;
}

}  // namespace quadrille::studies
