/// A piece of work in a process of its own: what every study runs its frames with.
///
/// SystemC elaborates once in a process, a hostile file may take all memory, and host times mean something
/// only when runs do not share a heap. The child is forked, works under limits, and hands back a string; its
/// end is one of a few known ways, never the parent's end. The parent's end, however, is the child's: none
/// outlives a program that was interrupted.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace quadrille::studies {

enum class ChildEnd : std::uint8_t {
  kDone,
  kRefused,   ///< the work threw `UserError`, or ran out of memory
  kFailed,    ///< the work threw anything else
  kCrashed,   ///< a signal ended it
  kTimedOut,  ///< it was still running at its limit, and was killed
};
/// "done", "refused", "failed", "crashed", "timed out".
[[nodiscard]] const char* child_end_name(ChildEnd end);

struct ChildLimits {
  double seconds = 600;
  /// of address space; 0: no limit. (Sanitizers reserve terabytes: give none in a sanitized build.)
  std::uint64_t memory_bytes = 0;
  bool keep_log = false;  ///< what it says on standard error goes to `ChildRun::log`
};

struct ChildRun {
  ChildEnd end = ChildEnd::kFailed;
  std::string output;  ///< what the work returned, or one line that says how it ended instead
  std::string log;     ///< with `keep_log`: the last 64 KiB of it
  double wall_s = 0, cpu_s = 0;
  double peak_rss_mib = 0;  ///< of the child, with what it inherited resident
};

/// Runs `work` in a forked child. Call it with no other thread running. Throws `UserError` when the host
/// cannot fork.
[[nodiscard]] ChildRun run_in_child(const std::function<std::string()>& work, const ChildLimits& limits = {});

/// What the work returned. Throws `UserError` when it was refused or ran out of time, `std::runtime_error`
/// when it failed or crashed. `about` leads the message, which keeps its lines: a machine that cannot
/// progress says who waits for whom in a table.
[[nodiscard]] std::string output_of(const ChildRun& run, const std::string& about);

/// A piece of work for `run_in_children`.
struct ChildWork {
  std::function<std::string()> work;
  ChildLimits limits;
  std::function<void()> before = {};  ///< called here, just before the fork: what the child is to inherit
};
/// Runs all works, up to `jobs` children at a time, in their order; `done(i, run)` is called here, as each
/// ends.
void run_in_children(std::span<const ChildWork> works, int jobs,
                     const std::function<void(std::size_t, const ChildRun&)>& done);

}  // namespace quadrille::studies
