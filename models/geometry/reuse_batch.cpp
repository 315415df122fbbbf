/// Reuse within a batch: a vertex is shaded once a batch, and a batch carries all that its triangles need.
/// GPUs reuse so. [P: Kerbl 2018]
#include "models/geometry/post_transform.h"

#include <algorithm>

namespace quadrille::models {

namespace {

class BatchReuse final : public VertexReuse {
 public:
  explicit BatchReuse(const VertexReuseSetup& setup) : VertexReuse(setup) { lanes_.fill(-1); }
  void start_batch(std::uint32_t slot) override {
    VertexReuse::start_batch(slot);
    lanes_.fill(-1);
  }
  VertexPlace place(std::uint32_t vertex) override {
    const int lane = find(vertex);
    if (lane >= 0) return {slot(), static_cast<std::uint8_t>(lane)};
    const std::uint8_t added = add_lane(vertex);
    std::uint32_t at = home_of(vertex);
    while (lanes_[at] >= 0) at = (at + 1) % kPlaces;
    lanes_[at] = static_cast<std::int8_t>(added);
    return {slot(), added};
  }

 protected:
  /// Each corner whose vertex is at hand is free, any other takes a lane, also where two corners share a new
  /// vertex: the hardware's rule, since it looks all of them up at once.
  [[nodiscard]] int lanes_for(std::span<const std::uint32_t> primitive) const override {
    return static_cast<int>(
        std::ranges::count_if(primitive, [this](std::uint32_t v) { return find(v) < 0; }));
  }

 private:
  static constexpr std::uint32_t kPlaces = 128;  // at most a quarter full: probes stay short
  [[nodiscard]] static std::uint32_t home_of(std::uint32_t vertex) { return (vertex * 2654435769u) >> 25; }
  /// Its lane; -1 for none.
  [[nodiscard]] int find(std::uint32_t vertex) const {
    for (std::uint32_t at = home_of(vertex);; at = (at + 1) % kPlaces) {
      const int lane = lanes_[at];
      if (lane < 0 || index(lane) == vertex) return lane;
    }
  }

  std::array<std::int8_t, kPlaces> lanes_{};  ///< of the batch's vertices, hashed; -1: free
};

}  // namespace

constinit const VertexReusePolicy kBatchReuse{
    "batch", "a vertex is shaded once a batch, which carries all that its triangles need: as GPUs do",
    [](const VertexReuseSetup& setup) -> std::unique_ptr<VertexReuse> {
      return std::make_unique<BatchReuse>(setup);
    }};

}  // namespace quadrille::models
