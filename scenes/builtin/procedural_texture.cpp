#include "scenes/builtin/procedural_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scenes/image/mip_chain.h"

namespace quadrille::scenes {
namespace {

int wrapped(int x, int period) { return ((x % period) + period) % period; }

/// The nearest of the steps 0 .. `last` into which 0 .. 1 is divided.
std::size_t nearest_step(float value, float last) {
  const float scaled = std::clamp(value, 0.0F, 1.0F) * last + 0.5F;
  return static_cast<std::size_t>(scaled);
}

std::uint8_t to_byte(float value) { return static_cast<std::uint8_t>(nearest_step(value, 255)); }

float noise_octave(glm::vec2 p, int period, std::uint32_t seed) {
  const glm::vec2 cell = glm::floor(p);
  const glm::vec2 f = p - cell, s = f * f * (3.0F - 2.0F * f);
  const int x0 = wrapped(static_cast<int>(cell.x), period), y0 = wrapped(static_cast<int>(cell.y), period);
  const int x1 = wrapped(x0 + 1, period), y1 = wrapped(y0 + 1, period);
  const float top = glm::mix(lattice_random(x0, y0, seed), lattice_random(x1, y0, seed), s.x);
  const float bottom = glm::mix(lattice_random(x0, y1, seed), lattice_random(x1, y1, seed), s.x);
  return glm::mix(top, bottom, s.y);
}

/// sRGB bytes of linear values, by table: painting evaluates millions.
std::uint8_t encode(float linear) {
  static const std::array<std::uint8_t, 4096> kTable = [] {
    std::array<std::uint8_t, 4096> table{};
    for (std::size_t i = 0; i < table.size(); ++i)
      table[i] = to_byte(static_cast<float>(linear_to_srgb(static_cast<double>(i) / 4095)));
    return table;
  }();
  return kTable[nearest_step(linear, 4095)];
}

}  // namespace

float lattice_random(int x, int y, std::uint32_t seed) {
  // An integer mixer of multiplications and shifts; any avalanche will do, it only has to be the same
  // everywhere.
  std::uint32_t h = seed * 0x9e3779b9U + static_cast<std::uint32_t>(x) * 0x85ebca6bU +
                    static_cast<std::uint32_t>(y) * 0xc2b2ae35U;
  h = (h ^ (h >> 15)) * 0x2c1b3c6dU;
  h = (h ^ (h >> 12)) * 0x297a2d39U;
  h ^= h >> 15;
  return static_cast<float>(h >> 8) * (1.0F / 16777216.0F);
}

float tiling_noise(glm::vec2 p, int period, int octaves, std::uint32_t seed) {
  float sum = 0, weight = 0.5F, total = 0;
  for (int i = 0; i < octaves; ++i) {
    sum += weight * noise_octave(p, period, seed + static_cast<std::uint32_t>(i));
    total += weight;
    p *= 2.0F;
    period *= 2;
    weight *= 0.5F;
  }
  return sum / total;
}

CellPoint tiling_cells(glm::vec2 p, int period, std::uint32_t seed) {
  const glm::ivec2 cell(glm::floor(p));
  float nearest = 1e9F, second = 1e9F, random = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = wrapped(cell.x + dx, period), y = wrapped(cell.y + dy, period);
      const glm::vec2 jitter(lattice_random(x, y, seed), lattice_random(x, y, seed + 77));
      const glm::vec2 point = glm::vec2(cell + glm::ivec2(dx, dy)) + 0.5F + 0.7F * (jitter - 0.5F);
      const float distance = glm::length(p - point);
      second = std::min(second, std::max(distance, nearest));
      if (distance < nearest) {
        nearest = distance;
        random = lattice_random(x, y, seed + 991);
      }
    }
  }
  return {second - nearest, random};
}

float smooth_ramp(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

Rgba8Image paint(std::uint32_t size, bool srgb, const std::function<glm::vec4(glm::vec2)>& color) {
  Rgba8Image image{size, size, std::vector<std::uint8_t>(std::size_t{4} * size * size)};
  std::size_t at = 0;
  for (std::uint32_t y = 0; y < size; ++y) {
    for (std::uint32_t x = 0; x < size; ++x, at += 4) {
      const glm::vec4 c = color((glm::vec2(x, y) + 0.5F) / static_cast<float>(size));
      for (int i = 0; i < 3; ++i)
        image.pixels[at + static_cast<std::size_t>(i)] = srgb ? encode(c[i]) : to_byte(c[i]);
      image.pixels[at + 3] = to_byte(c.a);
    }
  }
  return image;
}

Rgba8Image paint_normals(std::uint32_t size, float depth, const std::function<float(glm::vec2)>& height) {
  std::vector<float> field(std::size_t{size} * size);
  for (std::uint32_t y = 0; y < size; ++y) {
    for (std::uint32_t x = 0; x < size; ++x)
      field[std::size_t{size} * y + x] = height((glm::vec2(x, y) + 0.5F) / static_cast<float>(size));
  }
  const auto sample = [&](std::uint32_t x, std::uint32_t y) {
    return field[std::size_t{size} * (y % size) + x % size];
  };
  const float slope = 0.5F * depth * static_cast<float>(size);
  Rgba8Image image{size, size, {}};
  image.pixels.reserve(std::size_t{4} * size * size);
  for (std::uint32_t y = 0; y < size; ++y) {
    for (std::uint32_t x = 0; x < size; ++x) {
      const float du = sample(x + 1, y) - sample(x + size - 1, y),
                  dv = sample(x, y + 1) - sample(x, y + size - 1);
      // green points up, against v
      const glm::vec3 n = glm::normalize(glm::vec3(-du * slope, dv * slope, 1));
      for (int i = 0; i < 3; ++i) image.pixels.push_back(to_byte(0.5F * n[i] + 0.5F));
      image.pixels.push_back(255);
    }
  }
  return image;
}

}  // namespace quadrille::scenes
