/// Texture operations of the interpreter.
#include <cmath>

#include "models/reference/handlers.h"
#include "models/reference/texture_operation.h"

namespace quadrille::models::reference {
namespace {

/// The texture, or of an array the one that a lane takes.
const TextureView& texture_of(const Lanes& lanes, std::uint32_t texture, Slot index, int lane) {
  return lanes.textures->at(texture + (index == kNoSlot ? 0 : lanes.cells[index].u(lane)));
}

/// Does the sampler or the image need more than a plane sampled at one place?
bool is_plain(const TextureView& texture, const TextureInstruction& ask) {
  return ask.kind == TextureInstruction::Kind::kSample && texture.kind == ViewKind::k2D &&
         ask.reference == kNoSlot && ask.gradient_x == kNoSlot && ask.offsets == kNoSlot &&
         ask.offset == std::array<std::int32_t, 3>{} && !is_anisotropic(*texture.sampler);
}

/// The coordinates of one lane, divided where the instruction says so.
Vector coordinates_of(const TextureInstruction& ask, const Lanes& lanes, int lane) {
  Vector at{};
  const double last = ask.projective ? lanes.cells[ask.coordinates + ask.coordinate_cells - 1].f(lane) : 1;
  for (std::uint32_t k = 0; k < 3 && k < ask.coordinate_cells; ++k)
    at.at(k) = lanes.cells[ask.coordinates + k].f(lane) / last;
  return at;
}

/// Of the normalised coordinates, to lane 0. NaN and infinities count as 0.
Vector difference(const TextureInstruction& ask, const Lanes& lanes, int lane) {
  const Vector here = coordinates_of(ask, lanes, lane), origin = coordinates_of(ask, lanes, 0);
  Vector d{};
  for (std::size_t k = 0; k < 3; ++k) d.at(k) = finite_or_zero(here.at(k)) - finite_or_zero(origin.at(k));
  return d;
}

Vector gradient(const TextureView& texture, const Lanes& lanes, Slot slot, int lane) {
  Vector d{};
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(place_dimensions(texture.kind)); ++k)
    d.at(k) = finite_or_zero(lanes.cells[slot + k].f(lane));
  return d;
}

std::array<std::int64_t, 3> offset_of(const TextureView& texture, const TextureInstruction& ask,
                                      const Lanes& lanes, int lane) {
  std::array<std::int64_t, 3> offset{ask.offset[0], ask.offset[1], ask.offset[2]};
  for (std::uint32_t k = 0;
       ask.offsets != kNoSlot && k < static_cast<std::uint32_t>(place_dimensions(texture.kind)); ++k)
    offset.at(k) += static_cast<std::int32_t>(lanes.cells[ask.offsets + k].u(lane));
  return offset;
}

TextureQuestion question_of(const TextureView& texture, const TextureInstruction& ask, const Lanes& lanes,
                            int lane) {
  TextureQuestion q;
  q.at = coordinates_of(ask, lanes, lane);
  if (is_array(texture.kind))
    q.layer =
        lanes.cells[ask.coordinates + static_cast<std::uint32_t>(place_dimensions(texture.kind))].f(lane);
  if (ask.level != kNoSlot) q.level = lanes.cells[ask.level].f(lane);
  if (ask.gradient_x != kNoSlot) {
    q.along_x = gradient(texture, lanes, ask.gradient_x, lane);
    q.along_y = gradient(texture, lanes, ask.gradient_y, lane);
  } else if (ask.level == kNoSlot) {
    q.along_x = difference(ask, lanes, 1);
    q.along_y = difference(ask, lanes, 2);
  }
  if (ask.bias != kNoSlot) q.bias = lanes.cells[ask.bias].f(lane);
  if (ask.reference != kNoSlot) {
    const double last = ask.projective ? lanes.cells[ask.coordinates + ask.coordinate_cells - 1].f(lane) : 1;
    q.reference = lanes.cells[ask.reference].f(lane) / last;
  }
  q.offset = offset_of(texture, ask, lanes, lane);
  return q;
}

Texel plain_sample(const TextureView& texture, const TextureInstruction& ask, const Lanes& lanes, int lane) {
  const Vector at = coordinates_of(ask, lanes, lane);
  if (ask.level != kNoSlot)
    return sample_texture(texture, at[0], at[1], finite_or_zero(lanes.cells[ask.level].f(lane)), 0);
  const Vector x = difference(ask, lanes, 1), y = difference(ask, lanes, 2);
  const double bias = ask.bias == kNoSlot ? 0.0 : lanes.cells[ask.bias].f(lane);
  return sample_texture(texture, at[0], at[1], base_lod(texture, {x[0], x[1]}, {y[0], y[1]}), bias);
}

double shown(const TextureView& texture, const Texel& texel, std::size_t component) {
  const ComponentSource source = texture.components.at(component);
  if (source <= ComponentSource::kAlpha) return texel.at(static_cast<std::size_t>(source));
  return source == ComponentSource::kOne ? 1 : 0;
}

/// Components in the order that the view shows; what a comparison gave stays.
Texel mapped(const TextureView& texture, const TextureInstruction& ask, const Texel& texel) {
  if (ask.reference != kNoSlot) return texel;
  Texel result{};
  for (std::size_t c = 0; c < 4; ++c) result.at(c) = shown(texture, texel, c);
  return result;
}

Texel gather(const TextureView& texture, const TextureInstruction& ask, const Lanes& lanes, int lane) {
  TextureQuestion q = question_of(texture, ask, lanes, lane);
  const auto component = [&](const Texel& texel) {
    return q.reference ? texel[0] : shown(texture, texel, ask.component);
  };
  Texel result{};
  for (std::size_t k = 0; k < 4; ++k) {
    if (ask.four_offsets.empty()) {
      result.at(k) = component(gathered_texels(texture, q).at(k));
    } else {
      q.offset = {ask.four_offsets.at(2 * k), ask.four_offsets.at(2 * k + 1), 0};
      result.at(k) = component(gathered_texels(texture, q)[3]);
    }
  }
  return result;
}

Texel fetch(const TextureView& texture, const TextureInstruction& ask, const Lanes& lanes, int lane) {
  const std::array<std::int64_t, 3> offset = offset_of(texture, ask, lanes, lane);
  const auto dimensions = static_cast<std::uint32_t>(place_dimensions(texture.kind));
  std::array<std::int64_t, 3> place{};
  const auto word = [&](std::uint32_t k) {
    return std::int64_t{static_cast<std::int32_t>(lanes.cells[ask.coordinates + k].u(lane))};
  };
  for (std::uint32_t k = 0; k < dimensions; ++k) place.at(k) = word(k) + offset.at(k);
  if (is_array(texture.kind)) place[2] = word(dimensions);
  const auto number = [&](Slot slot) {
    return slot == kNoSlot ? 0 : std::int64_t{static_cast<std::int32_t>(lanes.cells[slot].u(lane))};
  };
  return fetched_texel(texture, place, number(ask.level), number(ask.sample));
}

Texel answer(const TextureView& texture, const TextureInstruction& ask, const Lanes& lanes, int lane) {
  switch (ask.kind) {
    case TextureInstruction::Kind::kFetch: return mapped(texture, ask, fetch(texture, ask, lanes, lane));
    case TextureInstruction::Kind::kGather: return gather(texture, ask, lanes, lane);
    case TextureInstruction::Kind::kQueryLod: {
      const std::array<double, 2> levels = queried_levels(texture, question_of(texture, ask, lanes, lane));
      return {levels[0], levels[1], 0, 0};
    }
    case TextureInstruction::Kind::kSample: break;
  }
  if (is_plain(texture, ask)) return mapped(texture, ask, plain_sample(texture, ask, lanes, lane));
  return mapped(texture, ask, filtered_texel(texture, question_of(texture, ask, lanes, lane)));
}

}  // namespace

