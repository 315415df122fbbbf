/// Bounded stores that hold the bulk behind tokens. A slot belongs to the unit that holds its token; the
/// owner named here hands slots out and gets them back by release tokens, so that no unit looks into another.
#pragma once

#include "hw/frame/frame.h"
#include "models/geometry/post_transform.h"
#include "models/raster/primitives.h"

#include <memory>

namespace quadrille::hw {

/// A vertex batch: inputs written by vertex fetch, outputs by a core, read by primitive assembly, clipper and
/// set-up. Owner: vertex fetch.
struct BatchSlot {
  std::uint32_t draw = 0;
  int lanes = 0;
  models::VertexInputs inputs;
  std::vector<models::LaneWords> attributes;  ///< rows by Program::vertex_inputs
  std::vector<models::LaneWords> outputs;     ///< rows by output slot
  /// a triangle, line or point: a vertex that it lacks is its last one
  struct Triangle {
    models::VertexPlace corner[3];  ///< in this batch, or in an earlier one whose slot is kept
    std::uint32_t primitive;
  };
  std::vector<Triangle> triangles;
};

using models::ClippedPiece;

/// A triangle, line or point from set-up to its last retired fragment. Owner: set-up.
struct TriangleSlot {
  models::TriangleSetup setup;
  models::LineCoverage line;  ///< of a smooth line
  std::uint32_t draw = 0, primitive = 0;
  std::vector<float> varyings;  ///< 3 a component: a0, a1 - a0, a2 - a0 of the original triangle
};

/// A fragment warp from its packing to its retirement. Owner: the warp packer of its partition.
struct WarpSlot {
  struct Quad {
    std::uint64_t triangle = 0;
    std::uint16_t x = 0, y = 0;  ///< pixel position of the top-left pixel
  };
  std::uint32_t draw = 0;
  int quads = 0;
  bool late = false;             ///< depth is tested after shading
  models::LaneMask covered = 0;  ///< live lanes at launch
  std::array<Quad, models::kWarpQuads> quad;
  models::LaneMask alive = 0;  ///< lanes to write: covered, not discarded, not failed late
  /// by colour attachment; those that the draw's program writes
  std::array<std::array<models::LaneFloats, 4>, models::kMaxColorAttachments> color;
  models::LaneFloats depth;
};

template <class T>
class Store {
 public:
  explicit Store(std::size_t slots) : slots_(slots) {}
  [[nodiscard]] T& operator[](std::uint64_t i) { return slots_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const T& operator[](std::uint64_t i) const { return slots_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] std::uint64_t size() const { return slots_.size(); }

 private:
  std::vector<T> slots_;
};

/// The triangle store: a ring addressed by sequence number.
class TriangleStore {
 public:
  explicit TriangleStore(std::size_t slots) : slots_(slots) {}
  [[nodiscard]] TriangleSlot& operator[](std::uint64_t sequence) {
    return slots_[static_cast<std::size_t>(sequence % slots_.size())];
  }
  [[nodiscard]] const TriangleSlot& operator[](std::uint64_t sequence) const {
    return slots_[static_cast<std::size_t>(sequence % slots_.size())];
  }
  [[nodiscard]] std::uint64_t size() const { return slots_.size(); }

 private:
  std::vector<TriangleSlot> slots_;
};

}  // namespace quadrille::hw
