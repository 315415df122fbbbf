#include "scenes/image/mip_chain.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>

namespace quadrille::scenes {
namespace {

// fine enough that the nearest of the 255 thresholds is one comparison away
constexpr std::size_t kEncodeSteps = 16384;

struct Tables {
  std::array<float, 256> srgb_decode{}, plain_decode{};
  /// a code that is at most right for the smallest value of the step
  std::array<std::uint8_t, kEncodeSteps + 1> first_code{};
  /// linear values from threshold[c] on encode to at least c
  std::array<float, 257> threshold{};

  Tables() {
    for (std::size_t c = 0; c < 256; ++c) {
      srgb_decode[c] = static_cast<float>(srgb_to_linear(static_cast<double>(c) / 255));
      plain_decode[c] = static_cast<float>(static_cast<double>(c) / 255);
      threshold[c] = c == 0 ? 0.0F : static_cast<float>(srgb_to_linear((static_cast<double>(c) - 0.5) / 255));
    }
    threshold[256] = 2;  // no linear value in 0..1 reaches it
    std::size_t code = 0;
    for (std::size_t step = 0; step <= kEncodeSteps; ++step) {
      const float low = static_cast<float>(step) / kEncodeSteps;
      while (threshold[code + 1] <= low) ++code;
      first_code[step] = static_cast<std::uint8_t>(code);
    }
  }

