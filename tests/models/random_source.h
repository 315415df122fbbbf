/// Random numbers for property tests: the same sequence on every machine.
#pragma once

#include <cstdint>
#include <random>

namespace quadrille::models {

class RandomSource {
 public:
  explicit RandomSource(std::uint32_t seed) : engine_(seed) {}
  std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
  /// low <= result <= high.
  std::int32_t integer(std::int32_t low, std::int32_t high) {
    const auto span = static_cast<std::uint64_t>(static_cast<std::int64_t>(high) - low + 1);
    return static_cast<std::int32_t>(
        low + static_cast<std::int64_t>((static_cast<std::uint64_t>(bits()) << 32 | bits()) % span));
  }
  /// low <= result < high.
  float real(float low, float high) {
    return low + (high - low) * (static_cast<float>(bits() >> 8) * 0x1p-24f);
  }

 private:
  std::mt19937 engine_;
};

}  // namespace quadrille::models
