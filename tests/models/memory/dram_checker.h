/// Judges a trace of DRAM commands by the rules of a standard, and shares nothing with the model that sent
/// them: it sees the commands of one channel, has a table of numbers of its own (dram_numbers.h), and states
/// every rule as "after this, that, in this scope, not before so many cycles".
///
/// Besides the pairs there are windows (four activations of a rank in t_faw), the state of the banks (which
/// row is open), the buses (a command holds its command bus for its slots, its data the data bus for t_burst)
/// and the debt of refresh. A precharge that a read or write brings with it counts from the cycle at which it
/// begins: no sooner than t_ras after the activation, t_rtp after the read, t_wr after the last data written.
#pragma once

#include "models/memory/dram/command.h"
#include "tests/models/memory/dram_numbers.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quadrille::models {

/// What a rule speaks of. With a read or write that precharges, kRead or kWrite and later kPrecharge.
enum class DramEvent : std::uint8_t { kActivate, kPrecharge, kRead, kWrite, kRefresh, kRefreshBank };
constexpr int kDramEvents = 6;

/// Where the earlier event was, seen from the later one.
enum class DramScope : std::uint8_t {
  kSameBank,
  kSameGroup,
  kOtherGroup,
  kOtherBank,
  kSameRank,
  kOtherRank,
  kSameChannel
};

struct DramPairRule {
  const char* name;
  DramEvent from, to;
  /// kSameGroup takes the bank itself in; kOtherGroup and kOtherBank stay within the rank, kOtherRank within
  /// the pseudo-channel
  DramScope scope;
  std::int64_t distance;
};

struct DramViolation {
  std::string rule;
  std::optional<DramCommand> before;  ///< none where a single command is at fault
  DramCommand command;
  std::int64_t distance = 0;  ///< cycles seen, or what else the rule counts
  std::int64_t required = 0;

  std::string text() const;
};

class DramChecker {
 public:
  explicit DramChecker(const DramNumbers& numbers);

  /// The next command of the channel, no earlier than the one before.
  void check(const DramCommand& command);
  /// The trace ends here: what was due by then must have been refreshed.
  void finish(std::int64_t cycle);

  std::int64_t commands() const { return commands_; }
  std::int64_t violation_count() const { return violation_count_; }
  /// The first hundred.
  const std::vector<DramViolation>& violations() const { return violations_; }

  /// Names of the rules that are no pairs.
  static const std::vector<std::string>& other_rules();

 private:
  struct Latest {
    std::int64_t cycle = kNever;
    DramCommand command;
  };
  using LatestOf = std::array<Latest, kDramEvents>;
  struct Bank {
    LatestOf latest;
    bool open = false;
    std::int32_t row = 0;
    std::int64_t refreshes = 0;
  };
  struct Group {
    LatestOf latest;
  };
  struct Rank {
    LatestOf latest;
    std::array<DramCommand, 4> activations;
    std::int64_t activation_count = 0;
    std::int64_t next_deadline = 0;
    std::vector<Group> groups;
    std::vector<Bank> banks;  ///< group by group
  };
  struct Channel {
    LatestOf latest;
    std::vector<Rank> ranks;
    std::int64_t data_end = kNever;
    DramCommand data_command;
  };
  struct Bus {
    std::int64_t free = kNever;
    DramCommand command;
  };
  static constexpr std::int64_t kNever = -1'000'000'000'000;

  void check_address(const DramCommand& command, bool& legal);
  void check_bus(const DramCommand& command);
  void check_pairs(const DramCommand& command, DramEvent event);
  void check_pair(const DramPairRule& rule, const DramCommand& command, const Latest& latest);
  void check_state(const DramCommand& command, Rank& rank, Bank& bank);
  void check_column(const DramCommand& command, const Bank& bank);
  void check_data(const DramCommand& command, Channel& channel);
  void check_deadline(const DramCommand& command, Rank& rank);
  void count_activation(const DramCommand& command, Rank& rank);
  void count_refresh(const DramCommand& command, Rank& rank, Bank& bank);
  void settle_deadline(Rank& rank);
  void record(const DramCommand& command, DramEvent event, std::int64_t cycle);
  std::int64_t precharge_cycle(const DramCommand& command, const Bank& bank) const;
  int bank_index(const DramCommand& command) const {
    return command.bank_group * numbers_.banks_per_group() + command.bank;
  }
  void report(const char* rule, const DramCommand* before, const DramCommand& command, std::int64_t distance,
              std::int64_t required);

  DramNumbers numbers_;
  std::array<std::vector<DramPairRule>, kDramEvents> rules_to_;
  std::vector<Channel> channels_;
  std::vector<Bus> buses_;
  DramCommand last_;
  std::int64_t commands_ = 0;
  std::int64_t violation_count_ = 0;
  std::vector<DramViolation> violations_;
};

}  // namespace quadrille::models
