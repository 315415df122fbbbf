/// Texture operations of the interpreter.
#include <cmath>

#include "models/reference/handlers.h"

namespace quadrille::models::reference {
namespace {

/// Samples in each running lane at `lod(lane)` with `bias(lane)`.
template <class Lod, class Bias>
void sample_lanes(const Operation& o, Lanes& lanes, const TextureView& texture, const Lod& lod,
                  const Bias& bias) {
  std::array<Cell, 4> result{};
  for (int lane = 0; lane < kLanes; ++lane) {
    if ((lanes.mask >> lane & 1u) == 0) continue;
    const double u = lanes.cells[o.src[0]].f(lane), v = lanes.cells[o.src[0] + 1].f(lane);
    const Texel texel = sample_texture(texture, u, v, lod(lane), bias(lane));
    for (std::size_t c = 0; c < 4; ++c) {
      if (!traces::is_integer_format(texture.image->format)) result[c].set_f(lane, texel[c]);
      else result[c].set_u(lane, static_cast<std::uint32_t>(std::llround(texel[c])));
    }
  }
  for (std::uint32_t c = 0; c < 4; ++c) write(lanes, lanes.cells[o.dst + c], result[c]);
}

/// Difference to lane 0, in normalised coordinates.
std::array<double, 2> difference(const Operation& o, const Lanes& lanes, int lane) {
  std::array<double, 2> d{};
  for (std::uint32_t axis = 0; axis < 2; ++axis) {
    const Cell& c = lanes.cells[o.src[0] + axis];
    d[axis] = finite_or_zero(c.f(lane)) - finite_or_zero(c.f(0));
  }
  return d;
}

}  // namespace

void sample_implicit(const Operation& o, Lanes& lanes) {
  const TextureView& texture = (*lanes.textures)[o.imm[0]];
  const double base = base_lod(texture, difference(o, lanes, 1), difference(o, lanes, 2));
  const auto bias = [&](int lane) { return o.src[1] == kNoSlot ? 0.0 : lanes.cells[o.src[1]].f(lane); };
  sample_lanes(
      o, lanes, texture, [&](int) { return base; }, bias);
}

void sample_explicit(const Operation& o, Lanes& lanes) {
  const auto lod = [&](int lane) { return finite_or_zero(lanes.cells[o.src[1]].f(lane)); };
  sample_lanes(o, lanes, (*lanes.textures)[o.imm[0]], lod, [](int) { return 0.0; });
}

void query_size(const Operation& o, Lanes& lanes) {
  std::array<Cell, 2> size{};
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto extent = level_extent((*lanes.textures)[o.imm[0]], lanes.cells[o.src[1]].u(lane));
    for (std::size_t axis = 0; axis < 2; ++axis) size[axis].set_u(lane, extent[axis]);
  }
  for (std::uint32_t axis = 0; axis < 2; ++axis) write(lanes, lanes.cells[o.dst + axis], size[axis]);
}

void query_levels(const Operation& o, Lanes& lanes) {
  Cell levels;
  for (int lane = 0; lane < kLanes; ++lane) levels.set_u(lane, (*lanes.textures)[o.imm[0]].levels);
  write(lanes, lanes.cells[o.dst], levels);
}

}  // namespace quadrille::models::reference
