/// A sampler written from the specification, one lane at a time in double: the ruler for the texture unit's
/// tests.
#pragma once

#include "models/base/sampler.h"
#include "models/precision.h"
#include "models/rop/srgb.h"
#include "models/shader/warp.h"
#include "models/texture/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace quadrille::models {

using Color = std::array<double, 4>;

/// A mip chain as plain rows.
struct PlainTexture {
  Format format = Format::kR8G8B8A8Unorm;
  std::uint32_t width = 1, height = 1, levels = 1;
  std::vector<std::byte> texels;

  [[nodiscard]] std::uint32_t level_width(std::uint32_t level) const { return std::max(width >> level, 1u); }
  [[nodiscard]] std::uint32_t level_height(std::uint32_t level) const {
    return std::max(height >> level, 1u);
  }
  [[nodiscard]] Color texel(std::uint32_t level, std::int64_t x, std::int64_t y) const {
    std::size_t first = 0;
    for (std::uint32_t i = 0; i < level; ++i) first += std::size_t{level_width(i)} * level_height(i);
    const std::size_t index =
        4 * (first + static_cast<std::size_t>(y) * level_width(level) + static_cast<std::size_t>(x));
    Color color;
    for (std::size_t c = 0; c < 4; ++c) {
      const auto code = static_cast<std::uint8_t>(texels.at(index + c));
      color[c] =
          format == Format::kR8G8B8A8Srgb && c < 3 ? static_cast<double>(decode_srgb8(code)) : code / 255.0;
    }
    return color;
  }
};

class ScalarSampler {
 public:
  ScalarSampler(const PlainTexture& texture, const SamplerState& sampler, const Precision& precision)
      : texture_(texture), sampler_(sampler), precision_(precision) {}

  /// Level of detail of a lane; all of its quad is in the request. [VK1.3
  /// #textures-level-of-detail-operation]
  [[nodiscard]] double lambda(const TextureRequest& r, std::size_t lane) const {
    double base, bias = static_cast<double>(sampler_.lod_bias);
    if (r.op == Op::kTexLod) {
      base = finite(r.lod[lane]);
    } else {
      const std::size_t quad = lane / 4 * 4;
      const auto length = [&](std::size_t other) {
        const double du = (finite(r.u[other]) - finite(r.u[quad])) * texture_.width,
                     dv = (finite(r.v[other]) - finite(r.v[quad])) * texture_.height;
        return std::sqrt(du * du + dv * dv);
      };
      base = std::log2(std::max({length(quad + 1), length(quad + 2), 1e-15}));
      if (r.op == Op::kTexBias) bias += finite(r.lod[lane]);
    }
    const double limited =
        std::clamp(bias, -static_cast<double>(kMaxLodBias), static_cast<double>(kMaxLodBias));
    const double l = std::clamp(base + limited, static_cast<double>(sampler_.min_lod),
                                static_cast<double>(sampler_.max_lod));
    return std::nearbyint(std::ldexp(l, precision_.lod_bits)) / std::ldexp(1.0, precision_.lod_bits);
  }

  [[nodiscard]] Color sample(double u, double v, double l) const {
    const Filter filter = l <= 0 ? sampler_.mag : sampler_.min;
    const double d = std::clamp(l, 0.0, static_cast<double>(texture_.levels - 1));
    if (sampler_.mip == Filter::kNearest)
      return filtered(filter, u, v, static_cast<std::uint32_t>(std::ceil(d + 0.5) - 1));
    const auto high = static_cast<std::uint32_t>(std::floor(d));
    const std::uint32_t low = std::min(high + 1, texture_.levels - 1);
    return mix(filtered(filter, u, v, high), filtered(filter, u, v, low), d - std::floor(d));
  }

  static double finite(float value) { return std::isfinite(value) ? static_cast<double>(value) : 0.0; }

 private:
  static Color mix(const Color& a, const Color& b, double t) {
    Color out;
    for (std::size_t c = 0; c < 4; ++c) out[c] = a[c] * (1 - t) + b[c] * t;
    return out;
  }

  static std::int64_t wrapped(double texel, std::int64_t size, Wrap wrap) {
    const double n = static_cast<double>(size);
    switch (wrap) {
      case Wrap::kRepeat: return static_cast<std::int64_t>(texel - std::floor(texel / n) * n);
      case Wrap::kMirroredRepeat: {
        const double m = texel - std::floor(texel / (2 * n)) * (2 * n);
        return static_cast<std::int64_t>(m < n ? m : 2 * n - 1 - m);
      }
      case Wrap::kClampToEdge: return static_cast<std::int64_t>(std::clamp(texel, 0.0, n - 1));
      case Wrap::kClampToBorder: return texel >= 0 && texel < n ? static_cast<std::int64_t>(texel) : kBeyond;
      case Wrap::kMirrorClampToEdge:
        return static_cast<std::int64_t>(std::min(texel < 0 ? -1 - texel : texel, n - 1));
    }
    return 0;
  }

  static constexpr std::int64_t kBeyond = -1;

  [[nodiscard]] Color texel(std::uint32_t level, double x, double y) const {
    const std::int64_t i = wrapped(x, texture_.level_width(level), sampler_.wrap_u),
                       j = wrapped(y, texture_.level_height(level), sampler_.wrap_v);
    if (i != kBeyond && j != kBeyond) return texture_.texel(level, i, j);
    const double light = sampler_.border == BorderColor::kOpaqueWhite ? 1 : 0;
    return {light, light, light, sampler_.border == BorderColor::kTransparentBlack ? 0.0 : 1.0};
  }

  [[nodiscard]] Color filtered(Filter filter, double u, double v, std::uint32_t level) const {
    const std::int64_t w = texture_.level_width(level), h = texture_.level_height(level);
    const double x = u * static_cast<double>(w), y = v * static_cast<double>(h);
    if (filter == Filter::kNearest) return texel(level, std::floor(x), std::floor(y));
    const auto quantised = [&](double c) {
      return std::ldexp(std::nearbyint(std::ldexp(c, precision_.subtexel_bits)), -precision_.subtexel_bits) -
             0.5;
    };
    const double qx = quantised(x), qy = quantised(y), i = std::floor(qx), j = std::floor(qy);
    const auto at = [&](double tx, double ty) { return texel(level, tx, ty); };
    return mix(mix(at(i, j), at(i + 1, j), qx - i), mix(at(i, j + 1), at(i + 1, j + 1), qx - i), qy - j);
  }

  const PlainTexture& texture_;
  const SamplerState& sampler_;
  const Precision& precision_;
};

}  // namespace quadrille::models
