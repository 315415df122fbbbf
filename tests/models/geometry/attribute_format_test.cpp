#include "models/geometry/attribute_format.h"

#include <catch2/catch.hpp>

#include <array>
#include <bit>
#include <cstring>
#include <span>

using namespace quadrille::models;

namespace {

template <class T, std::size_t n>
std::array<float, 4> decode(Format format, const std::array<T, n>& values) {
  CHECK(format_bytes(format) == sizeof(values));
  std::array<std::byte, sizeof(values) + 1> bytes{};  // read from an odd address
  std::memcpy(bytes.data() + 1, values.data(), sizeof(values));
  std::array<std::uint32_t, 4> words{9, 9, 9, 9};
  decode_attribute(format, bytes.data() + 1, words.data());
  return std::bit_cast<std::array<float, 4>>(words);
}
using Four = std::array<float, 4>;

}  // namespace

TEST_CASE("attribute_format: missing components read as 0 0 0 1") {
  CHECK(decode(Format::kR32Float, std::array{2.5f}) == Four{2.5f, 0, 0, 1});
  CHECK(decode(Format::kR32G32Float, std::array{2.5f, -1.0f}) == Four{2.5f, -1, 0, 1});
  CHECK(decode(Format::kR32G32B32Float, std::array{2.5f, -1.0f, 1e30f}) == Four{2.5f, -1, 1e30f, 1});
  CHECK(decode(Format::kR32G32B32A32Float, std::array{2.5f, -1.0f, 3.0f, 4.0f}) == Four{2.5f, -1, 3, 4});
  CHECK(decode(Format::kR8G8Unorm, std::array<std::uint8_t, 2>{255, 51}) == Four{1, 0.2f, 0, 1});
}

TEST_CASE("attribute_format: normalized integers reach exactly -1 and 0 and 1") {
  CHECK(decode(Format::kR8G8B8A8UnormVertex, std::array<std::uint8_t, 4>{0, 255, 51, 1}) ==
        Four{0, 1, 0.2f, 1.0f / 255});
  CHECK(decode(Format::kR16G16Unorm, std::array<std::uint16_t, 2>{65535, 13107}) == Four{1, 0.2f, 0, 1});
  CHECK(decode(Format::kR16G16B16A16Unorm, std::array<std::uint16_t, 4>{0, 65535, 1, 0}) ==
        Four{0, 1, 1.0f / 65535, 0});
  CHECK(decode(Format::kR8G8B8A8Snorm, std::array<std::int8_t, 4>{-128, -127, 127, 0}) == Four{-1, -1, 1, 0});
  CHECK(decode(Format::kR16G16B16A16Snorm, std::array<std::int16_t, 4>{-32768, -32767, 32767, 1}) ==
        Four{-1, -1, 1, 1.0f / 32767});
}

TEST_CASE("attribute_format: unsigned integers arrive as they are") {
  const std::array<std::uint8_t, 9> bytes{77, 0, 1, 128, 255, 2, 0, 255, 255};  // read from an odd address
  std::array<std::uint32_t, 4> words{9, 9, 9, 9};
  decode_attribute(Format::kR8G8B8A8Uint, std::as_bytes(std::span(bytes)).data() + 1, words.data());
  CHECK(words == std::array<std::uint32_t, 4>{0, 1, 128, 255});
  decode_attribute(Format::kR16G16B16A16Uint, std::as_bytes(std::span(bytes)).data() + 1, words.data());
  CHECK(words == std::array<std::uint32_t, 4>{256, 65408, 2, 65535});
}

TEST_CASE("attribute_format: signed integers keep their sign, and one component comes with 0 0 1") {
  const std::array<std::int16_t, 4> halves{-1, 2, -32768, 32767};
  std::array<std::uint32_t, 4> words{9, 9, 9, 9};
  decode_attribute(Format::kR16G16B16A16Sint, std::as_bytes(std::span(halves)).data(), words.data());
  CHECK(words == std::array<std::uint32_t, 4>{0xffffffffu, 2, 0xffff8000u, 32767});
  const std::array<std::int32_t, 1> one{-7};
  decode_attribute(Format::kR32Sint, std::as_bytes(std::span(one)).data(), words.data());
  CHECK(words == std::array<std::uint32_t, 4>{0xfffffff9u, 0, 0, 1});
}
