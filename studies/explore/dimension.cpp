#include "studies/explore/dimension.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "models/base/error.h"
#include "models/base/near_name.h"

namespace quadrille::studies::explore {
namespace {

constexpr std::size_t kMostLevels = 100'000;

std::string number_text(double value, bool whole) {
  return whole ? fmt::format("{}", std::llround(value)) : fmt::format("{}", value);
}

/// The table of a range, its keys checked.
class Range {
 public:
  Range(const toml::table& table, bool whole, const std::string& where)
      : table_(table), whole_(whole), where_(where) {
    static const std::vector<std::string> kKeys{"from", "to", "step", "factor", "count", "log"};
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::ranges::find(kKeys, name) == kKeys.end())
        throw user_error("{}: unknown key '{}'; a range has {}{}", where, name, fmt::join(kKeys, ", "),
                         did_you_mean(name, kKeys));
    }
    from_ = number("from");
    to_ = number("to");
    if (!(from_ < to_)) throw user_error("{}: from ({}) is not below to ({})", where, from_, to_);
    const int ways = has("step") + has("factor") + has("count");
    if (ways > 1) throw user_error("{}: a range has one of step, factor and count", where);
    if (const toml::node* log = table.get("log")) {
      if (!log->is_boolean()) throw user_error("{}: log: true or false is expected", where);
      log_ = log->as_boolean()->get();
    }
    if ((has("step") || has("factor")) && table.contains("log"))
      throw user_error("{}: log goes with count, or with neither of step, factor and count", where);
    if ((log_ || has("factor")) && from_ <= 0)
      throw user_error("{}: from ({}) is not above 0, as a range by factors needs", where, from_);
  }
  void fill(Dimension& dimension) const {
    if (has("step")) fill_steps(dimension, positive("step"));
    else if (has("factor")) fill_factors(dimension);
    else if (has("count")) fill_count(dimension);
    else {
      dimension.from = from_;
      dimension.to = to_;
      dimension.logarithmic = log_;
      dimension.whole = whole_;
      if (whole_ && (from_ != std::round(from_) || to_ != std::round(to_)))
        throw user_error("{}: from and to are whole numbers, as the parameter is", where_);
    }
  }

 private:
  [[nodiscard]] bool has(const char* key) const { return table_.contains(key); }
  [[nodiscard]] double number(const char* key) const {
    const toml::node* node = table_.get(key);
    const auto value = node == nullptr ? std::nullopt : node->value<double>();
    if (!value || !std::isfinite(*value)) throw user_error("{}: {}: a number is expected", where_, key);
    return *value;
  }
  [[nodiscard]] double positive(const char* key) const {
    const double value = number(key);
    if (!(value > 0)) throw user_error("{}: {} ({}) is not above 0", where_, key, value);
    return value;
  }
  void add(Dimension& dimension, double value) const {
    if (dimension.levels.size() >= kMostLevels)
      throw user_error("{}: more than {} values", where_, kMostLevels);
    if (whole_ && value != std::round(value))
      throw user_error("{}: {} is not a whole number, which the parameter takes", where_, value);
    dimension.levels.push_back(number_text(value, whole_));
  }
  void fill_steps(Dimension& dimension, double step) const {
    // A multiple of the step, so that no error adds up; the last value may miss `to` by a rounding.
    for (double i = 0; from_ + i * step <= to_ + 1e-9 * step; ++i) add(dimension, from_ + i * step);
  }
  void fill_factors(Dimension& dimension) const {
    const double factor = number("factor");
    if (!(factor > 1)) throw user_error("{}: factor ({}) is not above 1", where_, factor);
    for (double value = from_; value <= to_ * (1 + 1e-9); value *= factor) add(dimension, value);
  }
  /// So many values from end to end. Whole numbers are rounded, and those that meet are one.
  void fill_count(Dimension& dimension) const {
    const double count = number("count");
    if (count != std::round(count) || count < 2)
      throw user_error("{}: count ({}) is not a whole number of at least 2", where_, count);
    for (double i = 0; i < count; ++i) {
      const double place = i / (count - 1);
      double value = log_ ? from_ * std::pow(to_ / from_, place) : from_ + (to_ - from_) * place;
      if (whole_) value = std::round(value);
      const std::string text = number_text(value, whole_);
      if (dimension.levels.empty() || dimension.levels.back() != text) add(dimension, value);
    }
  }

  const toml::table& table_;
  bool whole_, log_ = false;
  std::string where_;
  double from_ = 0, to_ = 0;
};

}  // namespace

std::string value_text(const toml::node& node, const std::string& where) {
  if (const auto* v = node.as_integer()) return fmt::format("{}", v->get());
  if (const auto* v = node.as_floating_point()) return fmt::format("{}", v->get());
  if (const auto* v = node.as_boolean()) return v->get() ? "true" : "false";
  if (const auto* v = node.as_string()) return v->get();
  throw user_error("{}: a number, true or false, or a word in quotes is expected", where);
}

Dimension read_dimension(const std::string& name, const toml::node& node, bool whole,
                         const std::string& where) {
  Dimension dimension;
  dimension.name = name;
  dimension.where = where;
  if (const toml::table* table = node.as_table()) {
    Range(*table, whole, where).fill(dimension);
    return dimension;
  }
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty())
    throw user_error(
        "{}: a list of values is expected, as in [1, 2, 4], or a range, as in {{ from = 1, to = 8, step = 1 "
        "}}",
        where);
  for (const toml::node& value : *list) {
    std::string text = value_text(value, where);
    if (std::ranges::find(dimension.levels, text) != dimension.levels.end())
      throw user_error("{}: {} is listed twice", where, text);
    dimension.levels.push_back(std::move(text));
  }
  return dimension;
}

std::string Dimension::at(double place) const {
  if (!continuous()) {
    const auto last = static_cast<double>(levels.size() - 1);
    const double level = std::clamp(std::floor(place * static_cast<double>(levels.size())), 0.0, last);
    return levels[static_cast<std::size_t>(level)];
  }
  // Each whole number gets an equal part of the way, or of its logarithm.
  const double low = whole ? from - 0.5 : from, high = whole ? to + 0.5 : to;
  const double value = logarithmic ? low * std::pow(high / low, place) : low + (high - low) * place;
  return number_text(std::clamp(whole ? std::round(value) : value, from, to), whole);
}

}  // namespace quadrille::studies::explore
