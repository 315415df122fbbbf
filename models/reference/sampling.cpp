/// Texture sampling in doubles.
#include "models/reference/sampling.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "models/reference/output.h"

namespace quadrille::models::reference {
namespace {

constexpr double kMaxBias = 16.0;

}  // namespace

double quantised(double a, const Precision* precision, int Precision::*bits) {
  if (precision == nullptr) return a;
  const double scale = std::ldexp(1.0, precision->*bits);
  return std::floor(a * scale + 0.5) / scale;
}

std::int64_t wrapped(std::int64_t i, std::int64_t size, traces::Wrap wrap) {
  const auto modulo = [](std::int64_t a, std::int64_t b) { return ((a % b) + b) % b; };
  std::int64_t result = 0;
  switch (wrap) {
    case traces::Wrap::kRepeat: result = modulo(i, size); break;
    case traces::Wrap::kMirroredRepeat: {
      const std::int64_t n = modulo(i, 2 * size) - size;
      result = size - 1 - (n >= 0 ? n : -(1 + n));
      break;
    }
    case traces::Wrap::kClampToEdge: result = std::clamp<std::int64_t>(i, 0, size - 1); break;
    case traces::Wrap::kClampToBorder: result = i < 0 || i >= size ? kBeyondBorder : i; break;
    case traces::Wrap::kMirrorClampToEdge: result = std::min(i >= 0 ? i : -(1 + i), size - 1); break;
  }
  return result;
}

/// A component of a border of the sampler's own, which the format may not be able to hold.
double own_border(std::uint32_t bits, models::Numeric numeric) {
  const auto value = static_cast<double>(std::bit_cast<float>(bits));
  switch (models::number_kind(numeric)) {
    case models::NumberKind::kUint: return bits;
    case models::NumberKind::kSint: return static_cast<std::int32_t>(bits);
    case models::NumberKind::kFloat: break;
  }
  if (numeric == models::Numeric::kSnorm) return std::clamp(value, -1.0, 1.0);
  const bool unit = numeric == models::Numeric::kUnorm || numeric == models::Numeric::kSrgb;
  return unit ? std::clamp(value, 0.0, 1.0) : value;
}

/// What lies beyond the image: of the components that its format has.
Texel border_texel(const TextureView& texture, BorderColor border) {
  const models::FormatInfo& format = models::format_info(texture.image->format);
  const std::size_t channels = texture.channels != 0 ? texture.channels : format.channels;
  Texel texel{0, 0, 0, 1};
  if (border == BorderColor::kOwn) {
    for (std::size_t c = 0; c < channels; ++c)
      texel[c] = own_border(texture.sampler->border_bits[c], format.numeric);
    return texel;
  }
  for (std::size_t c = 0; c < channels; ++c) {
    const bool opaque = border != models::BorderColor::kTransparentBlack;
    texel[c] = border == models::BorderColor::kOpaqueWhite || (opaque && c == 3) ? 1.0 : 0.0;
  }
  return texel;
}

std::int64_t floor_index(double a) {
  return static_cast<std::int64_t>(std::floor(std::clamp(a, -1e15, 1e15)));
}

Texel mix(const Texel& a, const Texel& b, double t) {
  Texel r{};
  for (std::size_t c = 0; c < 4; ++c) r[c] = a[c] * (1.0 - t) + b[c] * t;
  return r;
}

namespace {

Texel sample_level(const TextureView& texture, std::uint32_t level, double u, double v,
                   traces::Filter filter) {
  const auto extent = level_extent(texture, level);
  const auto texel = [&](std::int64_t i, std::int64_t j) {
    const std::int64_t column = wrapped(i, extent[0], texture.sampler->wrap_u),
                       row = wrapped(j, extent[1], texture.sampler->wrap_v);
    if (column == kBeyondBorder || row == kBeyondBorder)
      return border_texel(texture, texture.sampler->border);
    return view_texel(texture, level, static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row), 0);
  };
  const double x = u * extent[0], y = v * extent[1];
  if (filter == traces::Filter::kNearest) return texel(floor_index(x), floor_index(y));
  const double left = quantised(x - 0.5, texture.precision, &Precision::subtexel_bits);
  const double top = quantised(y - 0.5, texture.precision, &Precision::subtexel_bits);
  const std::int64_t i = floor_index(left), j = floor_index(top);
  const double a = left - std::floor(left), b = top - std::floor(top);
  return mix(mix(texel(i, j), texel(i + 1, j), a), mix(texel(i, j + 1), texel(i + 1, j + 1), a), b);
}

}  // namespace

