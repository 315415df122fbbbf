/// Rasterisation, fragment shading and output of the triangles of one draw instance. Internal to the
/// reference.
#pragma once

#include <span>

#include "models/reference/coverage.h"
#include "models/reference/draw_state.h"
#include "models/reference/primitives.h"
#include "models/reference/vertices.h"

namespace quadrille::models::reference {

/// What a draw needs to shade its fragments. All borrowed.
struct FragmentWork {
  const DrawState* state = nullptr;
  const BoundShader* vertex_shader = nullptr;
  const BoundShader* fragment_shader = nullptr;  ///< null: the pipeline has none; depth alone is written
  const ShadedVertices* vertices = nullptr;
  std::span<const WindowTriangle> triangles;  ///< in the order to draw
  DrawBounds bounds;
  bool float_depth = false;  ///< mode *given*: a depth is rounded to float32 before it is tested
  int threads = 1;
};

/// Draws into the result, in horizontal bands that share nothing, so the outcome does not depend on the
/// threads.
void draw_fragments(const FragmentWork& work, Result& result);

}  // namespace quadrille::models::reference
