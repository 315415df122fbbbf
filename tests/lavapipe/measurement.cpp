#include "tests/lavapipe/measurement.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include <nlohmann/json.hpp>

#include "models/base/error.h"

namespace quadrille::lavapipe {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kLargestSide = 16384;

Json json_of(const PassStatistics& s) {
  return {{"input_vertices", s.input_vertices},
          {"input_primitives", s.input_primitives},
          {"vertex_invocations", s.vertex_invocations},
          {"clipping_invocations", s.clipping_invocations},
          {"clipping_primitives", s.clipping_primitives},
          {"fragment_invocations", s.fragment_invocations},
          {"samples_passed", s.samples_passed}};
}

Json json_of(const DeviceInfo& d) {
  return {{"type", d.type},
          {"api_version", d.api_version},
          {"timestamp_ns", d.timestamp_ns},
          {"timestamp_bits", d.timestamp_bits},
          {"pipeline_statistics", d.pipeline_statistics},
          {"precise_occlusion", d.precise_occlusion},
          {"subpixel_bits", d.subpixel_bits}};
}

Json json_of(const MeasuredPoint& p) {
  Json json = {{"name", p.name}, {"x", p.x}};
  if (!p.times.empty())
    json["time"] = {
        {"median", median(p.times)}, {"least", *std::ranges::min_element(p.times)}, {"all", p.times}};
  if (p.statistics) json["statistics"] = json_of(*p.statistics);
  return json;
}

}  // namespace

double median(std::vector<double> values) {
  QUADRILLE_CHECK(!values.empty(), "median of nothing");
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

std::string to_json(const Measurement& m) {
  Json json = {{"schema", kMeasurementSchema}, {"device", m.device}, {"driver", m.driver}};
  if (m.vulkan) json["vulkan"] = json_of(*m.vulkan);
  json["width"] = m.width;
  json["height"] = m.height;
  json["time_unit"] = m.time_unit;
  json["experiments"] = Json::array();
  for (const MeasuredCurve& c : m.curves) {
    Json points = Json::array();
    for (const MeasuredPoint& p : c.points) points.push_back(json_of(p));
    json["experiments"].push_back({{"name", c.name}, {"axis", c.axis}, {"points", points}});
  }
  return json.dump(1) + "\n";
}

void write_measurement(const std::string& path, const Measurement& measurement) {
  const std::string text = to_json(measurement);
  if (path == "-") {
    fmt::print("{}", text);
    return;
  }
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw user_error("--out: {}: cannot be written", path);
}

std::pair<std::uint32_t, std::uint32_t> parse_target_size(const std::string& text) {
  std::uint32_t width = 0, height = 0;
  char extra = 0;
  if (std::sscanf(text.c_str(), "%5ux%5u%c", &width, &height, &extra) != 2 || width < 1 || height < 1 ||
      width > kLargestSide || height > kLargestSide)
    throw user_error("--size {}: expected WIDTHxHEIGHT, each 1 to {}, for example 1920x1080", text,
                     kLargestSide);
  return {width, height};
}

}  // namespace quadrille::lavapipe
