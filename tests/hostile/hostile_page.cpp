/// Writes the table of docs/robustness.md: every group of the hostile run with its counts. `scripts/pages
/// hostile` calls it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "tests/hostile/hostile_case.h"

using namespace quadrille::hostile;

extern "C" int sc_main(int, char**) { return 0; }

int main() {
  int problems = 0;
  fmt::print(
      "| input | tried | drawn or read | refused | slowest | most memory |\n|---|---|---|---|---|---|\n");
  for (Group (*const make)() : all_groups()) {
    const Group group = make();
    int done = 0, refused = 0;
    Outcome most;
    for (const Case& c : group.cases) {
      const Outcome outcome = run_case(c);
      (outcome.exit_code == 0 ? done : refused) += 1;
      most.seconds = std::max(most.seconds, outcome.seconds);
      most.peak_mib = std::max(most.peak_mib, outcome.peak_mib);
      for (const std::string& problem : outcome.problems) {
        fmt::print(stderr, "{}: {}: {}; {}\n", group.name, c.name, problem, outcome.error.substr(0, 300));
        ++problems;
      }
    }
    fmt::print("| {}: {} | {} | {} | {} | {:.1f} s | {:.0f} MiB |\n", group.name, group.about,
               group.cases.size(), done, refused, most.seconds, most.peak_mib);
    std::fflush(stdout);
  }
  return problems == 0 ? 0 : 1;
}
