/// What was measured, of a device or of the simulated machine, and its JSON: one form for both, so that a
/// program that compares needs to know only one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/lavapipe/vulkan_queries.h"

namespace quadrille::lavapipe {

inline constexpr const char* kMeasurementSchema = "quadrille-measurement-1";

struct MeasuredPoint {
  std::string name;
  double x = 0;
  std::vector<double> times;  ///< of the passes, one a repetition; empty: not kept
  std::optional<PassStatistics> statistics;
};

struct MeasuredCurve {
  std::string name, axis;
  std::vector<MeasuredPoint> points;
};

struct Measurement {
  std::string device, driver;
  std::optional<DeviceInfo> vulkan;  ///< of a Vulkan device
  std::string time_unit;             ///< "ns" or "clk"
  std::uint32_t width = 0, height = 0;
  std::vector<MeasuredCurve> curves;
};

/// The middle one of an odd number, else the mean of the two in the middle. At least one.
[[nodiscard]] double median(std::vector<double> values);

[[nodiscard]] std::string to_json(const Measurement& measurement);
/// Writes the JSON to a file, or to standard output where `path` is "-". Throws `UserError`.
void write_measurement(const std::string& path, const Measurement& measurement);

/// "1920x1080" of --size, each side 1 to 16384. Throws `UserError`.
[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> parse_target_size(const std::string& text);

}  // namespace quadrille::lavapipe
