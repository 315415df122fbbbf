/// `quadrille describe`: every parameter and every counter, from their declarations.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "cli/command.h"
#include "cli/counter_catalogue.h"
#include "cli/machine_arguments.h"
#include "models/base/error.h"

namespace quadrille::cli {
namespace {

struct DescribeArguments {
  std::optional<std::string> group;
  bool markdown = false, json = false;
  std::string only = "all";
  MachineArguments machine;
};

/// A group of parameters and a unit's counters share a name, except where only one of them exists.
class Description {
 public:
  explicit Description(const DescribeArguments& arguments) : arguments_(arguments), units_(counter_catalogue()) {
    arguments.machine.apply(config_);
    if (!arguments.group) return;
    std::set<std::string> legal;
    for (const auto& [path, group] : config_.groups()) legal.insert(path.starts_with("link.") ? "link" : path);
    for (const UnitCounters& u : units_) legal.insert(std::string(u.kind));
    const bool link = std::ranges::any_of(config_.groups(), [&](const auto& g) { return g.first == *arguments.group; });
    if (!link && !legal.contains(*arguments.group))
      throw user_error("describe: unknown group '{}'; groups: {}", *arguments.group, fmt::join(legal, ", "));
  }

  /// Calls `visit(path of the group, group)` for what was asked for.
  template <class Visit>
  void each_parameter_group(const Visit& visit) const {
    if (arguments_.only == "counters") return;
    for (const auto& [path, group] : config_.groups()) {
      if (wanted(path) && !group->params().empty()) visit(path, *group);
    }
  }
  /// Calls `visit(kind, counters)` for what was asked for.
  template <class Visit>
  void each_unit(const Visit& visit) const {
    if (arguments_.only == "parameters") return;
    for (const UnitCounters& u : units_) {
      if (wanted(u.kind)) visit(u.kind, *u.stats);
    }
  }
  [[nodiscard]] const std::string& machine_name() const { return config_.name; }

 private:
  [[nodiscard]] bool wanted(std::string_view path) const {
    return !arguments_.group || path == *arguments_.group ||
           (path.starts_with(*arguments_.group) && path.substr(arguments_.group->size()).starts_with('.'));
  }
  const DescribeArguments& arguments_;
  pipeline::MachineConfig config_;
  std::vector<UnitCounters> units_;
};

std::string plain(const Description& d) {
  std::string text;
  d.each_parameter_group([&](const std::string& path, const hw::ParamGroup& group) {
    text += fmt::format("{}\n", path);
    for (const hw::ParamBase* p : group.params()) {
      const std::string changed = p->value_text() == p->default_text() ? "" : fmt::format(" (default {})", p->default_text());
      text += fmt::format("  {:<24} = {}{} {}   [{}]  {}\n", p->name(), p->value_text(), changed, p->unit(), p->legal_text(), p->reason());
    }
  });
  d.each_unit([&](std::string_view kind, const hw::StatGroup& stats) {
    text += fmt::format("{} counts\n", kind);
    for (const hw::Counter* c : stats.counters()) text += fmt::format("  {:<24} {:<12} {}\n", c->name(), c->unit(), c->definition());
  });
  return text;
}

/// A table cell: a bar would end it.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

std::string markdown(const Description& d) {
  std::string parameters, counters;
  d.each_parameter_group([&](const std::string& path, const hw::ParamGroup& group) {
    parameters += fmt::format("\n## {}\n\n| parameter | default | unit | legal | what and why |\n|---|---|---|---|---|\n", path);
    for (const hw::ParamBase* p : group.params()) {
      parameters += fmt::format("| `{}` | {} | {} | {} | {} |\n", p->name(), p->default_text(), cell(p->unit()), cell(p->legal_text()),
                                cell(p->reason()));
    }
  });
  d.each_unit([&](std::string_view kind, const hw::StatGroup& stats) {
    counters += fmt::format("\n## {}\n\n| counter | unit | definition |\n|---|---|---|\n", kind);
    for (const hw::Counter* c : stats.counters())
      counters += fmt::format("| `{}` | {} | {} |\n", c->name(), cell(c->unit()), cell(c->definition()));
  });
  std::string text;
  if (!parameters.empty()) {
    text +=
        "# Parameters\n\nEvery parameter of a machine: a TOML file sets `[group]` `parameter = value`, the command line `--set "
        "group.parameter=value`.\n"
        "A tag in brackets is the source of the default ([sources](sources.md)); `[G]` is a guess.\n" +
        parameters;
  }
  if (!counters.empty()) {
    text += std::string(text.empty() ? "" : "\n") +
            "# Counters\n\nWhat every kind of unit counts. In the JSON of `quadrille render --stats` they are under "
            "`units.<unit>.counters`; a unit of which the\n"
            "machine has several carries its number (`core_0`).\n" +
            counters;
  }
  return text;
}

std::string json(const Description& d) {
  nlohmann::ordered_json document = {{"schema", "quadrille-description-1"}, {"machine", d.machine_name()}};
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object(), counters = nlohmann::ordered_json::object();
  d.each_parameter_group([&](const std::string& path, const hw::ParamGroup& group) {
    for (const hw::ParamBase* p : group.params()) {
      parameters[path + "." + std::string(p->name())] = {{"value", nlohmann::ordered_json::parse(p->value_text())},
                                                         {"default", nlohmann::ordered_json::parse(p->default_text())},
                                                         {"unit", p->unit()},
                                                         {"legal", p->legal_text()},
                                                         {"reason", p->reason()}};
    }
  });
  d.each_unit([&](std::string_view kind, const hw::StatGroup& stats) {
    nlohmann::ordered_json& unit = counters[std::string(kind)] = nlohmann::ordered_json::object();
    for (const hw::Counter* c : stats.counters()) unit[std::string(c->name())] = {{"unit", c->unit()}, {"definition", c->definition()}};
  });
  document["parameters"] = std::move(parameters);
  document["counters"] = std::move(counters);
  return document.dump(2) + "\n";
}

int run_describe(const DescribeArguments& arguments) {
  const Description description(arguments);
  const auto format = arguments.markdown ? markdown : arguments.json ? json : plain;
  fmt::print("{}", format(description));
  return kDone;
}

}  // namespace

void add_describe(CLI::App& app, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("describe", "Lists parameters (value, default, unit, legal values, reason) and counters (unit, definition).");
  const auto arguments = std::make_shared<DescribeArguments>();
  command->add_option("GROUP", arguments->group, "a unit, gpu, link or one link such as link.core_to_texture (default: all)");
  command->add_option("--only", arguments->only, "one half of it")
      ->check(CLI::IsMember({"all", "parameters", "counters"}))
      ->capture_default_str();
  CLI::Option* markdown_flag = command->add_flag("--markdown", arguments->markdown, "as a page of documentation");
  command->add_flag("--json", arguments->json, "as JSON")->excludes(markdown_flag);
  arguments->machine.add_to(*command);
  command->footer(R"(Examples:
  quadrille describe texture
  quadrille describe gpu --machine large
  quadrille describe --only parameters --markdown)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return run_describe(*arguments); }; });
}

}  // namespace quadrille::cli
