#include "models/texture/ellipse_texels.h"

#include "models/base/error.h"

#include <algorithm>
#include <cmath>

namespace quadrille::models {
namespace {

constexpr float kMostChange = 1e9f;      // whose fourth power is still a number
constexpr float kWidestSquared = 4.0f;   // of the shorter axis: below two texels
constexpr float kReconstruction = 1.0f;  // the circle that a texel stands for
constexpr float kSpare = 0.25f;          // texels that a chord's ends may be off by

/// exp(-2 i / kEllipseSteps).
constexpr std::array<float, kEllipseSteps + 1> weights() {
  // exp(-x) of a step by its series: the next term is below 1e-16.
  constexpr double x = 2.0 / kEllipseSteps;
  constexpr double step = 1.0 - x * (1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0))));
  std::array<float, kEllipseSteps + 1> table{};
  double weight = 1.0;
  for (float& entry : table) {
    entry = static_cast<float>(weight);
    weight *= step;
  }
  return table;
}
constexpr std::array<float, kEllipseSteps + 1> kWeights = weights();

struct Chord {
  std::int32_t from = 0, to = -1;  ///< columns; empty where `to` is less
};

/// The columns of a row in which texels may have a weight.
Chord chord(const TexelEllipse& e, float x, float v) {
  const float middle = -e.b * v / (2.0f * e.a);
  const float half2 = middle * middle - (e.c * v * v - (kEllipseSteps + 1)) / e.a;
  const float half = std::sqrt(std::max(half2, 0.0f)) + kSpare;
  return {static_cast<std::int32_t>(std::ceil(x + middle - half)),
          static_cast<std::int32_t>(std::floor(x + middle + half))};
}

float limited(float change) { return std::clamp(change, -kMostChange, kMostChange); }

}  // namespace

TexelEllipse texel_ellipse(std::array<float, 2> along_x, std::array<float, 2> along_y, float most) {
  const float ux = limited(along_x[0]), vx = limited(along_x[1]), uy = limited(along_y[0]),
              vy = limited(along_y[1]);
  float uu = ux * ux + uy * uy, vv = vx * vx + vy * vy, uv = ux * vx + uy * vy;
  const float difference = uu - vv, area = ux * vy - uy * vx;
  float long2 = 0.5f * (uu + vv + std::sqrt(difference * difference + 4.0f * uv * uv));
  float short2 = long2 > 0.0f ? area * area / long2 : 0.0f;
  const float least = 1.0f / (most * most);
  const float widest2 = std::max(short2, long2 * least);
  const float scale = widest2 > kWidestSquared ? kWidestSquared / widest2 : 1.0f;
  long2 = long2 * scale + kReconstruction;
  short2 = std::min(short2 * scale + kReconstruction, long2);
  uu = uu * scale + kReconstruction;
  vv = vv * scale + kReconstruction;
  uv *= scale;
  if (short2 < long2 * least) {
    // (long2 - J J') / (long2 - short2) is the square of the shorter axis' direction.
    const float wider = (long2 * least - short2) / (long2 - short2);
    uu += wider * (long2 - uu);
    vv += wider * (long2 - vv);
    uv -= wider * uv;
    short2 = long2 * least;
  }
  const float steps = static_cast<float>(kEllipseSteps) / (long2 * short2);
  return {vv * steps, -2.0f * uv * steps, uu * steps, std::sqrt(uu), std::sqrt(vv)};
}

float ellipse_weight(const TexelEllipse& e, float u, float v) {
  const float q = (e.a * u + e.b * v) * u + e.c * v * v;
  if (!(q < static_cast<float>(kEllipseSteps + 1))) return 0.0f;
  return kWeights[static_cast<std::size_t>(std::max(q, 0.0f))];
}

int ellipse_footprints(const TexelEllipse& e, float x, float y,
                       std::span<EllipseFootprint, kMaxEllipseFootprints> out) {
  int count = 0;
  const auto last = static_cast<std::int32_t>(std::floor(y + e.half_height + kSpare));
  for (auto row = static_cast<std::int32_t>(std::ceil(y - e.half_height - kSpare)); row <= last;) {
    const float upper = static_cast<float>(row) - y, lower = static_cast<float>(row + 1) - y;
    const Chord first = chord(e, x, upper), second = chord(e, x, lower);
    const std::int32_t end = std::max(first.to, second.to);
    for (std::int32_t column = std::min(first.from, second.from); column <= end;) {
      const float left = static_cast<float>(column) - x, right = static_cast<float>(column + 1) - x;
      const std::array<float, 4> weight{ellipse_weight(e, left, upper), ellipse_weight(e, right, upper),
                                        ellipse_weight(e, left, lower), ellipse_weight(e, right, lower)};
      if (weight[0] == 0.0f && weight[2] == 0.0f) {
        ++column;
        continue;
      }
      QUADRILLE_CHECK(count < kMaxEllipseFootprints, "an ellipse of {} x {} texels", 2 * e.half_width,
                      2 * e.half_height);
      out[static_cast<std::size_t>(count)] = {column, row, weight};
      ++count;
      column += 2;
    }
    row += 2;
  }
  return count;
}

}  // namespace quadrille::models
