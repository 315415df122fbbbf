/// A small frame on a machine with some parameters set, in a process of its own: what the contract tests over
/// the machine plan look at.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::pipeline::test {

using Settings = std::vector<std::pair<std::string, std::string>>;

struct PlanRun {
  std::string failure;              ///< an abort's or an error's message; empty when the run ended well
  std::vector<std::string> broken;  ///< laws, and what a strict driver found
  std::uint64_t digest = 0;         ///< of colour and depth
  std::uint64_t actions = 0;
  std::int64_t cycles = 0;
  std::map<std::string, std::uint64_t> tokens;  ///< by class of links
  std::map<std::string, std::uint64_t> acted;   ///< by kind of unit: actions
};

/// A frame that needs every unit and every link.
[[nodiscard]] const traces::CommandStream& plan_frame();
/// Runs a frame; with `strict` by the driver of tests/hw/base/strict_driver.h. The triangle store is small
/// unless `settings` say more, so that set-up has to be told what is retired.
[[nodiscard]] PlanRun run_plan(const Settings& settings, bool strict = false,
                               const traces::CommandStream& stream = plan_frame());
/// What is wrong with a run of the frame, which should end, keep all laws and draw what the functional
/// rendering draws; empty: nothing.
[[nodiscard]] std::string faults_on(const Settings& settings, const traces::CommandStream& stream);
/// A built-in scene at 96x54, validated.
[[nodiscard]] traces::CommandStream small_scene(const char* name);

}  // namespace quadrille::pipeline::test
