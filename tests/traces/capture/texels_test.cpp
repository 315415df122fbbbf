/// Texels of captured images as the stream brings them.
#include "traces/capture/texels.h"

#include <vulkan/vulkan_core.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstring>

using namespace quadrille;
using namespace quadrille::capture;
using traces::Format;

namespace {

using Bytes = std::vector<std::uint8_t>;

ViewObject view_of(VkFormat format) {
  ViewObject view;
  view.format = format;
  return view;
}

/// The texels that a view brings of an image of one level.
std::vector<std::byte> texels_of(const ViewObject& view, std::uint32_t width, std::uint32_t height,
                                 const Bytes& source) {
  ImageObject image;
  image.width = width;
  image.height = height;
  image.texels.emplace_back(source.size());
  std::memcpy(image.texels[0].data(), source.data(), source.size());
  bool missing = false;
  std::vector<std::byte> made = texture_texels(image, view, missing);
  CHECK_FALSE(missing);
  return made;
}
Bytes bytes_of(const std::vector<std::byte>& texels) {
  Bytes bytes(texels.size());
  std::memcpy(bytes.data(), texels.data(), texels.size());
  return bytes;
}

}  // namespace

TEST_CASE("capture texels: a plain view brings the image's own bytes in its own format") {
  const Bytes word{0x34, 0x12};
  for (const auto& [vulkan, ours] : {std::pair{VK_FORMAT_R5G6B5_UNORM_PACK16, Format::kR5G6B5Unorm},
                                     {VK_FORMAT_B4G4R4A4_UNORM_PACK16, Format::kB4G4R4A4Unorm},
                                     {VK_FORMAT_R16_SFLOAT, Format::kR16Float},
                                     {VK_FORMAT_R8G8_SNORM, Format::kR8G8Snorm}}) {
    const ViewObject view = view_of(vulkan);
    CHECK(texture_format(view) == ours);
    CHECK(bytes_of(texels_of(view, 1, 1, word)) == word);
  }
}

TEST_CASE("capture texels: formats that the machine has in another order or size") {
  const ViewObject turned = view_of(VK_FORMAT_A4R4G4B4_UNORM_PACK16);
  CHECK(texture_format(turned) == Format::kR4G4B4A4Unorm);
  CHECK(bytes_of(texels_of(turned, 1, 1, {0x34, 0x12})) == Bytes{0x41, 0x23});  // 0x1234 becomes 0x2341
  const ViewObject three = view_of(VK_FORMAT_R8G8B8_UNORM);
  CHECK(texture_format(three) == Format::kR8G8B8A8Unorm);
  CHECK(bytes_of(texels_of(three, 2, 1, {1, 2, 3, 4, 5, 6})) == Bytes{1, 2, 3, 255, 4, 5, 6, 255});
}

TEST_CASE("capture texels: blocks stay blocks, and depths of 24 bits become floats") {
  // BC1: both ends pure red in 5:6:5, all texels the first end
  const Bytes red{0x00, 0xf8, 0x00, 0xf8, 0, 0, 0, 0};
  const ViewObject plain = view_of(VK_FORMAT_BC1_RGB_UNORM_BLOCK);
  CHECK(texture_format(plain) == Format::kBc1RgbUnorm);
  CHECK(bytes_of(texels_of(plain, 3, 2, red)) == red);
  const Bytes two(32, 7);
  const ViewObject astc = view_of(VK_FORMAT_ASTC_6x5_SRGB_BLOCK);
  CHECK(texture_format(astc) == Format::kAstc6x5Srgb);
  CHECK(bytes_of(texels_of(astc, 7, 5, two)) == two);
  CHECK(texel_block(VK_FORMAT_ASTC_6x5_SRGB_BLOCK) == TexelBlock{6, 5, 16});
  CHECK(texture_format(view_of(VK_FORMAT_EAC_R11_SNORM_BLOCK)) == Format::kEacR11Snorm);
  const ViewObject depths = view_of(VK_FORMAT_X8_D24_UNORM_PACK32);
  CHECK(texture_format(depths) == Format::kD32Float);
  const std::vector<std::byte> made = texels_of(depths, 2, 1, {0xff, 0xff, 0xff, 7, 0, 0, 0, 9});
  std::array<float, 2> values{};
  REQUIRE(made.size() == sizeof values);
  std::memcpy(values.data(), made.data(), sizeof values);
  CHECK(values == std::array<float, 2>{1, 0});
}

TEST_CASE("capture texels: what the capture lacks is zeros, and what nothing can show is refused") {
  ImageObject image;
  image.width = image.height = 4;
  image.texels.resize(1);
  bool missing = false;
  const ViewObject packed = view_of(VK_FORMAT_R5G6B5_UNORM_PACK16);
  CHECK(texture_texels(image, packed, missing) == std::vector<std::byte>(16 * 2));
  CHECK(missing);
  CHECK_THROWS_WITH(texture_format(view_of(VK_FORMAT_ASTC_4x4_SFLOAT_BLOCK)),
                    Catch::Contains("is not supported"));
}
