#include "pipeline/report/flat_figures.h"

#include "pipeline/report/csv_field.h"
#include "pipeline/report/report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace quadrille::pipeline {

namespace {

using Json = nlohmann::ordered_json;

class Table {
 public:
  explicit Table(const Json& document) : definitions_(document["counter_definitions"]) {
    for (const auto& [unit, figures] : document["units"].items()) { add("units." + unit, figures); }
    for (const auto& [key, value] : document.items())
      if (key != "units" && key != "counter_definitions") add(key, value);
  }
  [[nodiscard]] std::string text() const { return "path,value,unit\r\n" + text_; }

 private:
  void add(const std::string& path, const Json& value) {
    if (value.is_object()) {
      for (const auto& [key, entry] : value.items()) add(path + "." + key, entry);
    } else if (value.is_array()) {
      std::size_t at = 0;
      for (const Json& entry : value) add(fmt::format("{}[{}]", path, at++), entry);
    } else {
      const std::string shown = value.is_string() ? value.get<std::string>()
                                : value.is_null() ? ""
                                                  : value.dump();
      text_ += fmt::format("{},{},{}\r\n", csv_field(path), csv_field(shown), unit_of(path));
    }
  }

  /// Of "units.core_0.counters.instructions": "instruction". Other values have none.
  [[nodiscard]] std::string unit_of(std::string_view path) const {
    constexpr std::string_view kUnits = "units.", kCounters = ".counters.";
    const std::size_t counters = path.find(kCounters);
    if (!path.starts_with(kUnits) || counters == std::string_view::npos) return "";
    const std::string kind(without_number(path.substr(kUnits.size(), counters - kUnits.size())));
    const std::string name(path.substr(counters + kCounters.size()));
    return csv_field(definitions_[kind][name]["unit"].get<std::string>());
  }

  const Json& definitions_;
  std::string text_;
};

}  // namespace

std::string figures_csv(std::string_view figures_json) { return Table(Json::parse(figures_json)).text(); }

}  // namespace quadrille::pipeline
