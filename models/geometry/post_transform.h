/// Post-transform reuse: which vertices of a draw are shaded, in which batch and lane, and where a triangle
/// (or a line, or a point) finds those that were shaded before. One file a policy (reuse_*.cpp).
///
/// A batch of up to 32 vertices is shaded as one warp. Vertices are told apart by index. The counts are those
/// of meshoptimizer's analyser: (n, n, triangles a batch) for batches of n vertices, (entries, 0, 0) for the
/// FIFO.
#pragma once

#include "models/base/policy.h"

#include <array>
#include <cstdint>
#include <span>

namespace quadrille::models {

/// A shaded vertex: the slot of its batch, and its lane.
struct VertexPlace {
  std::uint32_t slot = 0;
  std::uint8_t lane = 0;
};

/// Numbers of the machine that policies use.
struct VertexReuseSetup {
  int batch_vertices = 32;  ///< of a batch, at most: 3 to 32
  int entries = 0;          ///< `fifo`: vertices that are remembered
};

class VertexReuse {
 public:
  static constexpr int kLanes = 32;

  explicit VertexReuse(const VertexReuseSetup& setup);
  virtual ~VertexReuse() = default;
  /// Forgets all: vertices of another draw or instance are others.
  virtual void start_draw() {}
  /// Starts an empty batch that lies in `slot`.
  virtual void start_batch(std::uint32_t slot) {
    size_ = 0;
    slot_ = slot;
  }
  /// Does a primitive with these vertices fit into the batch?
  [[nodiscard]] bool fits(std::span<const std::uint32_t> primitive) const {
    return size_ + lanes_for(primitive) <= batch_vertices_;
  }
  /// Where the vertex is or, if it is not at hand, will be: it then takes the batch's next lane, which must
  /// be there.
  virtual VertexPlace place(std::uint32_t index) = 0;
  /// Vertices that the batch shades; lanes 0..size()-1 hold `index(lane)`.
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] std::uint32_t index(int lane) const { return indices_[static_cast<std::size_t>(lane)]; }

  // Of policies that remember vertices of earlier batches.
  /// May a later triangle still name a vertex of the batch in `slot`?
  [[nodiscard]] virtual bool remembers(std::uint32_t /*slot*/) const { return false; }
  /// Slots of which it does.
  [[nodiscard]] virtual int slots_remembered() const { return 0; }
  /// Forgets the oldest vertices until those of at most `slots` slots are left: a store that holds no more.
  virtual void limit_slots(int /*slots*/) {}

 protected:
  /// Lanes to have at hand for a primitive.
  [[nodiscard]] virtual int lanes_for(std::span<const std::uint32_t> primitive) const {
    return static_cast<int>(primitive.size());
  }
  /// The next lane of the batch takes the vertex.
  std::uint8_t add_lane(std::uint32_t index);
  [[nodiscard]] std::uint32_t slot() const { return slot_; }

 private:
  int batch_vertices_;
  std::uint32_t slot_ = 0;  ///< of the batch
  std::array<std::uint32_t, kLanes> indices_{};
  int size_ = 0;
};

using VertexReusePolicy = Policy<VertexReuse, const VertexReuseSetup&>;
/// What `vertex_fetch.reuse` chooses from.
[[nodiscard]] PolicyList<VertexReusePolicy>& vertex_reuse_policies();
extern const VertexReusePolicy kBatchReuse, kFifoReuse, kNoReuse;

}  // namespace quadrille::models
