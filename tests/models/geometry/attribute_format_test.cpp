#include "models/geometry/attribute_format.h"

#include <catch2/catch.hpp>

#include <array>
#include <cstring>

using namespace quadrille::models;

namespace {

template <class T, std::size_t n>
std::array<float, 4> decode(AttributeFormat format, const std::array<T, n>& values) {
  CHECK(attribute_bytes(format) == sizeof(values));
  std::array<std::byte, sizeof(values) + 1> bytes{};  // read from an odd address
  std::memcpy(bytes.data() + 1, values.data(), sizeof(values));
  std::array<float, 4> out{9, 9, 9, 9};
  decode_attribute(format, bytes.data() + 1, out.data());
  return out;
}
using Four = std::array<float, 4>;

}  // namespace

TEST_CASE("attribute_format: missing components read as 0 0 0 1") {
  CHECK(decode(AttributeFormat::kR32Float, std::array{2.5f}) == Four{2.5f, 0, 0, 1});
  CHECK(decode(AttributeFormat::kR32G32Float, std::array{2.5f, -1.0f}) == Four{2.5f, -1, 0, 1});
  CHECK(decode(AttributeFormat::kR32G32B32Float, std::array{2.5f, -1.0f, 1e30f}) == Four{2.5f, -1, 1e30f, 1});
  CHECK(decode(AttributeFormat::kR32G32B32A32Float, std::array{2.5f, -1.0f, 3.0f, 4.0f}) == Four{2.5f, -1, 3, 4});
  CHECK(decode(AttributeFormat::kR8G8Unorm, std::array<std::uint8_t, 2>{255, 51}) == Four{1, 0.2f, 0, 1});
}

TEST_CASE("attribute_format: normalized integers reach exactly -1 and 0 and 1") {
  CHECK(decode(AttributeFormat::kR8G8B8A8UnormVertex, std::array<std::uint8_t, 4>{0, 255, 51, 1}) == Four{0, 1, 0.2f, 1.0f / 255});
  CHECK(decode(AttributeFormat::kR16G16Unorm, std::array<std::uint16_t, 2>{65535, 13107}) == Four{1, 0.2f, 0, 1});
  CHECK(decode(AttributeFormat::kR16G16B16A16Unorm, std::array<std::uint16_t, 4>{0, 65535, 1, 0}) == Four{0, 1, 1.0f / 65535, 0});
  CHECK(decode(AttributeFormat::kR8G8B8A8Snorm, std::array<std::int8_t, 4>{-128, -127, 127, 0}) == Four{-1, -1, 1, 0});
  CHECK(decode(AttributeFormat::kR16G16B16A16Snorm, std::array<std::int16_t, 4>{-32768, -32767, 32767, 1}) ==
        Four{-1, -1, 1, 1.0f / 32767});
}
