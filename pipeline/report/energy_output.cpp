/// Energy and area as people and programs read them. No figure stands without its range.
#include "pipeline/report/energy.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace quadrille::pipeline {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kMicrojoule = 1e6;        // in pJ
constexpr double kSquareMillimetre = 1e6;  // in um2
constexpr std::size_t kShownDraws = 10, kShownParts = 2;

std::string range_text(const Range& r, double unit) {
  return fmt::format("{:>12.4g}{:>12.4g}{:>12.4g}", r.low / unit, r.typical / unit, r.high / unit);
}

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

/// The parts of a kind of unit that are the most: "lane operations 61 %, instructions 20 %".
template <class Part>
std::string most_of(const std::vector<Part>& parts, Range Part::*value, std::string_view kind,
                    const Range& of) {
  std::vector<const Part*> own;
  for (const Part& part : parts)
    if (part.cost.unit == kind) own.push_back(&part);
  std::ranges::stable_sort(
      own, [&](const Part* a, const Part* b) { return (a->*value).typical > (b->*value).typical; });
  std::string text;
  for (std::size_t i = 0; i < std::min(own.size(), kShownParts); ++i)
    text += fmt::format("{}{} {:.0f} %", i == 0 ? "" : ", ", own[i]->cost.what,
                        percent((own[i]->*value).typical, of.typical));
  return text;
}

template <class Part>
std::string rows(const RangesByKind& units, const std::vector<Part>& parts, Range Part::*value,
                 const Range& total, double unit) {
  std::string out;
  for (const auto& [kind, sum] : units) {
    if (sum.high > 0)
      out += fmt::format("  {:<19}{}{:>9.1f}  {}\n", kind, range_text(sum, unit),
                         percent(sum.typical, total.typical), most_of(parts, value, kind, sum));
  }
  return out + fmt::format("  {:<19}{}\n", "all", range_text(total, unit));
}

std::string head(std::string_view title) {
  return fmt::format("  {:<19}{:>12}{:>12}{:>12}{:>9}  {}\n", title, "low", "typical", "high", "% of all",
                     "most of it");
}

std::string draws_text(const EnergyFigures& e, const Figures& figures) {
  if (e.draws.empty()) return "";
  std::vector<std::size_t> order(e.draws.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return e.draws[a].typical > e.draws[b].typical; });
  std::string out = fmt::format("  {:>6} {:<12}{:>12}{:>12}{:>12}{:>9}  {}\n", "draw", "", "low", "typical",
                                "high", "% of all", "label");
  for (const std::size_t i : std::span(order).first(std::min(order.size(), kShownDraws)))
    out += fmt::format("  {:>6} {:<12}{}{:>9.1f}  {}\n", i, "", range_text(e.draws[i], kMicrojoule),
                       percent(e.draws[i].typical, e.total.typical), figures.detail->draws[i].label);
  return out + fmt::format("  {:<19}{}{:>9.1f}\n", "outside of draws",
                           range_text(e.outside_draws, kMicrojoule),
                           percent(e.outside_draws.typical, e.total.typical));
}

Json range_json(const Range& r) { return {{"low", r.low}, {"typical", r.typical}, {"high", r.high}}; }

Json by_kind_json(const RangesByKind& units) {
  Json all = Json::object();
  for (const auto& [kind, sum] : units) all[kind] = range_json(sum);
  return all;
}

Json cost_json(const Cost& cost) {
  Json json = {{"unit", cost.unit}, {"what", cost.what}, {"constant", cost.constant}, {"times", cost.times}};
  if (cost.bytes > 0) json["array_bytes"] = cost.bytes;
  json["each"] = range_json(cost.each);
  return json;
}

Json area_json(const EnergyFigures& e) {
  Json parts = Json::array();
  for (const AreaPart& part : e.areas) {
    Json json = cost_json(part.cost);
    json["units"] = part.units;
    json["um2"] = range_json(part.area);
    parts.push_back(std::move(json));
  }
  return {{"total", range_json(e.total_area)},
          {"units", by_kind_json(e.unit_areas)},
          {"parts", std::move(parts)}};
}

Json energy_json(const EnergyFigures& e) {
  Json events = Json::array(), constants = Json::object();
  for (const EnergyEvent& event : e.events) {
    Json json = cost_json(event.cost);
    json["counter"] = event.cost.counter;
    json["count"] = event.count;
    json["pj"] = range_json(event.energy);
    events.push_back(std::move(json));
  }
  for (const CostConstant& c : e.constants) {
    constants[c.name] = range_json(c.value);
    constants[c.name]["unit"] = c.unit;
    constants[c.name]["source"] = c.source;
  }
  Json json = {{"file", e.file},
               {"total", range_json(e.total)},
               {"units", by_kind_json(e.units)},
               {"events", std::move(events)}};
  if (!e.draws.empty()) {
    Json draws = Json::array();
    for (const Range& draw : e.draws) draws.push_back(range_json(draw));
    json["draws"] = std::move(draws);
    json["outside_draws"] = range_json(e.outside_draws);
  }
  json["area"] = area_json(e);
  json["constants"] = std::move(constants);
  return json;
}

}  // namespace

std::string energy_table(const EnergyFigures& e, const Figures& figures) {
  return fmt::format(
             "\nENERGY  by {}, in microjoules: relative, with the range of its sources; nothing of leakage, "
             "clocks and wires (docs/energy.md)\n",
             e.file) +
         head("unit") + rows(e.units, e.events, &EnergyEvent::energy, e.total, kMicrojoule) +
         draws_text(e, figures) + "\nAREA  in square millimetres: arrays of memory and arithmetic alone\n" +
         head("unit") + rows(e.unit_areas, e.areas, &AreaPart::area, e.total_area, kSquareMillimetre);
}

std::string figures_with_energy(std::string_view figures_json, const EnergyFigures& energy) {
  Json document = Json::parse(figures_json);
  Json host = std::move(document["host"]);  // stays last
  document.erase("host");
  document["energy"] = energy_json(energy);
  document["host"] = std::move(host);
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadrille::pipeline
