/// Traffic for the model of a DRAM controller, whose commands the checker judges: patterns of requests, a
/// driver that keeps the controller's time, and the setting of both from one table of numbers.
#pragma once

#include "models/memory/dram/controller.h"
#include "tests/models/memory/dram_checker.h"
#include "tests/models/memory/dram_numbers.h"
#include "tests/models/random_source.h"

#include <string>
#include <vector>

namespace quadrille::models {

/// The numbers of a data file of configs/memory. What is not in the file is as in `dram_numbers`.
DramNumbers dram_data_file(const std::string& standard);

/// The model's own form of a table.
DramTiming dram_timing(const DramNumbers& numbers);

enum class DramPattern { kReads, kWrites, kCopy, kRandom, kWriteHeavy, kOneBank, kTwoRows, kPauses, kMixed };
const std::vector<DramPattern>& dram_patterns();
const char* dram_pattern_name(DramPattern pattern);

/// A controller's policies as a test names them.
struct DramPolicy {
  std::string name;
  const DramSchedulerPolicy* scheduler;
  const DramPagePolicyEntry* page;
  const DramWriteDrainPolicy* write_drain;
  const DramMappingPolicy* mapping;
  bool hash;
};
const std::vector<DramPolicy>& dram_policies();

struct DramRun {
  std::int64_t commands = 0;
  std::int64_t requests = 0, answers = 0;  ///< taken in; done
  std::int64_t bytes = 0;
  std::int64_t cycles = 0;
  std::int64_t violation_count = 0;
  std::vector<DramViolation> violations;
};

/// Runs at least `commands` commands of a pattern on a controller that goes by `model`, judged by `rules`.
/// With `stop` it ends at the first violation.
struct DramTraffic {
  DramNumbers model, rules;
  DramPattern pattern = DramPattern::kRandom;
  DramPolicy policy = dram_policies().front();
  std::int64_t commands = 0;
  std::uint32_t seed = 1;
  bool stop = false;
};
DramRun run_dram_traffic(const DramTraffic& traffic);

}  // namespace quadrille::models
