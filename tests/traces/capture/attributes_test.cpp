/// Vertex attributes that are expanded when a capture is imported.
#include <vulkan/vulkan_core.h>
#include <catch2/catch.hpp>

#include <cstring>
#include <limits>

#include "traces/capture/attributes.h"

namespace quadrille::capture {
namespace {

template <class T>
std::vector<T> values(std::span<const std::byte> buffer, const AttributeSource& source) {
  const std::vector<std::byte> bytes = expanded_attributes(buffer, source);
  std::vector<T> made(bytes.size() / sizeof(T));
  std::memcpy(made.data(), bytes.data(), bytes.size());
  return made;
}

}  // namespace

TEST_CASE("attributes: halves become floats, as many as the buffer holds") {
  const std::uint16_t halves[] = {0xffff, 0x3c00, 0xc000, 0x0001, 0x7c00, 0x1234};
  const auto made = values<float>(std::as_bytes(std::span(halves)), {VK_FORMAT_R16G16_SFLOAT, 2, 4});
  CHECK(made == std::vector<float>{1, -2, 0x1p-24f, std::numeric_limits<float>::infinity()});
  CHECK(expanded_attribute_format(VK_FORMAT_R16G16_SFLOAT) == traces::Format::kR32G32Float);
}

TEST_CASE("attributes: signed numbers of ten bits reach exactly -1 and 1, and so do those of two") {
  const std::uint32_t words[] = {511u | 512u << 10 | 513u << 20 | 1u << 30, 0u | 2u << 30};
  const auto made =
      values<float>(std::as_bytes(std::span(words)), {VK_FORMAT_A2B10G10R10_SNORM_PACK32, 0, 4});
  CHECK(made == std::vector<float>{1, -1, -1, 1, 0, 0, 0, -1});
}

TEST_CASE("attributes: a stride of 0 is one attribute, and a format that is unknown is none") {
  const std::uint16_t halves[] = {0x3c00, 0x4000};
  CHECK(values<float>(std::as_bytes(std::span(halves)), {VK_FORMAT_R16_SFLOAT, 0, 0}) ==
        std::vector<float>{1});
  CHECK(expanded_attribute_format(VK_FORMAT_R64_SFLOAT) == traces::Format::kUndefined);
}

}  // namespace quadrille::capture