double integer_value(traces::Format format, std::uint32_t bits) {
  return traces::number_kind(format) == traces::NumberKind::kSint
             ? static_cast<double>(static_cast<std::int32_t>(bits))
             : bits;
}

double finite_or_zero(double a) { return std::isfinite(a) ? a : 0.0; }

double srgb_to_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

std::array<std::uint32_t, 2> level_extent(const traces::Image& image, std::uint32_t level) {
  const std::uint32_t l = level < image.levels ? level : 0;
  return {std::max(1u, image.width >> l), std::max(1u, image.height >> l)};
}

std::array<std::uint32_t, 2> level_extent(const TextureView& texture, std::uint32_t level) {
  return level_extent(*texture.image, texture.first_level + (level < texture.levels ? level : 0));
}

Texel fetch_texel(const traces::Image& image, std::uint32_t level, std::uint32_t x, std::uint32_t y,
                  std::uint32_t sample) {
  std::size_t first = 0;
  for (std::uint32_t l = 0; l < level; ++l)
    first += std::size_t{level_extent(image, l)[0]} * level_extent(image, l)[1];
  const std::size_t bytes = traces::format_bytes(image.format);
  const std::size_t at =
      bytes * (image.samples * (first + std::size_t{y} * level_extent(image, level)[0] + x) + sample);
  PixelCode code;
  std::memcpy(code.word.data(), image.texels.data() + at, bytes);
  return load_color(image.format, code);
}

Texel view_texel(const TextureView& texture, std::uint32_t level, std::uint32_t x, std::uint32_t y,
                 std::uint32_t slice, std::uint32_t sample) {
  const std::uint32_t l = texture.first_level + level;
  if (!texture.drawn.empty()) return fetch_texel(*texture.drawn.at(slice), l, x, y, sample);
  const traces::Image& image = *texture.image;
  std::uint64_t at = 0;
  for (std::uint32_t finer = 0; finer < l; ++finer) at += traces::level_bytes(image, finer) * image.layers;
  const std::uint64_t bytes = traces::format_bytes(image.format);
  const std::uint64_t row = traces::level_width(image, l), plane = row * traces::level_height(image, l);
  at += bytes * ((texture.first_layer + slice) * plane + y * row + x);
  PixelCode code;
  std::memcpy(code.word.data(), image.texels.data() + at, bytes);
  return load_color(image.format, code);
}

double base_lod(const TextureView& texture, std::array<double, 2> d_dx, std::array<double, 2> d_dy) {
  const auto [w, h] = level_extent(texture, 0);
  return std::log2(std::max(std::hypot(d_dx[0] * w, d_dx[1] * h), std::hypot(d_dy[0] * w, d_dy[1] * h)));
}

double final_lambda(const TextureView& texture, double base, double bias) {
  const traces::Sampler& s = *texture.sampler;
  const double biased =
      base + std::clamp(static_cast<double>(s.lod_bias) + finite_or_zero(bias), -kMaxBias, kMaxBias);
  const double clamped = std::isnan(biased) ? 0.0
                                            : std::max(static_cast<double>(s.min_lod),
                                                       std::min(biased, static_cast<double>(s.max_lod)));
  // Kept within what has an effect before rounding: infinities do not round.
  return quantised(std::clamp(clamped, -1.0, static_cast<double>(texture.levels)), texture.precision,
                   &Precision::lod_bits);
}

Texel sample_texture(const TextureView& texture, double u, double v, double base, double bias) {
  const traces::Sampler& s = *texture.sampler;
  u = finite_or_zero(u), v = finite_or_zero(v);
  const double lambda = final_lambda(texture, base, bias);
  const traces::Filter filter = lambda <= 0 ? s.mag : s.min;
  const double top = static_cast<double>(texture.levels - 1);
  const double level = std::clamp(lambda, 0.0, top);
  if (s.mip == traces::Filter::kNearest) {
    return sample_level(texture,
                        static_cast<std::uint32_t>(std::clamp(std::ceil(level + 0.5) - 1.0, 0.0, top)), u, v,
                        filter);
  }
  const auto finer = static_cast<std::uint32_t>(level);
  const double weight = level - std::floor(level);
  const Texel a = sample_level(texture, finer, u, v, filter);
  return weight == 0 ? a : mix(a, sample_level(texture, finer + 1, u, v, filter), weight);
}

}  // namespace quadrille::models::reference
