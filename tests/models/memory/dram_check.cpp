/// Long runs of the DRAM model's commands under the checker, for what CI has no time for: every pattern of
/// requests with every policy, in equal shares.
///   dram_check --standard gddr6 --commands 10000000 --seed 1
/// Prints a line a run and the first violations; exits with 1 if there is any.
#include "tests/models/memory/dram_traffic.h"

#include <fmt/format.h>
#include <chrono>
#include <CLI/CLI.hpp>

using namespace quadrille::models;

namespace {

std::int64_t check_standard(const std::string& standard, std::int64_t commands, std::uint32_t seed) {
  const DramNumbers numbers = dram_data_file(standard);
  const auto shares = static_cast<std::int64_t>(dram_patterns().size() * dram_policies().size());
  std::int64_t violations = 0;
  for (const DramPolicy& policy : dram_policies())
    for (const DramPattern pattern : dram_patterns()) {
      const auto start = std::chrono::steady_clock::now();
      const DramRun run = run_dram_traffic(
          {numbers, dram_numbers(standard), pattern, policy, (commands + shares - 1) / shares, seed++});
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
      const double per_cycle = static_cast<double>(run.bytes) / static_cast<double>(run.cycles);
      fmt::print("{:7} {:27} {:18} {:9} commands {:5.1f} bytes/cycle {:4.1f} million/s {} violations\n",
                 standard, policy.name, dram_pattern_name(pattern), run.commands, per_cycle,
                 static_cast<double>(run.commands) / time.count() / 1e6, run.violation_count);
      for (std::size_t i = 0; i < std::min<std::size_t>(run.violations.size(), 3); ++i)
        fmt::print("  {}\n", run.violations[i].text());
      violations += run.violation_count;
    }
  return violations;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> standards = dram_standards();
  std::int64_t commands = 1'000'000;
  std::uint32_t seed = 1;
  CLI::App app{"Judges the commands of the DRAM model by the rules of its standard."};
  app.add_option("--standard", standards, "Which ones [all]")->check(CLI::IsMember(dram_standards()));
  app.add_option("--commands", commands, "Commands a standard")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seed", seed, "Of the random requests")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  std::int64_t violations = 0;
  for (const std::string& standard : standards) violations += check_standard(standard, commands, seed);
  return violations == 0 ? 0 : 1;
}
