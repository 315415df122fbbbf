/// A warp with inputs, outputs and a texture unit of its own for tests: set registers, run, look at
/// registers.
#pragma once

#include "models/shader/warp.h"

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace quadrille::models::test {

inline float as_float(std::uint32_t bits) { return std::bit_cast<float>(bits); }
inline std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x); }
inline bool is_nan(std::uint32_t bits) { return (bits & 0x7fffffffu) > 0x7f800000u; }

/// Words that break things: zeros, ones, infinities, NaNs, denormals, borders of conversions.
inline const std::vector<std::uint32_t>& special_words() {
  static const std::vector<std::uint32_t> kWords{
      0u,          0x80000000u, 1u,          2u,          31u,         32u,         33u,
      ~0u,         0x7fffffffu, 0x80000001u, 0x007fffffu, 0x00800000u, 0x3f800000u, 0xbf800000u,
      0x7f800000u, 0xff800000u, 0x7fc00000u, 0xffc00001u, 0x7f7fffffu, 0xff7fffffu, 0x4f000000u,
      0x4effffffu, 0xcf000000u, 0xcf000001u, 0x4f800000u, 0x4f7fffffu, 0x3f000000u, 0x3effffffu,
      0x40200000u, 0xc0200000u, 0x3fc00000u, 0x4b000001u, 0xb3000000u, 0x477fff80u};
  return kWords;
}

/// A special word, a float of moderate size, an integer of moderate size, or any bits.
inline std::uint32_t random_word(std::mt19937& random) {
  switch (random() % 4) {
    case 0: return special_words()[random() % special_words().size()];
    case 1: return bits_of((static_cast<float>(random() % 2000001) - 1000000.0f) / 4096.0f);
    case 2: return static_cast<std::uint32_t>(static_cast<int>(random() % 201) - 100);
    default: return static_cast<std::uint32_t>(random());
  }
}

struct WarpFixture {
  WarpFixture() : attributes(kMaxVertexInputs), outputs(kMaxVaryings + kFirstVaryingOutput), sizes(16) {
    for (std::size_t i = 0; i < kWarpLanes; ++i) {
      vertex.vertex_index[i] = static_cast<std::uint32_t>(100 + i);
      vertex.instance_index[i] = static_cast<std::uint32_t>(7 * i);
      const auto t = static_cast<float>(i);
      fragment.x[i] = t + 0.5f, fragment.y[i] = 2 * t + 0.5f, fragment.z[i] = t / 32,
      fragment.inv_w[i] = 1 / (t + 1);
      fragment.persp_1[i] = t / 64, fragment.persp_2[i] = 0.5f - t / 64, fragment.linear_1[i] = t / 40,
      fragment.linear_2[i] = 0.25f;
      fragment.centroid_persp_1[i] = t / 48, fragment.centroid_persp_2[i] = 0.4f - t / 80;
      fragment.centroid_linear_1[i] = t / 36, fragment.centroid_linear_2[i] = 0.2f;
      fragment.sample_x[i] = t / 33, fragment.sample_y[i] = 1 - t / 35;
      fragment.sample_id[i] = static_cast<std::uint32_t>(i % 8);
      fragment.sample_mask[i] = static_cast<std::uint32_t>(37 * i % 256);
      fragment.front_facing[i] = (i & 4) != 0 ? ~0u : 0u;
      fragment.primitive_id[i] = static_cast<std::uint32_t>(i / 4);
      for (std::size_t a = 0; a < attributes.size(); ++a)
        attributes[a][i] = static_cast<std::uint32_t>(1000 * a + i);
    }
    for (std::size_t q = 0; q < kWarpQuads; ++q) {
      for (std::size_t k = 0; k < 3 * kMaxVaryings; ++k)
        planes[q].push_back(static_cast<float>(static_cast<int>(17 * k + 5 * q) % 23 - 11) / 7);
      fragment.varyings[q] = planes[q].data();
    }
    vertex.attributes = attributes.data();
    warp.vertex = &vertex;
    warp.fragment = &fragment;
    warp.outputs = outputs.data();
    warp.texture_sizes = sizes.data();
  }

  /// Constant file of a program: its literals, and `others` for words that are none.
  void bind_constants(const Program& program, std::uint32_t others = 0) {
    constants.assign(program.constants.words, others);
    for (const auto& range : program.constants.ranges)
      for (std::size_t i = 0; i < range.literals.size(); ++i)
        constants[range.first_word + i] = range.literals[i];
  }

  /// A stand-in for the texture unit: depends on the lane's own request only.
  static std::array<LaneFloats, 4> filtered(const TextureRequest& request) {
    std::array<LaneFloats, 4> rgba;
    for (std::size_t c = 0; c < rgba.size(); ++c)
      for (std::size_t i = 0; i < kWarpLanes; ++i)
        rgba[c][i] =
            request.u[i] * 0.5f + request.v[i] * static_cast<float>(c + 1) + request.lod[i] + request.binding;
    return rgba;
  }

  ClauseCost add(const ClauseCost& a, const ClauseCost& b) const {
    return {a.alu + b.alu,         a.sfu + b.sfu,           a.interp + b.interp,    a.constant + b.constant,
            a.control + b.control, a.exported + b.exported, a.lane_ops + b.lane_ops};
  }

  /// Runs to the end; returns the summed cost. `clauses` counts calls.
  ClauseCost finish() {
    ClauseCost total;
    while (true) {
      const ClauseResult result = run_clause(warp);
      total = add(total, result.cost);
      ++clauses;
      if (result.end == ClauseEnd::kProgramEnd) return total;
      for (int i = 0; i < warp.texture_count; ++i) {
        const TextureRequest& request = warp.textures[static_cast<std::size_t>(i)];
        write_texture_result(warp, request, filtered(request));
      }
    }
  }

  /// Launches with its own literals and runs to the end.
  ClauseCost run(const Program& program, LaneMask lanes = ~0u) {
    bind_constants(program);
    warp.launch(program, constants.data(), lanes);
    return finish();
  }

  std::vector<LaneWords> attributes;
  VertexInputs vertex;
  FragmentInputs fragment;
  std::array<std::vector<float>, kWarpQuads> planes;
  std::vector<LaneWords> outputs;
  std::vector<TextureSize> sizes;
  std::vector<std::uint32_t> constants;
  Warp warp;
  int clauses = 0;
};

}  // namespace quadrille::models::test