void ask_texture_lanes(const Operation& o, Lanes& lanes) {
  const TextureInstruction& ask = (*lanes.instructions)[o.imm[0]];
  std::array<Cell, 4> result{};
  for (int lane = 0; lane < kLanes; ++lane) {
    if ((lanes.mask >> lane & 1u) == 0) continue;
    const TextureView& texture = texture_of(lanes, ask.texture, ask.index, lane);
    const bool integers =
        traces::is_integer_format(texture.image->format) && ask.kind != TextureInstruction::Kind::kQueryLod;
    const Texel texel = answer(texture, ask, lanes, lane);
    for (std::size_t c = 0; c < 4; ++c) {
      if (!integers) result.at(c).set_f(lane, texel.at(c));
      else result.at(c).set_u(lane, static_cast<std::uint32_t>(std::llround(texel.at(c))));
    }
  }
  for (std::uint32_t c = 0; c < o.n; ++c) write(lanes, lanes.cells[o.dst + c], result.at(c));
}

void query_size(const Operation& o, Lanes& lanes) {
  std::array<Cell, 3> size{};
  for (int lane = 0; lane < kLanes; ++lane) {
    const TextureView& texture = texture_of(lanes, o.imm[0], o.src[0], lane);
    const std::uint32_t level = o.src[1] == kNoSlot ? 0 : lanes.cells[o.src[1]].u(lane),
                        last = texture.levels - 1;
    const std::uint32_t l = texture.first_level + (level <= last ? level : 0);
    const std::uint32_t cubes = texture.layers / (is_cube(texture.kind) ? kCubeFaces : 1);
    std::array<std::uint32_t, 3> all{traces::level_width(*texture.image, l),
                                     traces::level_height(*texture.image, l),
                                     traces::level_depth(*texture.image, l)};
    if (is_array(texture.kind)) all.at(o.n - 1) = cubes;
    for (std::size_t axis = 0; axis < 3; ++axis) size.at(axis).set_u(lane, all.at(axis));
  }
  for (std::uint32_t axis = 0; axis < o.n; ++axis) write(lanes, lanes.cells[o.dst + axis], size.at(axis));
}

void query_samples(const Operation& o, Lanes& lanes) {
  Cell samples;
  for (int lane = 0; lane < kLanes; ++lane)
    samples.set_u(lane, texture_of(lanes, o.imm[0], o.src[0], lane).image->samples);
  write(lanes, lanes.cells[o.dst], samples);
}

void query_levels(const Operation& o, Lanes& lanes) {
  Cell levels;
  for (int lane = 0; lane < kLanes; ++lane)
    levels.set_u(lane, texture_of(lanes, o.imm[0], o.src[0], lane).levels);
  write(lanes, lanes.cells[o.dst], levels);
}

}  // namespace quadrille::models::reference
