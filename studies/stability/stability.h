/// The catalogue of stiff and extreme cases: `quadrille stability`.
///
/// Each case is a frame at the edge of what numbers or a machine can be, with what must hold of it. It runs
/// in a process of its own under a limit of time, functionally and on the machine; whatever the case, the run
/// has to end, every law and every unit's account has to hold, and image and depth have to be those of the
/// functional run, and the process must not have taken more memory than the case allows. What else must hold
/// is the case's own.
#pragma once

#include "studies/child_run.h"
#include "studies/stability/finding.h"
#include "studies/stability/observed.h"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::studies::stability {

struct Case {
  std::string name;     ///< words joined by '-': selects it, and names its picture
  std::string group;    ///< "numbers" or "machines"
  std::string purpose;  ///< what is extreme about it, one line
  std::string must;     ///< what must hold beyond what every case must, one line
  std::function<traces::CommandStream()> build;
  std::function<void(pipeline::MachineConfig&)> machine = [](pipeline::MachineConfig&) {};
  std::function<void(const Observed&, Findings&)> check = [](const Observed&, Findings&) {};
  std::function<scenes::Rgba8Image(const Observed&)> picture = [](const Observed& o) {
    return as_picture(o.image());
  };
  double seconds = 600;      ///< of wall time, against a hang: the host may be slow and busy
  double memory_mib = 1024;  ///< and takes at most
  bool slow = false;         ///< takes more than a few seconds
};

/// Every case, in the order of the page.
[[nodiscard]] const std::vector<Case>& catalogue();
/// Those whose names match one of the patterns (`*` and `?` as in a shell); all for no pattern. Throws
/// `UserError` for a pattern that matches none.
[[nodiscard]] std::vector<const Case*> select(std::span<const std::string> patterns);

struct CaseResult {
  const Case* about = nullptr;
  ChildRun run;
  Findings findings;
  scenes::Rgba8Image picture;  ///< small; empty when the case did not come to its end
  std::uint32_t width = 0, height = 0;
  std::int64_t cycles = 0;
  std::string limit;  ///< what limits the frame
  [[nodiscard]] bool holds() const { return run.end == ChildEnd::kDone && findings.hold(); }
};

/// What every case must hold to, but for its time and memory.
void check_always(const Observed& observed, Findings& findings);
/// Runs a case here, in this process: once a process.
[[nodiscard]] std::string run_here(const Case& one);
/// Runs cases in children, up to `jobs` at a time; `done` is called in the order in which they end. The
/// results are in the order of `cases`.
[[nodiscard]] std::vector<CaseResult> run_cases(std::span<const Case* const> cases, int jobs,
                                                const std::function<void(const CaseResult&)>& done);

// The parts of the catalogue, one file each.
void add_edge_cases(std::vector<Case>& cases);     ///< clipping, coverage, shared edges
void add_range_cases(std::vector<Case>& cases);    ///< depth ranges, worlds, distances
void add_value_cases(std::vector<Case>& cases);    ///< NaN, infinity, denormals
void add_format_cases(std::vector<Case>& cases);   ///< limits of the formats of attachments
void add_target_cases(std::vector<Case>& cases);   ///< sizes, nothing at all, very much
void add_machine_cases(std::vector<Case>& cases);  ///< extreme machines

}  // namespace quadrille::studies::stability
