/// Random choices of the machines and frames that the pipeline's tests make up, by seed.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <random>

namespace quadrille::pipeline::test {

class RandomSource {
 public:
  explicit RandomSource(std::uint64_t seed) : engine_(seed) {}
  /// low <= result <= high.
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  /// low <= result < high.
  float real(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
  int pick(std::initializer_list<int> values) {
    return *(values.begin() + integer(0, static_cast<int>(values.size()) - 1));
  }
  bool chance(double p) { return std::bernoulli_distribution(p)(engine_); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace quadrille::pipeline::test
