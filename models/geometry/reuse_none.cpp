/// No reuse: every corner of a triangle is shaded.
#include "models/geometry/post_transform.h"

namespace quadrille::models {

namespace {

class NoReuse final : public VertexReuse {
 public:
  using VertexReuse::VertexReuse;
  VertexPlace place(std::uint32_t vertex) override { return {slot(), add_lane(vertex)}; }
};

}  // namespace

constinit const VertexReusePolicy kNoReuse{"none", "every corner is shaded: what reuse is measured against",
                                           [](const VertexReuseSetup& setup) -> std::unique_ptr<VertexReuse> {
                                             return std::make_unique<NoReuse>(setup);
                                           }};

}  // namespace quadrille::models