  /// The sRGB code nearest to a linear value of 0..1.
  [[nodiscard]] std::uint8_t encode_srgb(float linear) const {
    std::size_t code = first_code[static_cast<std::size_t>(linear * kEncodeSteps)];
    while (threshold[code + 1] <= linear) ++code;
    return static_cast<std::uint8_t>(code);
  }
};

const Tables& tables() {
  static const Tables instance;
  return instance;
}

std::uint8_t encode_plain(float value) {
  const float scaled = value * 255.0F + 0.5F;
  return static_cast<std::uint8_t>(scaled);
}

struct FloatLevel {
  std::uint32_t width = 0, height = 0;
  std::vector<float> texels;  ///< rgba
};

/// The up to three source texels of a target texel along one axis, with weights that add up to one.
struct Taps {
  std::uint32_t first = 0;
  std::array<float, 3> weight{1, 0, 0};
  std::uint32_t count = 1;
};

Taps taps(std::uint32_t target, std::uint32_t source_size, std::uint32_t target_size) {
  if (source_size == 1) return {};
  if (source_size % 2 == 0) return {2 * target, {0.5F, 0.5F, 0}, 2};
  // Odd: texel t of n covers [t, t+1) * (2n+1)/n, that is a part of texel 2t, all of 2t+1 and a part of 2t+2.
  const auto n = static_cast<float>(target_size), t = static_cast<float>(target),
             size = static_cast<float>(source_size);
  return {2 * target, {(n - t) / size, n / size, (t + 1) / size}, 3};
}

/// Decodes one row of 8-bit texels.
void decode_row(const Rgba8Image& image, std::uint32_t y, TexelCoding coding, std::vector<float>& out) {
  const std::array<float, 256>& color = coding.srgb ? tables().srgb_decode : tables().plain_decode;
  const std::array<float, 256>& alpha = tables().plain_decode;
  const std::uint8_t* in = &image.pixels[out.size() * y];
  for (std::size_t i = 0; i < out.size(); i += 4) {
    out[i + 3] = alpha[in[i + 3]];
    const float factor = coding.premultiplied ? out[i + 3] : 1.0F;
    for (std::size_t c = 0; c < 3; ++c) out[i + c] = factor * color[in[i + c]];
  }
}

void encode(const std::vector<float>& texels, bool srgb, std::byte* out) {
  const Tables& table = tables();
  for (std::size_t i = 0; i < texels.size(); i += 4) {
    for (std::size_t c = 0; c < 4; ++c) {
      const float value = std::min(texels[i + c], 1.0F);  // sums of weights may round above one
      out[i + c] = static_cast<std::byte>(srgb && c < 3 ? table.encode_srgb(value) : encode_plain(value));
    }
  }
}

/// sum += weight * row, texel by texel.
void accumulate(std::vector<float>& sum, const float* row, float weight) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * row[i];
}

/// Filters one row of source texels (already summed over y) into one row of target texels.
void shrink_row(const std::vector<float>& row, std::uint32_t source_width, std::uint32_t target_width,
                float* out) {
  if (source_width % 2 == 0) {
    for (std::size_t i = 0; i < std::size_t{4} * target_width; i += 4) {
      for (std::size_t c = 0; c < 4; ++c) out[i + c] = 0.5F * (row[2 * i + c] + row[2 * i + 4 + c]);
    }
    return;
  }
  for (std::uint32_t x = 0; x < target_width; ++x) {
    const Taps t = taps(x, source_width, target_width);
    for (std::size_t c = 0; c < 4; ++c) {
      float value = 0;
      for (std::uint32_t k = 0; k < t.count; ++k)
        value += t.weight[k] * row[std::size_t{4} * (t.first + k) + c];
      out[std::size_t{4} * x + c] = value;
    }
  }
}

/// The next level of a source of width x height texels; `source_row(y)` answers a row as floats.
template <class SourceRow>
FloatLevel shrink(std::uint32_t width, std::uint32_t height, const SourceRow& source_row) {
  FloatLevel target{std::max(1U, width / 2), std::max(1U, height / 2), {}};
  target.texels.resize(std::size_t{4} * target.width * target.height);
  std::vector<float> sum(std::size_t{4} * width);
  for (std::uint32_t y = 0; y < target.height; ++y) {
    const Taps t = taps(y, height, target.height);
    std::ranges::fill(sum, 0.0F);
    for (std::uint32_t k = 0; k < t.count; ++k) accumulate(sum, source_row(t.first + k), t.weight[k]);
    shrink_row(sum, width, target.width, &target.texels[std::size_t{4} * target.width * y]);
  }
  return target;
}

/// Level 1: the finest level is decoded row by row, for as floats it would be the largest thing a load holds.
FloatLevel shrink_image(const Rgba8Image& image, TexelCoding coding) {
  std::vector<float> row(std::size_t{4} * image.width);
  return shrink(image.width, image.height, [&](std::uint32_t y) {
    decode_row(image, y, coding, row);
    return row.data();
  });
}

FloatLevel shrink_level(const FloatLevel& level) {
  return shrink(level.width, level.height,
                [&](std::uint32_t y) { return &level.texels[std::size_t{4} * level.width * y]; });
}

/// The finest level with its colours multiplied by alpha.
std::vector<std::byte> premultiplied_texels(const Rgba8Image& image, TexelCoding coding) {
  std::vector<std::byte> texels(image.pixels.size());
  std::vector<float> row(std::size_t{4} * image.width);
  for (std::uint32_t y = 0; y < image.height; ++y) {
    decode_row(image, y, coding, row);
    encode(row, coding.srgb, &texels[row.size() * y]);
  }
  return texels;
}

}  // namespace

double srgb_to_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::uint32_t full_chain_levels(std::uint32_t width, std::uint32_t height) {
  return static_cast<std::uint32_t>(std::bit_width(std::max(width, height)));
}

void visit_mip_chain(const Rgba8Image& image, TexelCoding coding, const traces::LevelSink& sink) {
  if (coding.premultiplied) sink(0, premultiplied_texels(image, coding));
  else sink(0, std::as_bytes(std::span(image.pixels)));
  FloatLevel level{image.width, image.height, {}};
  std::vector<std::byte> codes;
  for (std::uint32_t number = 1; level.width > 1 || level.height > 1; ++number) {
    level = level.texels.empty() ? shrink_image(image, coding) : shrink_level(level);
    codes.resize(level.texels.size());
    encode(level.texels, coding.srgb, codes.data());
    sink(number, codes);
  }
}

std::vector<std::byte> build_mip_chain(const Rgba8Image& image, TexelCoding coding) {
  std::vector<std::byte> chain;
  chain.reserve(image.pixels.size() / 3 * 4 + 256);  // a third for the levels, and their rounding
  visit_mip_chain(image, coding, [&](std::uint32_t /*level*/, std::span<const std::byte> texels) {
    chain.insert(chain.end(), texels.begin(), texels.end());
  });
  return chain;
}

}  // namespace quadrille::scenes
