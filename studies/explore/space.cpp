#include "studies/explore/space.h"

#include <xxhash.h>

#include <algorithm>
#include <charconv>
#include <set>

#include <fmt/format.h>

#include "models/base/error.h"
#include "models/base/near_name.h"

namespace quadrille::studies::explore {
namespace {

constexpr double kMostMachines = 1e6;

bool is_parameter(const std::string& name) { return name.find('.') != std::string::npos; }

double number_of(const std::string& text, const std::string& name) {
  if (text == "true" || text == "false") return text == "true" ? 1 : 0;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    throw user_error("{} is {}: a formula needs a number", name, text);
  return value;
}

}  // namespace

std::string machine_hash(const pipeline::MachineConfig& machine) {
  std::string all;
  for (const auto& [path, group] : machine.groups())
    for (const hw::ParamBase* p : group->params())
      all += fmt::format("{}.{}={}\n", path, p->name(), p->literal());
  return fmt::format("{:016x}", XXH3_64bits(all.data(), all.size()));
}

std::vector<std::string> machine_settings(const pipeline::MachineConfig& from,
                                          const pipeline::MachineConfig& machine) {
  std::vector<std::string> settings;
  for (std::size_t g = 0; g < machine.groups().size(); ++g) {
    const auto& [path, group] = machine.groups()[g];
    for (std::size_t p = 0; p < group->params().size(); ++p) {
      const hw::ParamBase& is = *group->params()[p];
      const hw::ParamBase& was = *from.groups()[g].second->params()[p];
      if (is.literal() != was.literal())
        settings.push_back(fmt::format("{}.{}={}", path, is.name(), is.value_text()));
    }
  }
  return settings;
}

Space::Space(const Sweep& sweep) : sweep_(sweep) {
  for (std::size_t i = 0; i < sweep.derived.size(); ++i) check_names(sweep.derived[i].formula, i);
  for (const Expression& constraint : sweep.constraints) check_names(constraint, sweep.derived.size());
}

void Space::check_names(const Expression& formula, std::size_t derived_before) const {
  const pipeline::MachineConfig machine;
  std::vector<std::string> known = machine.paths();
  for (const Dimension& d : sweep_.dimensions)
    if (d.name != "machine") known.push_back(d.name);
  for (const Entry& s : sweep_.settings) known.push_back(s.key);
  for (std::size_t i = 0; i < derived_before; ++i) known.push_back(sweep_.derived[i].name);
  for (const std::string& name : formula.names())
    if (std::ranges::find(known, name) == known.end())
      throw user_error(
          "{}: '{}': '{}' is neither a parameter nor a name of [set], [vary] or, above it, [derive]{}",
          formula.where(), formula.text(), name, did_you_mean(name, known));
}

std::optional<double> Space::free_value(const std::string& name, std::span<const std::string> values,
                                        const pipeline::MachineConfig& machine) const {
  for (std::size_t i = 0; i < sweep_.dimensions.size(); ++i)
    if (sweep_.dimensions[i].name == name) return number_of(values[i], name);
  for (const Entry& setting : sweep_.settings)
    if (setting.key == name) return number_of(setting.value, name);
  for (const Derived& derived : sweep_.derived)
    if (derived.name == name)
      return derived.formula.value([&](const std::string& inner) { return *value(inner, values, machine); });
  return std::nullopt;
}

std::optional<double> Space::value(const std::string& name, std::span<const std::string> values,
                                   const pipeline::MachineConfig& machine) const {
  if (!is_parameter(name)) return free_value(name, values, machine);
  const hw::ParamBase* parameter = machine.find(name);
  if (parameter == nullptr) return std::nullopt;
  return number_of(parameter->value_text(), name);
}

void Space::configure(std::span<const std::string> values, pipeline::MachineConfig& machine) const {
  const auto dimension = std::ranges::find(sweep_.dimensions, "machine", &Dimension::name);
  const bool chosen = dimension != sweep_.dimensions.end();
  pipeline::load_machine(machine,
                         chosen ? values[static_cast<std::size_t>(dimension - sweep_.dimensions.begin())]
                                : sweep_.machines.front());
  machine.begin_layer();
  for (const Entry& setting : sweep_.settings)
    if (is_parameter(setting.key)) machine.set(setting.key, setting.value, setting.where);
  for (std::size_t i = 0; i < sweep_.dimensions.size(); ++i) {
    const Dimension& d = sweep_.dimensions[i];
    if (is_parameter(d.name)) machine.set(d.name, values[i], d.where);
  }
  for (const Derived& derived : sweep_.derived) {
    if (!is_parameter(derived.name)) continue;
    const double result =
        derived.formula.value([&](const std::string& name) { return *value(name, values, machine); });
    const std::vector<std::string_view> words = machine.find(derived.name)->words();
    const bool is_switch =
        words.size() == 2 && words[0] != words[1] && std::ranges::find(words, "true") != words.end();
    machine.set(derived.name, is_switch ? (result != 0 ? "true" : "false") : fmt::format("{}", result),
                derived.formula.where());
  }
  machine.check();
}

void Space::add(std::vector<std::string> values, Plan& plan) const {
  ++plan.tried;
  pipeline::MachineConfig machine;
  try {
    configure(values, machine);
  } catch (const UserError& error) {
    ++plan.excluded[error.what()];
    return;
  }
  for (const Expression& constraint : sweep_.constraints) {
    const double holds =
        constraint.value([&](const std::string& name) { return *value(name, values, machine); });
    if (holds != 0) continue;
    ++plan.excluded[fmt::format("{}: '{}' does not hold", constraint.where(), constraint.text())];
    return;
  }
  std::string name = sweep_.machines.front();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (sweep_.dimensions[i].name == "machine") name = values[i];
  plan.candidates.push_back({std::move(name), std::move(values), machine_hash(machine)});
}

double Space::size() const {
  double machines = 1;
  for (const Dimension& d : sweep_.dimensions) machines *= static_cast<double>(d.levels.size());
  return machines;
}

Plan Space::grid() const {
  if (size() > kMostMachines)
    throw user_error("{}: the grid has {:.0f} machines; at most {:.0f} are drawn: choose design = \"sobol\"",
                     sweep_.file, size(), kMostMachines);
  Plan plan;
  std::vector<std::size_t> level(sweep_.dimensions.size());
  for (bool more = true; more;) {
    std::vector<std::string> values;
    for (std::size_t i = 0; i < level.size(); ++i) values.push_back(sweep_.dimensions[i].levels[level[i]]);
    add(std::move(values), plan);
    more = false;
    for (std::size_t i = level.size(); i-- > 0 && !more;) {  // the last dimension turns fastest
      more = ++level[i] < sweep_.dimensions[i].levels.size();
      if (!more) level[i] = 0;
    }
  }
  return plan;
}

Plan Space::at(std::span<const double> places) const {
  Plan plan;
  std::set<std::vector<std::string>> seen;
  const std::size_t width = sweep_.dimensions.size();
  for (std::size_t row = 0; row + width <= places.size(); row += width) {
    std::vector<std::string> values;
    for (std::size_t i = 0; i < width; ++i) values.push_back(sweep_.dimensions[i].at(places[row + i]));
    if (seen.insert(values).second) {
      add(std::move(values), plan);
    } else {
      ++plan.tried;
      ++plan.repeated;
    }
  }
  return plan;
}

}  // namespace quadrille::studies::explore
