/// Blits of images that no pass can draw to, on the contents that the capture brought.
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "models/base/error.h"
#include "models/rop/blend.h"
#include "traces/capture/device.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

constexpr std::uint64_t kMostTexels = std::uint64_t{1} << 26;  // of a region [G: 8192 x 8192]

using Color = std::array<float, 4>;

/// A format whose texels blits may read and write here: of colours, and no blocks or integers.
traces::Format blit_format(const ImageObject& image) {
  const traces::Format format = image_format(image.format);
  const models::FormatInfo& info = models::format_info(format);
  const bool plain = info.numeric == models::Numeric::kUnorm || info.numeric == models::Numeric::kSrgb;
  if (format == traces::Format::kUndefined || models::is_block_format(format) ||
      info.may(models::kDepthUse) || traces::is_integer_format(format) ||
      !(plain || info.may(models::kColorUse)))
    throw user_error("of {}, without a pass", format_name(image.format));
  return format;
}

/// The texels of one level. Slices are those of a volume, or layers.
class LevelTexels {
 public:
  LevelTexels(ImageObject& image, std::uint32_t level) : format_(blit_format(image)) {
    if (level >= image.levels) throw user_error("level {} of an image that has {}", level, image.levels);
    const auto side = [&](std::uint32_t size) { return std::max(1u, size >> level); };
    width = side(image.width), height = side(image.height), depth = side(image.depth), layers = image.layers;
    bytes_ = traces::format_bytes(format_);
    const std::uint64_t bytes = std::uint64_t{width} * height * depth * layers * bytes_;
    if (bytes > kMaxObjectBytes)
      throw user_error("an image of {} bytes a level; at most {} are possible", bytes, kMaxObjectBytes);
    if (image.texels[level].size() < bytes) image.texels[level].resize(bytes);
    texels_ = image.texels[level].data();
  }
  /// Coordinates outside of the level name the texel at its edge.
  [[nodiscard]] Color at(std::int64_t x, std::int64_t y, std::int64_t z, std::uint32_t layer) const {
    const auto within = [](std::int64_t place, std::uint32_t side) {
      return static_cast<std::uint32_t>(std::clamp<std::int64_t>(place, 0, std::int64_t{side} - 1));
    };
    models::PixelCode code;
    std::memcpy(code.word.data(), place(within(x, width), within(y, height), within(z, depth), layer),
                bytes_);
    return models::decode_color(format_, code);
  }
  void put(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t layer, const Color& color) {
    const models::PixelCode code = models::encode_color(format_, color);
    std::memcpy(place(x, y, z, layer), code.word.data(), bytes_);
  }

  std::uint32_t width = 1, height = 1, depth = 1, layers = 1;

 private:
  [[nodiscard]] std::byte* place(std::size_t x, std::size_t y, std::size_t z, std::size_t layer) const {
    return texels_ + (((layer * depth + z) * height + y) * width + x) * bytes_;
  }

  traces::Format format_;
  std::size_t bytes_ = 0;
  std::byte* texels_ = nullptr;
};

/// One direction of a blit: texels of the target, and where in the source the middle of each lies. [VK1.3
/// #copies-images-scaling-rotation]
struct Axis {
  std::uint32_t first = 0, end = 1;
  double scale = 1, to = 0, from = 0;

  Axis(const Value& region, std::string_view name, std::uint32_t side) {
    const auto corner = [&](const char* offsets, std::size_t i) { return region[offsets].at(i)[name].i32(); };
    const std::int64_t a = corner("dstOffsets", 0), b = corner("dstOffsets", 1);
    if (a == b || std::min(a, b) < 0 || std::max(a, b) > side)
      throw user_error("to texels {} to {} of {}", a, b, side);
    first = static_cast<std::uint32_t>(std::min(a, b));
    end = static_cast<std::uint32_t>(std::max(a, b));
    to = static_cast<double>(a);
    from = corner("srcOffsets", 0);
    scale = (corner("srcOffsets", 1) - from) / static_cast<double>(b - a);
  }
  [[nodiscard]] double place(std::uint32_t texel) const { return (texel + 0.5 - to) * scale + from; }
};

/// The eight texels around a place, each by its share. [VK1.3 #textures-unnormalized-to-integer]
Color linear(const LevelTexels& source, const std::array<double, 3>& place, std::uint32_t layer) {
  std::array<std::int64_t, 3> low{};
  std::array<double, 3> share{};
  for (std::size_t c = 0; c < 3; ++c) {
    low[c] = static_cast<std::int64_t>(std::floor(place[c] - 0.5));
    share[c] = place[c] - 0.5 - static_cast<double>(low[c]);
  }
  std::array<double, 4> sum{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<std::int64_t, 3> at = low;
    for (std::size_t c = 0; c < 3; ++c) {
      const bool high = (corner >> c & 1u) != 0;
      weight *= high ? share[c] : 1 - share[c];
      at[c] += high ? 1 : 0;
    }
    if (weight == 0) continue;
    const Color texel = source.at(at[0], at[1], at[2], layer);
    for (std::size_t c = 0; c < 4; ++c) sum[c] += weight * double{texel[c]};
  }
  Color color{};
  std::ranges::transform(sum, color.begin(), [](double v) { return static_cast<float>(v); });
  return color;
}

Color nearest(const LevelTexels& source, const std::array<double, 3>& place, std::uint32_t layer) {
  const auto texel = [&](std::size_t c) { return static_cast<std::int64_t>(std::floor(place[c])); };
  return source.at(texel(0), texel(1), texel(2), layer);
}

}  // namespace

void Device::blit_image(Handle source, Handle target, const Value& region, std::uint32_t filter) {
  const auto from_image = images.find(source), to_image = images.find(target);
  if (from_image == images.end() || to_image == images.end())
    throw user_error("image {} or {} was never created", source, target);
  const Value &from_part = region["srcSubresource"], &to_part = region["dstSubresource"];
  const LevelTexels from(from_image->second, from_part["mipLevel"].u32());
  LevelTexels to(to_image->second, to_part["mipLevel"].u32());
  const Axis x(region, "x", to.width), y(region, "y", to.height), z(region, "z", to.depth);
  const std::uint32_t from_layer = from_part["baseArrayLayer"].u32(), layers = to_part["layerCount"].u32(),
                      to_layer = to_part["baseArrayLayer"].u32();
  if (from_layer >= from.layers || layers > from.layers - from_layer || to_layer >= to.layers ||
      layers > to.layers - to_layer)
    throw user_error("of layers beyond the image");
  if (std::uint64_t{x.end - x.first} * (y.end - y.first) * (z.end - z.first) * layers > kMostTexels)
    throw user_error("of more than {} texels", kMostTexels);
  for (std::uint32_t layer = 0; layer < layers; ++layer)
    for (std::uint32_t k = z.first; k < z.end; ++k)
      for (std::uint32_t j = y.first; j < y.end; ++j)
        for (std::uint32_t i = x.first; i < x.end; ++i) {
          const std::array place{x.place(i), y.place(j), z.place(k)};
          const auto sample = filter == VK_FILTER_LINEAR ? linear : nearest;
          to.put(i, j, k, to_layer + layer, sample(from, place, from_layer + layer));
        }
  to_image->second.from_memory = false;
  ++to_image->second.writes;
}

}  // namespace quadrille::capture
