#include "scenes/environment/panorama.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "models/base/error.h"
#include "scenes/data/parallel.h"
#include "scenes/environment/prefilter.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint32_t kSmallestSide = 16, kLargestSide = 256;  // of a face [G: a second of work]

/// Means of so many times so many pixels, for texels that are larger than pixels.
class Panorama {
 public:
  Panorama(const FloatImage& image, std::uint32_t share)
      : width_(image.width / share), height_(image.height / share), pixels_(std::size_t{width_} * height_) {
    parallel_for(height_, [&](std::size_t row) {
      for (std::size_t column = 0; column < width_; ++column) {
        glm::dvec3 sum(0);
        for (std::size_t y = row * share; y < (row + 1) * share; ++y) {
          const float* pixel = &image.pixels[(y * image.width + column * share) * image.channels];
          for (std::size_t x = 0; x < share; ++x, pixel += image.channels)
            sum += glm::dvec3(pixel[0], pixel[1], pixel[2]);
        }
        pixels_[row * width_ + column] = glm::vec3(sum / (static_cast<double>(share) * share));
      }
    });
  }
  /// Linear between four pixels; 0..1 from left to right and from top to bottom.
  [[nodiscard]] glm::dvec3 sample(double u, double v) const {
    const double x = u * width_ - 0.5, y = std::clamp(v * height_ - 0.5, 0.0, height_ - 1.0);
    const double left = std::floor(x), top = std::floor(y);
    const auto column = [&](double c) {
      return static_cast<std::size_t>(static_cast<std::int64_t>(c) + width_) % width_;
    };
    const auto upper = static_cast<std::size_t>(top);
    const std::size_t lower = std::min<std::size_t>(upper + 1, height_ - 1);
    const auto in_row = [&](std::size_t row) {
      return glm::mix(glm::dvec3(pixels_[row * width_ + column(left)]),
                      glm::dvec3(pixels_[row * width_ + column(left + 1)]), x - left);
    };
    return glm::mix(in_row(upper), in_row(lower), y - top);
  }
  [[nodiscard]] glm::dvec3 sample(const glm::dvec3& d) const {
    return sample(std::atan2(d.z, d.x) * (0.5 * std::numbers::inv_pi) + 0.5,
                  0.5 - std::asin(std::clamp(d.y, -1.0, 1.0)) * std::numbers::inv_pi);
  }
  [[nodiscard]] std::uint32_t width() const { return width_; }

 private:
  std::uint32_t width_, height_;
  std::vector<glm::vec3> pixels_;
};

void check(FloatImage& image, const std::string& name) {
  if (image.width != 2 * image.height)
    throw user_error("{}: {}x{} pixels; a picture of all directions is twice as wide as high", name,
                     image.width, image.height);
  if (image.channels < 3 || image.channels > 4)
    throw user_error("{}: {} channels a pixel; three are due, or four with one that is not looked at", name,
                     image.channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (i % image.channels == 3) continue;
    if (!std::isfinite(image.pixels[i])) {
      const std::size_t pixel = i / image.channels;
      throw user_error("{}: the pixel in column {}, row {} is not finite", name, pixel % image.width,
                       pixel / image.width);
    }
    image.pixels[i] = std::max(image.pixels[i], 0.0F);
  }
}

/// The largest divisor of the sides that leaves pixels no larger than texels.
std::uint32_t share_of(std::uint32_t height, std::uint32_t side) {
  std::uint32_t share = std::max(1U, height / (2 * side));
  while (height % share != 0) --share;
  return share;
}

}  // namespace

RadianceCube cube_of_panorama(FloatImage image, const std::string& name) {
  check(image, name);
  const std::uint32_t side = std::clamp(std::bit_ceil(image.width / 4), kSmallestSide, kLargestSide);
  const Panorama panorama(image, share_of(image.height, side));
  image = {};
  const std::uint32_t along = std::clamp(2 * panorama.width() / (4 * side), 2U, 8U);
  RadianceCube cube(side);
  parallel_for(std::size_t{6} * side, [&](std::size_t line) {
    const int face = static_cast<int>(line / side);
    const auto row = static_cast<std::uint32_t>(line % side);
    const auto place = [&](std::uint32_t texel, std::uint32_t part) {
      return 2 * (texel + (part + 0.5) / along) / side - 1;
    };
    for (std::uint32_t column = 0; column < side; ++column) {
      glm::dvec3 sum(0);
      for (std::uint32_t y = 0; y < along; ++y) {
        for (std::uint32_t x = 0; x < along; ++x)
          sum += panorama.sample(glm::normalize(face_direction(face, place(column, x), place(row, y))));
      }
      cube.at(face, column, row) = glm::vec3(sum / (static_cast<double>(along) * along));
    }
  });
  return cube;
}

}  // namespace quadrille::scenes
