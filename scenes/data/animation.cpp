#include "scenes/data/animation.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace quadrille::scenes {
namespace {

// beyond this cosine the arc is its chord to the last place of a double's square
constexpr double kNearlyParallel = 1 - 1e-9;

using Values = std::vector<double>;

Values values_of(std::span<const float> part) { return {part.begin(), part.end()}; }

double dot(const Values& a, const Values& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Unit length; what has no direction becomes no turn at all.
Values normalized(Values q) {
  const double length = std::sqrt(dot(q, q));
  if (!(length > 0)) return {0, 0, 0, 1};
  for (double& v : q) v /= length;
  return q;
}

Values mix(const Values& a, double weight_a, const Values& b, double weight_b) {
  Values out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = weight_a * a[i] + weight_b * b[i];
  return out;
}

/// Along the shorter arc. [glTF2.0 #appendix-c-interpolation: spherical linear interpolation]
Values slerp(const Values& a, const Values& b, double t) {
  const double cosine = dot(a, b), sign = cosine < 0 ? -1.0 : 1.0;
  if (std::abs(cosine) > kNearlyParallel) return normalized(mix(a, 1 - t, b, sign * t));
  const double angle = std::acos(std::abs(cosine));
  return normalized(
      mix(a, std::sin(angle * (1 - t)) / std::sin(angle), b, sign * std::sin(angle * t) / std::sin(angle)));
}

/// One key's part of the values: 0 tangent in, 1 value, 2 tangent out; other interpolations have values only.
std::span<const float> part(const Keyframes& keys, std::size_t key, std::size_t which) {
  const bool cubic = keys.interpolation == Interpolation::kCubicSpline;
  const std::size_t at = cubic ? 3 * key + which : key;
  return std::span(keys.values).subspan(at * keys.width, keys.width);
}

Values key_value(const Keyframes& keys, std::size_t key) {
  Values v = values_of(part(keys, key, 1));
  return keys.rotation ? normalized(std::move(v)) : v;
}

/// Hermite's spline; tangents are a second's change, so they are scaled by the length of the segment.
Values cubic(const Keyframes& keys, std::size_t key, double t, double seconds) {
  const double t2 = t * t, t3 = t2 * t;
  const Values from = mix(values_of(part(keys, key, 1)), 2 * t3 - 3 * t2 + 1, values_of(part(keys, key, 2)),
                          seconds * (t3 - 2 * t2 + t));
  const Values to = mix(values_of(part(keys, key + 1, 1)), 3 * t2 - 2 * t3, values_of(part(keys, key + 1, 0)),
                        seconds * (t3 - t2));
  const Values sum = mix(from, 1, to, 1);
  return keys.rotation ? normalized(sum) : sum;
}

}  // namespace

std::vector<double> value_at(const Keyframes& keys, double time) {
  const auto after =
      std::ranges::upper_bound(keys.times, time, {}, [](float t) { return static_cast<double>(t); });
  if (after == keys.times.begin()) return key_value(keys, 0);
  const auto key = static_cast<std::size_t>(after - keys.times.begin()) - 1;
  if (after == keys.times.end() || keys.interpolation == Interpolation::kStep) return key_value(keys, key);
  const double start = static_cast<double>(keys.times[key]), seconds = static_cast<double>(*after) - start;
  const double t = (time - start) / seconds;
  if (keys.interpolation == Interpolation::kCubicSpline) return cubic(keys, key, t, seconds);
  const Values a = key_value(keys, key), b = key_value(keys, key + 1);
  return keys.rotation ? slerp(a, b, t) : mix(a, 1 - t, b, t);
}

}  // namespace quadrille::scenes
