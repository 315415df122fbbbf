/// Post-transform reuse: a batch of up to 32 distinct vertices is shaded as one warp, and triangles name its lanes.
///
/// Vertices are told apart by index; reuse is within a batch only, so a batch carries all that its triangles need.
#pragma once

#include <array>
#include <cstdint>

namespace quadrille::models {

class VertexReuse {
 public:
  static constexpr int kCapacity = 32;

  VertexReuse() { reset(); }
  /// Starts an empty batch.
  void reset();
  /// Lane of a vertex in this batch, or -1.
  [[nodiscard]] int find(std::uint32_t index) const;
  /// Would these three vertices fit into the batch, counting those that are in it already?
  [[nodiscard]] bool fits(const std::array<std::uint32_t, 3>& triangle) const;
  /// Lane of the vertex; it is added if it is not there. The batch must have room.
  int find_or_add(std::uint32_t index);
  /// Distinct vertices so far; lanes 0..size()-1 hold `index(lane)`.
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] std::uint32_t index(int lane) const { return indices_[static_cast<std::size_t>(lane)]; }

 private:
  static constexpr std::uint32_t kSlots = 128;  // at most a quarter full: probes stay short
  [[nodiscard]] static std::uint32_t slot_of(std::uint32_t index) { return (index * 2654435769u) >> 25; }

  std::array<std::uint32_t, kCapacity> indices_{};
  std::array<std::int8_t, kSlots> lanes_{};  // -1: free
  int size_ = 0;
};

}  // namespace quadrille::models
