/// Post-transform reuse: which vertices of a draw are shaded, in which batch and lane, and where a triangle
/// finds those that were shaded before.
///
/// A batch of up to 32 vertices is shaded as one warp. Vertices are told apart by index. Three policies:
///   batch  a vertex is shaded once a batch: a batch carries all that its triangles need. GPUs reuse so [P:
///   Kerbl 2018]. fifo   the vertices shaded last, any of which a later batch's triangle may name: the
///   post-transform cache of older machines none   every corner is shaded
/// The counts are those of meshoptimizer's analyser: (n, n, triangles a batch) for batches of n vertices,
/// (entries, 0, 0) for the FIFO.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

namespace quadrille::models {

enum class ReusePolicy : std::uint8_t { kBatch, kFifo, kNone };

/// A shaded vertex: the slot of its batch, and its lane.
struct VertexPlace {
  std::uint32_t slot = 0;
  std::uint8_t lane = 0;
};

class VertexReuse {
 public:
  static constexpr int kLanes = 32;

  /// Batches of at most `batch_vertices` (3 to 32) vertices; under `kFifo`, `entries` vertices are
  /// remembered.
  explicit VertexReuse(ReusePolicy policy = ReusePolicy::kBatch, int batch_vertices = kLanes,
                       int entries = 0);
  /// Forgets all: vertices of another draw or instance are others.
  void start_draw();
  /// Starts an empty batch that lies in `slot`.
  void start_batch(std::uint32_t slot = 0);
  /// Does a triangle with these vertices fit into the batch? Each corner whose vertex is at hand is free, any
  /// other takes a lane, also where two corners share a new vertex: the hardware's rule, since it looks all
  /// three up at once. Under `kFifo` the corners at hand may push each other out, so three lanes are asked.
  [[nodiscard]] bool fits(const std::array<std::uint32_t, 3>& triangle) const;
  /// Where the vertex is or, if it is not at hand, will be: it then takes the batch's next lane, which must
  /// be there.
  VertexPlace place(std::uint32_t index);
  /// Vertices that the batch shades; lanes 0..size()-1 hold `index(lane)`.
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] std::uint32_t index(int lane) const { return indices_[static_cast<std::size_t>(lane)]; }

  /// Under `kFifo`: may a later triangle still name a vertex of the batch in `slot`?
  [[nodiscard]] bool remembers(std::uint32_t slot) const {
    return slot < remembered_.size() && remembered_[slot] > 0;
  }
  /// Slots of which it does.
  [[nodiscard]] int slots_remembered() const { return slots_remembered_; }
  /// Forgets the oldest vertices until those of at most `slots` slots are left: a store that holds no more.
  void limit_slots(int slots);

 private:
  static constexpr std::uint32_t kSlots = 128;  // at most a quarter full: probes stay short
  [[nodiscard]] static std::uint32_t slot_of(std::uint32_t index) { return (index * 2654435769u) >> 25; }
  [[nodiscard]] int find(std::uint32_t index) const;
  [[nodiscard]] std::uint8_t add_lane(std::uint32_t index);
  void remember(std::uint32_t index, const VertexPlace& place);
  void forget_oldest();

  ReusePolicy policy_;
  int batch_vertices_;
  std::size_t entries_;
  std::uint32_t slot_ = 0;  ///< of the batch
  std::array<std::uint32_t, kLanes> indices_{};
  std::array<std::int8_t, kSlots> lanes_{};  ///< of the batch's vertices, hashed; -1: free
  int size_ = 0;
  std::deque<std::uint32_t> order_;  ///< vertices remembered, the oldest first
  std::unordered_map<std::uint32_t, VertexPlace> places_;
  std::vector<int> remembered_;  ///< vertices, by slot
  int slots_remembered_ = 0;
};

}  // namespace quadrille::models
