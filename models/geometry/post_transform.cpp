#include "models/geometry/post_transform.h"

namespace quadrille::models {

VertexReuse::VertexReuse(const VertexReuseSetup& setup) : batch_vertices_(setup.batch_vertices) {
  QUADRILLE_CHECK(batch_vertices_ >= 3 && batch_vertices_ <= kLanes, "a batch of {} vertices",
                  batch_vertices_);
}

std::uint8_t VertexReuse::add_lane(std::uint32_t index) {
  QUADRILLE_CHECK(size_ < batch_vertices_, "vertex batch is full, vertex {} does not fit", index);
  indices_[static_cast<std::size_t>(size_)] = index;
  return static_cast<std::uint8_t>(size_++);
}

// A new policy is its file and its name here.
PolicyList<VertexReusePolicy>& vertex_reuse_policies() {
  static PolicyList<VertexReusePolicy> all{&kBatchReuse, &kFifoReuse, &kNoReuse};
  return all;
}

}  // namespace quadrille::models
