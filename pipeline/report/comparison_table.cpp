/// The comparison of two frames as a table for the terminal.
#include "models/base/error.h"
#include "pipeline/report/comparison.h"
#include "pipeline/report/unit_facets.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace quadrille::pipeline {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kRows = 10;  // of each list; the JSON has them all

std::string count(double n) {
  const std::string digits = grouped(static_cast<std::uint64_t>(std::llround(std::abs(n))));
  return n < 0 ? "-" + digits : digits;
}
std::string signed_count(double n) { return n > 0 ? "+" + count(n) : count(n); }
std::string whole(const Json& n) { return count(n.get<double>()); }
std::string change(const Json& pair) { return signed_count(pair["difference"].get<double>()); }

/// "+12.3 %" of the first; empty where there is nothing to take it of.
std::string part(const Json& pair) {
  const double a = pair["a"].get<double>(), difference = pair["difference"].get<double>();
  if (a == 0) return difference == 0 ? "" : "new";
  return fmt::format("{:+.1f} %", 100 * difference / std::abs(a));
}

/// A label shortened in its middle.
std::string fit(std::string text, std::size_t width) {
  text = one_line(std::move(text));
  if (text.size() <= width) return text;
  return text.substr(0, width / 2 - 2) + "..." + text.substr(text.size() - (width - width / 2 - 1));
}

std::string name(const Json& subject) {
  return fmt::format("{}: {}, {}x{}, machine {}, {}", one_line(subject["file"]), one_line(subject["scene"]),
                     whole(subject["width"]), whole(subject["height"]), one_line(subject["machine"]),
                     one_line(subject["fidelity"]));
}

/// Rows of a list under a heading, the first few, and how many there are.
template <class Row>
std::string rows(std::string_view heading, const Json& list, const Row& row) {
  if (list.empty()) return "";
  std::string text = fmt::format("\n{}\n", heading);
  std::size_t shown = 0;
  for (const Json& entry : list) {
    if (shown == kRows) break;
    text += row(entry);
    ++shown;
  }
  if (shown < list.size()) text += fmt::format("  and {} more\n", list.size() - shown);
  return text;
}

std::string value_text(const Json& value) {
  return one_line(value.is_string() ? value.get<std::string>() : value.dump());
}

std::string head(const Json& c) {
  std::string text = fmt::format("COMPARE  A  {}\n         B  {}\n", name(c["a"]), name(c["b"]));
  for (const Json& note : c["notes"]) text += fmt::format("  note: {}\n", note.get<std::string>());
  if (c["parameters"].empty()) text += "\nPARAMETERS  none differ\n";
  return text;
}

std::string parameters(const Json& c) {
  const std::string heading = fmt::format("PARAMETERS that differ {:>36} {:>22}", "A", "B");
  return rows(heading, c["parameters"], [](const Json& p) {
    return fmt::format("  {:<40} {:>16} {:>22}\n", p["path"].get<std::string>(), value_text(p["a"]),
                       value_text(p["b"]));
  });
}

std::string frame(const Json& c) {
  std::string text = fmt::format("\nFRAME {:>42} {:>16} {:>16} {:>10}\n", "A", "B", "difference", "of A");
  for (const auto& [key, pair] : c["frame"].items()) {
    if (pair["difference"] == 0 && key != "cycles" && key != "least_cycles") continue;
    text += fmt::format("  {:<29} {:>16} {:>16} {:>16} {:>10}\n", one_line(key), whole(pair["a"]),
                        whole(pair["b"]), change(pair), part(pair));
  }
  return text + fmt::format("  limit of A: {}\n  limit of B: {}\n", one_line(c["a"]["limit"]),
                            one_line(c["b"]["limit"]));
}

std::string units(const Json& c) {
  const std::string heading = fmt::format(
      "UNITS  mean cycles of a unit, by the change of its own time (busy + waiting)\n"
      "  {:<20} {:>12} {:>12} {:>13} {:>12} {:>12} {:>12} {:>12}  use, A and B",
      "unit", "own A", "own B", "difference", "busy", "waiting", "starved", "blocked");
  return rows(heading, c["units"], [](const Json& u) {
    const Json &n = u["units"], &use = u["use"];
    const std::string many = n["a"] == n["b"] ? fmt::format(" x{}", whole(n["a"]))
                                              : fmt::format(" x{}, x{}", whole(n["a"]), whole(n["b"]));
    return fmt::format("  {:<20} {:>12} {:>12} {:>13} {:>12} {:>12} {:>12} {:>12}  {:.1f} %, {:.1f} %\n",
                       fit(u["kind"].get<std::string>(), 20 - many.size()) + many, whole(u["own"]["a"]),
                       whole(u["own"]["b"]), change(u["own"]), change(u["busy"]), change(u["waiting"]),
                       change(u["starved"]), change(u["blocked"]), 100 * use["a"].get<double>(),
                       100 * use["b"].get<double>());
  });
}

