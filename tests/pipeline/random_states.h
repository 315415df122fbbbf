/// Random states of pipelines.
#pragma once

#include "models/base/pipeline_state.h"
#include "tests/pipeline/random_source.h"

namespace quadrille::pipeline::test {

/// Any operations and comparison; masks are whole in most.
inline models::StencilFace random_stencil_face(RandomSource& random) {
  const auto op = [&] { return static_cast<models::StencilOp>(random.integer(0, 7)); };
  const auto mask = [&] {
    return static_cast<std::uint8_t>(random.chance(0.7) ? 0xff : random.integer(0, 255));
  };
  return {static_cast<models::CompareOp>(random.integer(0, 7)), op(), op(), op(), mask(), mask(),
          static_cast<std::uint8_t>(random.integer(0, 4))};
}

}  // namespace quadrille::pipeline::test
