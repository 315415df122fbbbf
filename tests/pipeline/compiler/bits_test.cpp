/// Operations on the bits of integers, beside the host's.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <array>
#include <bit>

#include "tests/pipeline/compiler/shader_runner.h"

namespace quadrille::pipeline {

TEST_CASE("bits: those of integers are counted, turned, taken out and put in") {
  RunInput input;
  constexpr std::array<std::uint32_t, 8> kWords{0u,          1u,          0x80000000u, 0xffffffffu,
                                                0x12345678u, 0xdeadbeefu, 0x00800000u, 0xa5a5a5a5u};
  for (std::uint32_t k = 0; k < models::kWarpQuads; ++k)
    for (std::int32_t& v : input.points[k].i) v = static_cast<std::int32_t>(kWords[k]);
  /// The word that the expression gives, in two halves.
  const auto words = [&](const std::string& expression) {
    const RunOutput out =
        run_snippet("uint w = uint(" + expression + "); color = vec4(w & 0xffffu, w >> 16, 0, 0);", input);
    std::array<std::uint32_t, models::kWarpQuads> all{};
    for (int k = 0; k < models::kWarpQuads; ++k)
      all.at(static_cast<std::size_t>(k)) =
          static_cast<std::uint32_t>(out.point(k)[0]) | static_cast<std::uint32_t>(out.point(k)[1]) << 16;
    return all;
  };
  const auto reversed = [](std::uint32_t x) {
    std::uint32_t r = 0;
    for (int bit = 0; bit < 32; ++bit) r |= (x >> bit & 1u) << (31 - bit);
    return r;
  };
  const auto counted = words("bitCount(i.x)"), turned = words("bitfieldReverse(i.x)");
  for (std::size_t k = 0; k < kWords.size(); ++k) {
    CHECK(counted.at(k) == static_cast<std::uint32_t>(std::popcount(kWords.at(k))));
    CHECK(turned.at(k) == reversed(kWords.at(k)));
  }
  for (const auto& [offset, bits] : {std::pair{0, 0}, {0, 32}, {4, 8}, {31, 1}, {32, 0}, {7, 25}}) {
    const std::string where = fmt::format("{} + (i.x & 0), {} + (i.x & 0)", offset, bits);
    const auto plain = words("bitfieldExtract(uint(i.x), " + where + ")"),
               with_sign = words("bitfieldExtract(i.x, " + where + ")"),
               put_in = words("bitfieldInsert(i.x, 0x2d2d2d2d, " + where + ")");
    CAPTURE(offset, bits);
    for (std::size_t k = 0; k < kWords.size(); ++k) {
      const std::uint64_t low = (std::uint64_t{1} << bits) - 1, x = kWords.at(k), field = x >> offset & low;
      const bool negative = bits > 0 && (field >> (bits - 1) & 1) != 0;
      CHECK(plain.at(k) == static_cast<std::uint32_t>(field));
      CHECK(with_sign.at(k) == static_cast<std::uint32_t>(negative ? field | ~low : field));
      CHECK(put_in.at(k) ==
            static_cast<std::uint32_t>((x & ~(low << offset)) | ((0x2d2d2d2du & low) << offset)));
    }
  }
}

TEST_CASE("bits: those of integers are found") {
  RunInput input;
  for (std::uint32_t k = 0; k < models::kWarpQuads; ++k) {
    const auto bits = std::array<std::uint32_t, 8>{0u,          1u,          0x80000000u, 0xffffffffu,
                                                   0x01ffffffu, 0x7fffffffu, 0x00800000u, 0xfffffffeu}[k];
    for (std::int32_t& v : input.points[k].i) v = static_cast<std::int32_t>(bits);
  }
  const RunOutput out =
      run_snippet("color = vec4(findLSB(i.x), findMSB(i.x), findMSB(uint(i.x)), findLSB(uint(i.x)));", input);
  for (int k = 0; k < models::kWarpQuads; ++k) {
    const std::int32_t x = input.points[static_cast<std::size_t>(k)].i[0];
    const auto u = static_cast<std::uint32_t>(x);
    const float low = u == 0 ? -1.0f : static_cast<float>(std::countr_zero(u));
    const float high = 31.0f - static_cast<float>(std::countl_zero(x < 0 ? ~u : u));
    CHECK(out.point(k) == Vec4{low, high, 31.0f - static_cast<float>(std::countl_zero(u)), low});
  }
}

}  // namespace quadrille::pipeline
