#include "pipeline/compiler/order.h"

#include "pipeline/compiler/interleave.h"
#include "pipeline/compiler/passes.h"

#include <algorithm>

namespace quadrille::pipeline {
namespace {

using models::Op;

constexpr int kFewRegisters = 64;  ///< up to here texture instructions stay in groups whatever it costs
/// Longer programs are tried in fewer orders, so that compiling them takes no longer.
constexpr std::size_t kLongProgram = 4096;

class Search {
 public:
  Search(const ScalarShader& shader, const ShaderTarget& target) : shader_(shader), target_(target) {}

  OrderedCode run() {
    std::vector<OrderedCode> grouped = orders_of_few_registers();
    best_ = *std::ranges::min_element(grouped, {}, registers);
    if (registers(best_) > models::kMaxRegisters) return std::move(best_);
    most_ = std::max(registers(best_), target_.most_registers(target_.warps(registers(best_))));
    best_cycles_ = cycles(best_.code);
    for (const OrderedCode& given : grouped) {
      const Interleaver interleaver(given.code, shader_.variable, target_.timing);
      if (shader_.code.size() <= kLongProgram) try_interleaved(interleaver, Preference::kLongestChain);
      try_interleaved(interleaver, Preference::kGivenOrder);
      offer(given);
    }
    return std::move(best_);
  }

 private:
  static int registers(const OrderedCode& ordered) { return ordered.allocation.num_regs; }
  [[nodiscard]] double cycles(const std::vector<ScalarInstruction>& code) const {
    return issue_cycles(code, shader_.variable.size(), target_.timing);
  }
  [[nodiscard]] OrderedCode allocated(std::vector<ScalarInstruction> code) const {
    Allocation allocation = allocate_registers(code, shader_.variable.size());
    return {std::move(code), std::move(allocation)};
  }

  /// The two texture orders; only the source's order where that saves many registers.
  [[nodiscard]] std::vector<OrderedCode> orders_of_few_registers() const {
    std::vector<OrderedCode> orders{allocated(schedule(shader_, Order::kRequests)),
                                    allocated(schedule(shader_, Order::kRequestsDemand))};
    const int fewest = std::min(registers(orders[0]), registers(orders[1]));
    if (fewest <= kFewRegisters) return orders;
    OrderedCode source = allocated(schedule(shader_, Order::kSource));
    const bool saves_many = 2 * registers(source) < fewest || fewest > models::kMaxRegisters;
    if (saves_many && registers(source) < fewest) return {std::move(source)};
    return orders;
  }

  /// Takes the order if it costs no warp and is better.
  void offer(OrderedCode ordered) {
    if (registers(ordered) > most_) return;
    const double needed = cycles(ordered.code);
    if (needed > best_cycles_ || (needed == best_cycles_ && registers(ordered) >= registers(best_))) return;
    best_ = std::move(ordered);
    best_cycles_ = needed;
  }

  /// Finds how many values may be alive so that no warp is lost, and then the fewest for as few cycles.
  void try_interleaved(const Interleaver& interleaver, Preference preference) {
    const bool is_long = shader_.code.size() > kLongProgram;
    const auto with = [&](int live) { return interleaver.run(preference, static_cast<std::size_t>(live)); };
    int live = most_;
    OrderedCode widest = allocated(with(live));
    for (int tries = is_long ? 1 : 4; tries > 0 && registers(widest) > most_; --tries) {
      live -= registers(widest) - most_;
      if (live <= 0) return;
      widest = allocated(with(live));
    }
    const double needed = cycles(widest.code);
    if (registers(widest) > most_ || needed > best_cycles_) return;
    offer(std::move(widest));
    for (int fewest = 0; !is_long && live - fewest > 1;) {
      const int middle = (fewest + live) / 2;
      std::vector<ScalarInstruction> code = with(middle);
      if (cycles(code) > needed) {
        fewest = middle;
        continue;
      }
      live = middle;
      offer(allocated(std::move(code)));
    }
  }

  const ScalarShader& shader_;
  const ShaderTarget& target_;
  OrderedCode best_;
  double best_cycles_ = 0;
  int most_ = 0;  ///< registers that cost no warp
};

/// Whether the shader takes a difference where a neighbour may be idle, or has been since it was discarded
/// inside control flow.
bool differs_in_divergent_flow(const ScalarShader& shader) {
  int depth = 0;
  bool discarded = false;
  return std::ranges::any_of(shader.code, [&](const ScalarInstruction& i) {
    if (i.op == Op::kIf || i.op == Op::kLoop) ++depth;
    if (i.op == Op::kEndIf || i.op == Op::kEndLoop) --depth;
    discarded = discarded || (i.op == Op::kKillIf && depth > 0);
    const bool differs =
        (i.op >= Op::kDdxFine && i.op <= Op::kDdyCoarse) || models::takes_level_from_quad(i.op);
    return differs && (depth > 0 || discarded);
  });
}

}  // namespace

OrderedCode best_order(const ScalarShader& shader, const ShaderTarget& target) {
  static const ShaderTarget default_machine;
  return Search(shader, differs_in_divergent_flow(shader) ? default_machine : target).run();
}

}  // namespace quadrille::pipeline
