/// Which slots of the batch store may be used again: those whose own triangles have passed set-up, and all
/// later triangles that name their vertices.
///
/// Set-up releases batches in the order in which they were formed, so a batch is known by its number, and
/// what is released by one count.
#pragma once

#include "models/geometry/post_transform.h"

#include <cstdint>
#include <vector>

namespace quadrille::hw {

class BatchSlots {
 public:
  /// Slots `first` to `first + slots - 1` of the store.
  BatchSlots(std::uint32_t first, std::uint32_t slots);
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(last_use_.size()); }
  [[nodiscard]] bool any_free() const { return !free_.empty(); }
  [[nodiscard]] std::size_t free() const { return free_.size(); }
  /// A slot for the next batch.
  std::uint32_t take();
  /// The newest batch has a triangle that names a vertex in `slot`.
  void note_use(std::uint32_t slot) { last_use_[slot - first_] = taken_; }
  /// The oldest batch that was not released has passed set-up.
  void release() { ++released_; }
  /// Frees the slots that neither a batch on its way nor `reuse` needs.
  void sweep(const models::VertexReuse& reuse);

 private:
  std::uint32_t first_;
  std::uint64_t taken_ = 0, released_ = 0;  ///< batches so far
  /// by slot: number of the last batch that names it, counted from 1
  std::vector<std::uint64_t> last_use_;
  std::vector<std::uint32_t> free_, held_;
};

}  // namespace quadrille::hw
