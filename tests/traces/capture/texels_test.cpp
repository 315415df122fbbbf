/// Texels of captured images: as they are, or in the order that a view shows.
#include "traces/capture/texels.h"

#include <vulkan/vulkan_core.h>

#include <catch2/catch.hpp>
#include <cstring>

using namespace quadrille;
using namespace quadrille::capture;
using traces::Format;

namespace {

using Bytes = std::vector<std::uint8_t>;
using Swizzle = std::array<std::uint32_t, 4>;

constexpr Swizzle kAsItIs{};
constexpr Swizzle kBgr1{VK_COMPONENT_SWIZZLE_B, VK_COMPONENT_SWIZZLE_G, VK_COMPONENT_SWIZZLE_R,
                        VK_COMPONENT_SWIZZLE_ONE};

ViewObject view_of(VkFormat format, const Swizzle& swizzle) {
  ViewObject view;
  view.format = format;
  view.swizzle = swizzle;
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
    const ViewObject view = view_of(vulkan, kAsItIs);
    CHECK(texture_format(view) == ours);
    CHECK(bytes_of(texels_of(view, 1, 1, word)) == word);
  }
  // what a format lacks is 0, and 1 as alpha, whether the view says so or not
  Swizzle said{VK_COMPONENT_SWIZZLE_R, VK_COMPONENT_SWIZZLE_G, VK_COMPONENT_SWIZZLE_ZERO,
               VK_COMPONENT_SWIZZLE_ONE};
  CHECK(texture_format(view_of(VK_FORMAT_R8G8_UNORM, said)) == Format::kR8G8Unorm);
  said[2] = VK_COMPONENT_SWIZZLE_ONE;
  CHECK(texture_format(view_of(VK_FORMAT_R8G8_UNORM, said)) == Format::kR8G8B8A8Unorm);
}

TEST_CASE("capture texels: exchanged bytes stay bytes, other numbers become floats") {
  const ViewObject bytes = view_of(VK_FORMAT_B8G8R8A8_SRGB, kBgr1);
  CHECK(texture_format(bytes) == Format::kR8G8B8A8Srgb);
  CHECK(bytes_of(texels_of(bytes, 1, 1, {10, 20, 30, 40})) == Bytes{10, 20, 30, 255});
  const ViewObject packed = view_of(VK_FORMAT_R5G6B5_UNORM_PACK16, kBgr1);
  CHECK(texture_format(packed) == Format::kR32G32B32A32Float);
  const std::vector<std::byte> made = texels_of(packed, 1, 1, {0x03, 0x08});  // red 1, green 0, blue 3
  std::array<float, 4> rgba{};
  REQUIRE(made.size() == sizeof rgba);
  std::memcpy(rgba.data(), made.data(), sizeof rgba);
  CHECK(rgba == std::array<float, 4>{3.0F / 31, 0, 1.0F / 31, 1});
}

TEST_CASE("capture texels: formats that the machine has in another order or size") {
  const ViewObject turned = view_of(VK_FORMAT_A4R4G4B4_UNORM_PACK16, kAsItIs);
  CHECK(texture_format(turned) == Format::kR4G4B4A4Unorm);
  CHECK(bytes_of(texels_of(turned, 1, 1, {0x34, 0x12})) == Bytes{0x41, 0x23});  // 0x1234 becomes 0x2341
  const ViewObject three = view_of(VK_FORMAT_R8G8B8_UNORM, kAsItIs);
  CHECK(texture_format(three) == Format::kR8G8B8A8Unorm);
  CHECK(bytes_of(texels_of(three, 2, 1, {1, 2, 3, 4, 5, 6})) == Bytes{1, 2, 3, 255, 4, 5, 6, 255});
}

TEST_CASE("capture texels: blocks stay blocks, and are decoded where components are exchanged") {
  // BC1: both ends pure red in 5:6:5, all texels the first end
  const Bytes red{0x00, 0xf8, 0x00, 0xf8, 0, 0, 0, 0};
  const ViewObject plain = view_of(VK_FORMAT_BC1_RGB_UNORM_BLOCK, kAsItIs);
  CHECK(texture_format(plain) == Format::kBc1RgbUnorm);
  CHECK(bytes_of(texels_of(plain, 3, 2, red)) == red);
  const ViewObject exchanged = view_of(VK_FORMAT_BC1_RGB_UNORM_BLOCK, kBgr1);
  CHECK(texture_format(exchanged) == Format::kR8G8B8A8Unorm);
  const Bytes made = bytes_of(texels_of(exchanged, 3, 2, red));
  REQUIRE(made.size() == 4 * 3 * 2);
  CHECK(Bytes(made.begin(), made.begin() + 4) == Bytes{0, 0, 255, 255});
}

TEST_CASE("capture texels: what the capture lacks is zeros, and what nothing can show is refused") {
  ImageObject image;
  image.width = image.height = 4;
  image.texels.resize(1);
  bool missing = false;
  const ViewObject floats = view_of(VK_FORMAT_R5G6B5_UNORM_PACK16, kBgr1);
  CHECK(texture_texels(image, floats, missing) == std::vector<std::byte>(16 * 16));
  CHECK(missing);
  CHECK_THROWS_WITH(texture_format(view_of(VK_FORMAT_R8G8_UINT, kBgr1)),
                    Catch::Contains("VK_FORMAT_R8G8_UINT that exchanges components"));
  CHECK_THROWS_WITH(texture_format(view_of(VK_FORMAT_ASTC_4x4_UNORM_BLOCK, kAsItIs)),
                    Catch::Contains("is not supported"));
}
