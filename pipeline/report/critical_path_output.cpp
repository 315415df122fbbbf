/// The critical path as a table and as JSON.
#include "pipeline/report/critical_path.h"
#include "pipeline/report/unit_facets.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>

namespace quadrille::pipeline {

namespace {

using Json = nlohmann::ordered_json;

/// Parts below that share of the path are left out of the table.
constexpr double kLeastShare = 0.001;
/// Of a draw's own path, parts below are told together.
constexpr double kLeastShareOfDraw = 0.02;

double cycles(hw::Tick ticks, double clock_mhz) { return static_cast<double>(ticks) * clock_mhz * 1e-9; }

Json parts_json(const std::vector<PathShare>& parts, double clock_mhz) {
  Json all = Json::array();
  for (const PathShare& p : parts)
    all.push_back(
        {{"of", p.of}, {"part", name_of(p.part)}, {"by", p.by}, {"cycles", cycles(p.ticks, clock_mhz)}});
  return all;
}

}  // namespace

std::string path_table(const CriticalPath& path, double clock_mhz) {
  std::string text = fmt::format(
      "PATH  what the frame's end waited for, back to its start: each cycle once, in {} stretches\n"
      "  {:<36}{:<10}{:<20}{:>14}{:>9}\n",
      grouped(path.stretches), "unit or link", "", "who waited", "cycles", "%");
  for (const PathShare& part : path.parts) {
    const double share = static_cast<double>(part.ticks) / static_cast<double>(path.ticks);
    if (share < kLeastShare) continue;
    text += fmt::format("  {:<36}{:<10}{:<20}{:>14}{:>9.1f}\n", part.of, name_of(part.part),
                        part.part == PathPart::kLink ? part.by : "",
                        grouped(static_cast<std::uint64_t>(std::llround(cycles(part.ticks, clock_mhz)))),
                        100 * share);
  }
  return text;
}

Json path_json(const CriticalPath& path, double clock_mhz) {
  Json draws = Json::array();
  for (const CriticalPath::OfDraw& draw : path.draws)
    draws.push_back({{"draw", draw.draw == hw::kNoDraw ? Json(nullptr) : Json(draw.draw.index())},
                     {"cycles", cycles(draw.ticks, clock_mhz)},
                     {"parts", parts_json(draw.parts, clock_mhz)}});
  return {{"cycles", cycles(path.ticks, clock_mhz)},
          {"stretches", path.stretches},
          {"log_bytes", path.log_bytes},
          {"parts", parts_json(path.parts, clock_mhz)},
          {"draws", std::move(draws)}};
}

Json draw_path_json(const std::vector<PathShare>& parts, double clock_mhz) {
  hw::Tick all = 0, told = 0;
  std::map<std::string, hw::Tick> by_name;
  for (const PathShare& part : parts) {
    all += part.ticks;
    by_name[part.of] += part.ticks;
  }
  Json json = Json::object();
  for (const auto& [name, ticks] : by_name) {
    if (static_cast<double>(ticks) < kLeastShareOfDraw * static_cast<double>(all)) continue;
    json[name] = cycles(ticks, clock_mhz);
    told += ticks;
  }
  json["others"] = cycles(all - told, clock_mhz);
  return json;
}

}  // namespace quadrille::pipeline
