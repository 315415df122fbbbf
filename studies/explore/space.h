/// The machines of a sweep: values of its dimensions, what follows from them, and what is left out.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/machine/machine_config.h"
#include "studies/explore/sweep.h"

namespace quadrille::studies::explore {

/// A machine to draw with.
struct Candidate {
  std::string machine;              ///< the name or file that it is made from
  std::vector<std::string> values;  ///< by dimension of the sweep
  std::string hash;                 ///< of every parameter's value
};

/// Candidates, each another machine, and how many values of the dimensions make none.
struct Plan {
  std::vector<Candidate> candidates;
  std::uint64_t tried = 0, repeated = 0;
  std::map<std::string, std::uint64_t> excluded;  ///< by reason
};

class Space {
 public:
  /// Checks the names that formulas use, but those of figures. Throws `UserError`. The sweep must outlive it.
  explicit Space(const Sweep& sweep);

  /// The machine with these values. Throws `UserError` for one that cannot be.
  void configure(std::span<const std::string> values, pipeline::MachineConfig& machine) const;
  /// The value of a parameter of a configured machine, of a dimension, or of what is derived; none when there
  /// is no such name. Throws `UserError` when it is no number.
  [[nodiscard]] std::optional<double> value(const std::string& name, std::span<const std::string> values,
                                            const pipeline::MachineConfig& machine) const;
  /// Adds the machine to the plan, or the reason why it is left out.
  void add(std::vector<std::string> values, Plan& plan) const;
  /// All machines of the grid. Throws `UserError` when they are too many.
  [[nodiscard]] Plan grid() const;
  /// How many combinations of levels there are; 0: no end of them.
  [[nodiscard]] double size() const;
  /// The machines at places 0..1 of the dimensions, row by row.
  [[nodiscard]] Plan at(std::span<const double> places) const;

 private:
  /// The number of a derived name that is no parameter, of a free dimension or a free setting.
  [[nodiscard]] std::optional<double> free_value(const std::string& name, std::span<const std::string> values,
                                                 const pipeline::MachineConfig& machine) const;
  void check_names(const Expression& formula, std::size_t derived_before) const;

  const Sweep& sweep_;
};

/// The hash of every parameter's value, 16 digits.
[[nodiscard]] std::string machine_hash(const pipeline::MachineConfig& machine);
/// What was set, as KEY=VALUE: what makes the machine again from `candidate.machine` by `--set`.
[[nodiscard]] std::vector<std::string> machine_settings(const pipeline::MachineConfig& from,
                                                        const pipeline::MachineConfig& machine);

}  // namespace quadrille::studies::explore
