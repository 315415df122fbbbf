/// Anisotropic filters on a plane that is seen at a grazing angle, beside what each pixel should show: a
/// mean of many points of the pattern.
#include "pipeline/render.h"
#include "tests/pipeline/texture_card.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

using namespace quadrille;
using namespace quadrille::pipeline::test;

namespace {

using Footprint = models::AnisotropicFootprint;
constexpr std::uint32_t kSide = 64, kLevels = 7, kSquare = 8;  ///< texels

/// Squares of black and white, and of grey where a level's texels are larger than they.
traces::Image checkerboard() {
  traces::Image image = card_image(traces::Format::kR8G8B8A8Unorm, kSide, kSide, kLevels, 1);
  std::size_t at = 0;
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    const std::uint32_t square = kSquare >> level;
    for (std::uint32_t y = 0; y < kSide >> level; ++y)
      for (std::uint32_t x = 0; x < kSide >> level; ++x)
        for (std::uint32_t c = 0; c < 4; ++c) {
          const bool white = c == 3 || (square != 0 && (x / square + y / square) % 2 == 0);
          image.texels[at++] = static_cast<std::byte>(white ? 255 : square == 0 ? 128 : 0);
        }
  }
  return image;
}

/// A plane whose horizon is three pixels above the picture, turned about the upright. Near the horizon a
/// pixel covers 27 times as much of it one way as the other, at the lower edge twice as much.
struct Plane {
  double across, along, sine, cosine;
  [[nodiscard]] std::array<double, 2> at(double x, double y) const {
    const double u = across * (x - kCardSide / 2.0) / (y + 3), v = along / (y + 3);
    return {cosine * u - sine * v, sine * u + cosine * v};
  }
  [[nodiscard]] std::string glsl() const {
    return fmt::format(
        "texture(t, mat2({0:.8f}, {1:.8f}, -{1:.8f}, {0:.8f}) * vec2({2:.8f} * (at.x - {3}.0), {4:.8f}) / "
        "(at.y + 3.0))",
        cosine, sine, across, kCardSide / 2, along);
  }
  [[nodiscard]] double shade(double x, double y) const {
    const auto [u, v] = at(x, y);
    const auto square = [](double c) { return static_cast<std::int64_t>(std::floor(c * kSide / kSquare)); };
    return (square(u) + square(v)) % 2 == 0 ? 1 : 0;
  }
};

/// The mean of 32 x 32 points around a pixel's centre: of its square, or within a pixel of it and weighed by
/// exp(-2 r^2).
double supersampled(const Plane& plane, double x, double y, bool round) {
  constexpr int kPoints = 32;
  const double reach = round ? 1 : 0.5;
  double sum = 0, weights = 0;
  for (int j = 0; j < kPoints; ++j)
    for (int i = 0; i < kPoints; ++i) {
      const double u = reach * ((2 * i + 1.0) / kPoints - 1), v = reach * ((2 * j + 1.0) / kPoints - 1);
      const double r2 = u * u + v * v, weight = !round ? 1 : r2 < 1 ? std::exp(-2 * r2) : 0;
      weights += weight;
      sum += weight * plane.shade(x + u, y + v);
    }
  return sum / weights;
}

/// Mean differences over a picture, in steps of 255.
struct Errors {
  double square = 0, round = 0;
};

Errors errors_of(const Plane& plane, Footprint footprint) {
  TextureCard card;
  card.image = checkerboard();
  card.sampler.max_anisotropy = 16;
  card.step = {1, 1};
  card.sample = plane.glsl();
  const auto picture =
      pipeline::render_functional_frame(card_stream(card), {.anisotropic_footprint = footprint}).image.linear;
  constexpr double kScale = 255.0 / (kCardSide * kCardSide);
  Errors errors;
  for (std::uint32_t row = 0; row < kCardSide; ++row)
    for (std::uint32_t column = 0; column < kCardSide; ++column) {
      const auto pixel = static_cast<double>(picture[row * kCardSide + column][0]);
      const double x = column + 0.5, y = row + 0.5;
      errors.square += kScale * std::abs(pixel - supersampled(plane, x, y, false));
      errors.round += kScale * std::abs(pixel - supersampled(plane, x, y, true));
    }
  return errors;
}

/// Over planes of several scales and turns.
Errors mean_errors(Footprint footprint) {
  Errors mean;
  for (const double degrees : {0.0, 10.0, 30.0, 45.0})
    for (const double across : {0.2, 0.4, 0.8}) {
      const double turn = degrees * 3.14159265358979 / 180;
      const Errors errors = errors_of({across, 96 * across, std::sin(turn), std::cos(turn)}, footprint);
      mean.square += errors.square / 12;
      mean.round += errors.round / 12;
    }
  return mean;
}

}  // namespace

// docs/real_frames.md has these figures.
TEST_CASE(
    "anisotropy: an ellipse is nearest to a checkerboard of round pixels and samples to one of squares") {
  const Errors difference = mean_errors(Footprint::kLongerDifference),
               axis = mean_errors(Footprint::kEllipseAxis), ellipse = mean_errors(Footprint::kEllipse);
  CHECK(ellipse.round == Approx(5.4).margin(0.1));
  CHECK(axis.round == Approx(13.8).margin(0.1));
  CHECK(difference.round == Approx(13.8).margin(0.1));
  CHECK(ellipse.square == Approx(14.5).margin(0.1));
  CHECK(axis.square == Approx(6.7).margin(0.1));
  CHECK(difference.square == Approx(6.7).margin(0.1));
}
