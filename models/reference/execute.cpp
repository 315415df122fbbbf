/// Running decoded shaders: the block loop for four lanes, and moving cells about.
#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/reference/handlers.h"

namespace quadrille::models::reference {
namespace {

constexpr std::uint32_t kDone = 0xffffffffu;
constexpr int kMaxBlocksRun = 1 << 22;

bool running(const Lanes& lanes, int lane) { return (lanes.mask >> lane & 1u) != 0; }

/// Where each lane is. Always the lowest-numbered waiting block runs, for all lanes that wait there.
class Execution {
 public:
  Execution(const ShaderProgram& program, Lanes& lanes, unsigned start) : program_(program), lanes_(lanes) {
    for (int lane = 0; lane < kLanes; ++lane)
      at_[static_cast<std::size_t>(lane)] = (start >> lane & 1u) != 0 ? 0 : kDone;
  }

  void run() {
    for (int count = 0;; ++count) {
      const std::uint32_t block = *std::min_element(at_.begin(), at_.end());
      if (block == kDone) return;
      if (count > kMaxBlocksRun)
        throw user_error("shader '{}': runs more than {} blocks for one quad: a loop that does not end?",
                         program_.name, kMaxBlocksRun);
      lanes_.mask = 0;
      for (unsigned lane = 0; lane < kLanes; ++lane) lanes_.mask |= at_[lane] == block ? 1u << lane : 0u;
      run_block(program_.blocks[block]);
    }
  }

 private:
  void run_code(std::uint32_t first, std::uint32_t count) {
    const Operation* operation = program_.code.data() + first;
    for (const Operation* end = operation + count; operation != end; ++operation)
      operation->run(*operation, lanes_);
  }

  void run_block(const Block& block) {
    run_code(block.first, block.count);
    const unsigned here = lanes_.mask;
    switch (block.end) {
      case BlockEnd::kStop: leave(here, kDone); break;
      case BlockEnd::kKill: lanes_.killed |= here; [[fallthrough]];
      case BlockEnd::kJump: take(block.first_edge, here); break;
      case BlockEnd::kBranch: {
        const unsigned chosen = here & lanes_where(block.condition, 0, true);
        take(block.first_edge, chosen);
        take(block.first_edge + 1, here & ~chosen);
        break;
      }
      case BlockEnd::kSwitch: {
        unsigned left = here;
        for (std::uint32_t edge = block.first_edge + 1; edge < block.first_edge + block.edges; ++edge) {
          const unsigned chosen = left & lanes_where(block.condition, program_.edges[edge].literal, false);
          take(edge, chosen);
          left &= ~chosen;
        }
        take(block.first_edge, left);
        break;
      }
    }
  }

  /// Lanes whose cell equals the literal, or (`other`) does not.
  [[nodiscard]] unsigned lanes_where(Slot slot, std::uint32_t literal, bool other) {
    unsigned mask = 0;
    for (int lane = 0; lane < kLanes; ++lane)
      mask |= ((lanes_.at(slot)->u(lane) == literal) != other) ? 1u << lane : 0u;
    return mask;
  }

  void take(std::uint32_t edge_index, unsigned mask) {
    if (mask == 0) return;
    const Edge& edge = program_.edges[edge_index];
    lanes_.mask = mask;
    run_code(edge.first, edge.count);
    leave(mask, edge.target);
  }

  void leave(unsigned mask, std::uint32_t target) {
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      if ((mask >> lane & 1u) != 0) at_[lane] = target;
    }
  }

  const ShaderProgram& program_;
  Lanes& lanes_;
  std::array<std::uint32_t, kLanes> at_{};
};

}  // namespace

void execute(const ShaderProgram& program, Lanes& lanes, unsigned start) {
  Execution(program, lanes, start).run();
}

void copy_cells(const Operation& o, Lanes& lanes) {
  Cell* dst = lanes.at(o.dst);
  const Cell* src = lanes.at(o.src[0]);
  for (std::uint32_t i = 0; i < o.n; ++i) write(lanes, dst[i], src[i * o.step[0]]);
}

void gather_cells(const Operation& o, Lanes& lanes) {
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!running(lanes, lane)) continue;
    const Slot src = o.src[0] + lanes.at(o.src[1])->u(lane);
    const auto l = static_cast<std::size_t>(lane);
    for (std::uint32_t i = 0; i < o.n; ++i) lanes.cells[o.dst + i].bits[l] = lanes.cells[src + i].bits[l];
  }
}

void scatter_cells(const Operation& o, Lanes& lanes) {
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!running(lanes, lane)) continue;
    const Slot dst = o.dst + lanes.at(o.src[1])->u(lane);
    const auto l = static_cast<std::size_t>(lane);
    for (std::uint32_t i = 0; i < o.n; ++i) lanes.cells[dst + i].bits[l] = lanes.cells[o.src[0] + i].bits[l];
  }
}

void scale_index(const Operation& o, Lanes& lanes) {
  Cell result;
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto signed_index = static_cast<std::int32_t>(lanes.at(o.src[0])->u(lane));
    const std::uint32_t index =
        signed_index < 0 ? 0u : std::min(static_cast<std::uint32_t>(signed_index), o.imm[0] - 1);
    const std::uint32_t before = o.src[1] == kNoSlot ? 0u : lanes.at(o.src[1])->u(lane);
    result.set_u(lane, before + index * o.imm[1]);
  }
  write(lanes, *lanes.at(o.dst), result);
}

void extract_dynamic(const Operation& o, Lanes& lanes) {
  Cell result;
  for (int lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t index = std::min(lanes.at(o.src[1])->u(lane), o.n - 1);
    result.bits[static_cast<std::size_t>(lane)] =
        lanes.cells[o.src[0] + index].bits[static_cast<std::size_t>(lane)];
  }
  write(lanes, *lanes.at(o.dst), result);
}

void insert_dynamic(const Operation& o, Lanes& lanes) {
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!running(lanes, lane)) continue;
    const std::uint32_t index = std::min(lanes.at(o.src[1])->u(lane), o.n - 1);
    lanes.cells[o.dst + index].bits[static_cast<std::size_t>(lane)] =
        lanes.at(o.src[0])->bits[static_cast<std::size_t>(lane)];
  }
}

void kill_lanes(const Operation&, Lanes& lanes) { lanes.killed |= lanes.mask; }

void note_margin(const Operation& o, Lanes& lanes) {
  for (int lane = 0; lane < kLanes; ++lane) {
    double& margin = lanes.discard_margin[static_cast<std::size_t>(lane)];
    if (running(lanes, lane))
      margin = std::min(margin, std::abs(lanes.at(o.src[0])->f(lane) - lanes.at(o.src[1])->f(lane)));
  }
}

}  // namespace quadrille::models::reference