std::string critical_path(const Json& c) {
  if (!c.contains("critical_path")) return "";
  const std::string heading = fmt::format(
      "PATH  what the frames' ends waited for; the differences add up to that of the cycles\n"
      "  {:<36} {:<8} {:<17} {:>13} {:>13} {:>13} {:>10}",
      "unit or link", "", "who waited", "A", "B", "difference", "of A");
  return rows(heading, c["critical_path"], [](const Json& p) {
    const Json& cycles = p["cycles"];
    const std::string of = one_line(p["of"]), by = one_line(p["by"]);
    return fmt::format("  {:<36} {:<8} {:<17} {:>13} {:>13} {:>13} {:>10}\n", fit(of, 36),
                       fit(one_line(p["part"]), 8), of == by ? "" : fit(by, 17), whole(cycles["a"]),
                       whole(cycles["b"]), change(cycles), part(cycles));
  });
}

std::string counters(const Json& c) {
  const std::string heading = fmt::format(
      "COUNTERS  all units of a kind, by how many times {:>24} {:>16} {:>16}", "A", "B", "difference");
  return rows(heading, c["counters"], [](const Json& entry) {
    const std::string path = entry["kind"].get<std::string>() + "." + entry["name"].get<std::string>();
    return fmt::format("  {:<55} {:>16} {:>16} {:>16} {:>10}\n", fit(path, 55), whole(entry["a"]),
                       whole(entry["b"]), change(entry), part(entry));
  });
}

std::string bandwidth(const Json& c) {
  const std::string heading =
      fmt::format("BYTES of the L2 cache's clients {:>16} {:>16} {:>16}", "A", "B", "difference");
  return rows(heading, c["bandwidth"], [](const Json& client) {
    const Json& bytes = client["bytes"];
    return fmt::format("  {:<29} {:>16} {:>16} {:>16} {:>10}\n", one_line(client["client"]),
                       whole(bytes["a"]), whole(bytes["b"]), change(bytes), part(bytes));
  });
}

std::string draws(const Json& c) {
  if (!c.contains("draws")) return "";
  const std::string heading = fmt::format(
      "DRAWS  by the change of their cycles in flight\n  {:<44} {:>13} {:>13} {:>13} {:>10}  limiter", "draw",
      "in flight A", "in flight B", "difference", "of A");
  return rows(heading, c["draws"], [](const Json& d) {
    const Json& at = d["number"]["a"].is_null() ? d["number"]["b"] : d["number"]["a"];
    const std::string a = one_line(d["limiter"]["a"]), b = one_line(d["limiter"]["b"]);
    return fmt::format("  {:<44} {:>13} {:>13} {:>13} {:>10}  {}\n",
                       fmt::format("{} {}", at.dump(), fit(d["label"].get<std::string>(), 38)),
                       whole(d["cycles"]["a"]), whole(d["cycles"]["b"]), change(d["cycles"]),
                       part(d["cycles"]),
                       a == b ? a : fmt::format("{} -> {}", a.empty() ? "-" : a, b.empty() ? "-" : b));
  });
}

/// Each count of the squares: its totals, and the square that changed most.
std::string tiles(const Json& c) {
  if (!c.contains("tiles")) return "";
  const Json& t = c["tiles"];
  const auto columns = t["width"].get<std::size_t>(), side = t["tile_pixels"].get<std::size_t>();
  std::string text = fmt::format("\nSQUARES of {} pixels {:>27} {:>16} {:>16}  the one that changed most\n",
                                 side, "A", "B", "difference");
  for (const auto& [key, entry] : t["counts"].items()) {
    std::size_t most = 0;
    const Json& squares = entry["squares"];
    for (std::size_t i = 0; i < squares.size(); ++i)
      if (std::abs(squares[i].get<double>()) > std::abs(squares[most].get<double>())) most = i;
    const Json& total = entry["total"];
    const bool any = !squares.empty() && squares[most] != 0;
    text += fmt::format("  {:<29} {:>16} {:>16} {:>16}  {}\n", one_line(key), whole(total["a"]),
                        whole(total["b"]), change(total),
                        any ? fmt::format("{} at {}, {}", signed_count(squares[most].get<double>()),
                                          most % columns * side, most / columns * side)
                            : "none");
  }
  return text;
}

}  // namespace

std::string comparison_table(std::string_view comparison_json) {
  const Json c = Json::parse(comparison_json);
  return head(c) + parameters(c) + frame(c) + critical_path(c) + units(c) + bandwidth(c) + draws(c) +
         tiles(c) + counters(c);
}

}  // namespace quadrille::pipeline
