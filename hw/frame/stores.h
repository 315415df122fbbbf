/// Bounded stores that hold the bulk behind tokens. A slot belongs to the unit that holds its token; the
/// owner named here hands slots out and gets them back by release tokens, so that no unit looks into another.
#pragma once

#include "hw/frame/frame.h"
#include "models/geometry/post_transform.h"
#include "models/raster/primitives.h"
#include "models/raster/span_tiles.h"

#include <bit>
#include <memory>

namespace quadrille::hw {

/// A vertex batch: inputs written by vertex fetch, outputs by a core, read by primitive assembly, clipper and
/// set-up. Owner: vertex fetch.
struct BatchSlot {
  DrawId draw;
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
  bool ends_range = false;  ///< the next front end goes on with the draw
};

using models::ClippedPiece;

/// A triangle, line or point from set-up to its last retired fragment. Owner: set-up.
struct TriangleSlot {
  models::TriangleSetup setup;
  models::LineCoverage line;  ///< of a smooth line
  DrawId draw;
  std::uint32_t instance = 0, primitive = 0;
  std::vector<float> varyings;  ///< 3 a component: a0, a1 - a0, a2 - a0 of the original triangle
};

/// A fragment warp from its packing to its retirement. Owner: the warp packer of its partition.
struct WarpSlot {
  struct Quad {
    std::uint64_t triangle = 0;
    std::uint16_t x = 0, y = 0;  ///< pixel position of the top-left pixel
    std::uint8_t sample = 0;     ///< of a draw by sample: its lanes are of this one
    /// of several samples a pixel: those that it covered when it was packed, a bit each
    std::uint8_t planes = 0;
  };
  DrawId draw;
  int quads = 0;
  bool late = false;             ///< depth is tested after shading
  models::LaneMask covered = 0;  ///< live lanes at launch
  std::array<Quad, models::kWarpQuads> quad;
  models::LaneMask alive = 0;        ///< lanes to write: covered, not discarded, not failed late
  std::uint64_t packed_samples = 0;  ///< live ones at launch
  /// Of several samples a pixel: by lane, those that are covered, a bit each; masks of samples and the late
  /// depth test take some.
  std::array<std::uint8_t, models::kWarpLanes> samples{};
  /// by colour attachment; those that the draw's program writes
  std::array<std::array<models::LaneFloats, 4>, models::kMaxColorAttachments> color;
  models::LaneFloats depth;
  /// Live lanes (bits 0..3) of a quad of which a sample is to be written; `count` samples a pixel.
  [[nodiscard]] models::LaneMask lanes_of(int q, int count = 1, int sample = 0) const {
    models::LaneMask lanes = (alive >> (4 * q)) & 0xf;
    if (count == 1) return lanes;
    for (unsigned i = 0; i < 4; ++i)
      if ((samples[4 * static_cast<std::size_t>(q) + i] >> sample & 1) == 0) lanes &= ~(1u << i);
    return lanes;
  }
  /// Samples of all lanes that are alive; `count` a pixel.
  [[nodiscard]] std::uint64_t alive_samples(int count) const;
};

inline std::uint64_t WarpSlot::alive_samples(int count) const {
  if (count == 1) return static_cast<std::uint64_t>(std::popcount(alive));
  std::uint64_t sum = 0;
  for (models::LaneMask lanes = alive; lanes != 0; lanes &= lanes - 1)
    sum += static_cast<std::uint64_t>(  // a bit each
        std::popcount(samples[static_cast<std::size_t>(std::countr_zero(lanes))]));
  return sum;
}

/// `Slot` names a place: a number, or an id where one could be taken for another.
template <class T, class Slot = std::uint64_t>
class Store {
 public:
  explicit Store(std::size_t slots) : slots_(slots) {}
  [[nodiscard]] T& operator[](Slot slot) { return slots_[place_of(slot)]; }
  [[nodiscard]] const T& operator[](Slot slot) const { return slots_[place_of(slot)]; }
  [[nodiscard]] std::uint64_t size() const { return slots_.size(); }

 private:
  static std::size_t place_of(std::uint64_t slot) { return static_cast<std::size_t>(slot); }
  template <class Tag>
  static std::size_t place_of(models::Id<Tag> slot) {
    return slot.index();
  }
  std::vector<T> slots_;
};
/// The fragment warps of a partition.
using WarpStore = Store<WarpSlot, WarpSlotId>;

/// Coverage of tiles that were walked, on their way to the fine rasteriser: a place beside each that the link
/// holds, used in turn, so none has to be handed back. Owner: the coarse rasteriser.
class WalkedStore {
 public:
  explicit WalkedStore(std::size_t link_depth) : places_(link_depth) {}
  /// Returns the place.
  std::uint32_t put(const models::TileCoverage& coverage) {
    next_ = next_ + 1 == places_.size() ? 0 : next_ + 1;
    places_[next_] = coverage;
    return next_;
  }
  [[nodiscard]] const models::TileCoverage& operator[](std::uint32_t place) const { return places_[place]; }

 private:
  std::vector<models::TileCoverage> places_;
  std::uint32_t next_ = 0;
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
