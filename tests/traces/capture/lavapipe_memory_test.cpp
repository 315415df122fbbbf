/// Images as lavapipe lays them out in memory.
#include <vulkan/vulkan_core.h>
#include <catch2/catch.hpp>

#include <cstring>

#include "traces/capture/lavapipe_memory.h"

namespace quadrille::capture {
namespace {

/// Memory in which every byte says where it lies.
std::vector<std::byte> counted(std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; i += 4) {
    const auto number = static_cast<std::uint32_t>(i);
    std::memcpy(&bytes[i], &number, 4);
  }
  return bytes;
}

std::uint32_t word(const std::vector<std::byte>& texels, std::size_t index) {
  std::uint32_t value = 0;
  std::memcpy(&value, &texels.at(4 * index), 4);
  return value;
}

ImageObject image(std::uint32_t format, std::uint32_t width, std::uint32_t height, std::uint32_t levels) {
  ImageObject made;
  made.format = format;
  made.type = VK_IMAGE_TYPE_2D;
  made.width = width;
  made.height = height;
  made.levels = levels;
  return made;
}

}  // namespace

TEST_CASE("lavapipe memory: rows begin at cache lines, in blocks of four, and levels follow each other") {
  const auto texels = texels_in_memory(image(VK_FORMAT_R8G8B8A8_UNORM, 17, 6, 2), counted(4096));
  REQUIRE(texels.size() == 2);
  REQUIRE(texels[0].size() == 17 * 6 * 4);
  CHECK(word(texels[0], 16) == 64);   // the last of the first row
  CHECK(word(texels[0], 17) == 128);  // 20 texels of 4 bytes take two lines
  CHECK(word(texels[0], 17 * 5) == 5 * 128);
  CHECK(word(texels[1], 0) == 8 * 128);  // behind eight rows
  CHECK(word(texels[1], 8) == 8 * 128 + 64);
}

TEST_CASE("lavapipe memory: layers follow each other within a level, and rows of blocks lie side by side") {
  ImageObject layers = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4, 1);
  layers.layers = 3;
  CHECK(word(texels_in_memory(layers, counted(4096)).at(0), 32) == 2 * 4 * 64);
  const auto blocks = texels_in_memory(image(VK_FORMAT_BC1_RGBA_UNORM_BLOCK, 12, 8, 1), counted(4096));
  REQUIRE(blocks.at(0).size() == 6 * 8);
  CHECK(word(blocks[0], 6) == 24);
}

TEST_CASE("lavapipe memory: nothing is known of memory that ends too early, or of several samples") {
  CHECK(texels_in_memory(image(VK_FORMAT_R8G8B8A8_UNORM, 17, 6, 2), counted(1024)).empty());
  ImageObject samples = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4, 1);
  samples.samples = 4;
  CHECK(texels_in_memory(samples, counted(4096)).empty());
  CHECK(texels_in_memory(image(9999, 4, 4, 1), counted(4096)).empty());
}

}  // namespace quadrille::capture
