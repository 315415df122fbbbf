/// Keyframes: values over time, and the value at a time. [glTF2.0 #animations, #appendix-c-interpolation]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::scenes {

enum class Interpolation : std::uint8_t { kStep, kLinear, kCubicSpline };

/// The values of one track, all keys of one width. Times are in seconds, not negative, and increase strictly.
struct Keyframes {
  Interpolation interpolation = Interpolation::kLinear;
  std::size_t width = 1;  ///< components of a value
  /// unit quaternions (x, y, z, w): linear means spherically linear, results are normalized
  bool rotation = false;
  std::vector<float> times;
  std::vector<float> values;  ///< key by key; of a cubic spline the tangent in, the value and the tangent out
};

/// The value at `time`: before the first key the first value, after the last the last. Computed in double.
[[nodiscard]] std::vector<double> value_at(const Keyframes& keys, double time);

/// What a track moves.
enum class TrackTarget : std::uint8_t { kTranslation, kRotation, kScale, kWeights };

struct Track {
  int node = 0;
  TrackTarget target = TrackTarget::kTranslation;
  std::size_t keyframes = 0;  ///< into `Animation::keyframes`
};

struct Animation {
  std::string name;
  std::vector<Keyframes> keyframes;
  std::vector<Track> tracks;
  double length = 0;  ///< seconds: the last key of all tracks
};

}  // namespace quadrille::scenes
