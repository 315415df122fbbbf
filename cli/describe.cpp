/// `quadrille describe`: every parameter and every counter, from their declarations.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "cli/command.h"
#include "cli/machine_arguments.h"
#include "cli/machine_diagram.h"
#include "cli/vendor_counters.h"
#include "models/base/error.h"
#include "models/base/near_name.h"
#include "pipeline/machine/counter_catalogue.h"

namespace quadrille::cli {
namespace {

struct DescribeArguments {
  std::optional<std::string> what, name, as;
  bool markdown = false, json = false, toml = false, diagram = false;
  std::string only = "all";
  MachineArguments machine;
};

constexpr std::string_view kCounters = "counters";  // as WHAT: every counter
constexpr std::string_view kMachine = "machine";    // as WHAT: every parameter of the machine that NAME is

/// Counters of a kind of unit.
using DescribedUnit = std::pair<std::string, std::vector<const hw::Statistic*>>;

/// What was asked for. A group of parameters and a unit's counters share a name, except where only one of
/// them exists.
class Description {
 public:
  explicit Description(const DescribeArguments& arguments) : units_(pipeline::counter_catalogue()) {
    MachineArguments machine = arguments.machine;
    const bool whole_machine = arguments.what == kMachine;
    if (arguments.name && !whole_machine)
      throw user_error("describe: '{}' after '{}': a name goes with 'describe machine'", *arguments.name,
                       *arguments.what);
    if (arguments.what && arguments.what->empty())
      throw user_error("describe: WHAT is empty; without it everything is listed");
    if (arguments.name && machine.machine != MachineArguments().machine)
      throw user_error("describe: the machine is named twice: '{}', and --machine '{}'", *arguments.name,
                       machine.machine);
    if (arguments.toml && arguments.only == "counters")
      throw user_error("describe: --toml writes parameters, and --only counters leaves none");
    if (arguments.diagram && !whole_machine)
      throw user_error("describe: --diagram draws a whole machine: 'describe machine --diagram'");
    if (arguments.name) machine.machine = *arguments.name;
    machine.apply(config_);
    const bool all_counters = arguments.what == kCounters;
    const bool parameters = arguments.only != "counters" && !all_counters,
               counters = arguments.only != "parameters" && !whole_machine && !arguments.toml;
    const bool everything = whole_machine || all_counters || !arguments.what;
    select(everything ? "" : *arguments.what, parameters, counters);
  }

  [[nodiscard]] const std::vector<pipeline::DescribedGroup>& groups() const { return groups_; }
  [[nodiscard]] const std::vector<DescribedUnit>& units() const { return described_units_; }
  [[nodiscard]] const pipeline::MachineConfig& machine() const { return config_; }

 private:
  /// Whether `what` asks for an entry of a group; a way to ask is tried only when those before it find
  /// nothing.
  using Asks = bool (*)(std::string_view what, std::string_view group, std::string_view entry);
  static constexpr std::array<Asks, 4> kWays{
      [](std::string_view what, std::string_view group, std::string_view) {
        return what.empty() || group == what ||
               (group.starts_with(what) && group.substr(what.size()).starts_with('.'));
      },
      [](std::string_view what, std::string_view group, std::string_view) {
        return what.starts_with("link.") && group.starts_with(what);
      },
      [](std::string_view what, std::string_view group, std::string_view entry) {
        return what.size() == group.size() + 1 + entry.size() && what.starts_with(group) &&
               what[group.size()] == '.' && what.ends_with(entry);
      },
      [](std::string_view what, std::string_view, std::string_view entry) { return what == entry; }};

  void select(std::string_view what, bool parameters, bool counters) {
    bool exists = false;
    for (const Asks asks : kWays) {
      for (const auto& [path, group] : config_.groups())
        exists |= take(group->params(), path, what, asks, parameters ? &groups_ : nullptr);
      for (const pipeline::UnitCounters& u : units_)
        exists |=
            take(u.stats->all(), std::string(u.kind), what, asks, counters ? &described_units_ : nullptr);
      if (exists) return;
    }
    throw unknown(what);
  }

  /// Puts what is asked for of a group `into` the list, if there is one; whether there was any.
  template <class Entry, class Into>
  static bool take(const std::vector<Entry*>& entries, const std::string& path, std::string_view what,
                   Asks asks, Into* into) {
    typename Into::value_type found{path, {}};
    for (const Entry* entry : entries) {
      if (asks(what, path, entry->name())) found.second.push_back(entry);
    }
    const bool any = !found.second.empty();
    if (any && into != nullptr) into->push_back(std::move(found));
    return any;
  }

  [[nodiscard]] UserError unknown(std::string_view what) const {
    std::set<std::string> legal;
    std::vector<std::string> names = config_.paths();
    for (const auto& [path, group] : config_.groups()) {
      legal.insert(path.starts_with("link.") ? "link" : path);
      names.push_back(path);
    }
    for (const pipeline::UnitCounters& u : units_) {
      legal.insert(std::string(u.kind));
      names.emplace_back(u.kind);
      for (const hw::Statistic* c : u.stats->all()) names.push_back(fmt::format("{}.{}", u.kind, c->name()));
    }
    return user_error("describe: no group, parameter or counter '{}'; groups: {}{}", what,
                      fmt::join(legal, ", "), did_you_mean(what, names));
  }

  pipeline::MachineConfig config_;
  std::vector<pipeline::UnitCounters> units_;
  std::vector<pipeline::DescribedGroup> groups_;
  std::vector<DescribedUnit> described_units_;
};

/// The policies that a parameter chooses from, each with what it does and what for; none for other
/// parameters.
std::vector<std::pair<std::string_view, std::string_view>> policies_of(const hw::ParamBase& p) {
  std::vector<std::pair<std::string_view, std::string_view>> all;
  for (const std::string_view word : p.words())
    if (const std::string_view reason = p.reason_of(word); !reason.empty()) all.emplace_back(word, reason);
  return all;
}

std::string plain(const Description& d) {
  std::string text;
  for (const auto& [path, params] : d.groups()) {
    text += fmt::format("{}\n", path);
    for (const hw::ParamBase* p : params) {
      const std::string changed =
          p->value_text() == p->default_text() ? "" : fmt::format(" (default {})", p->default_text());
      text += fmt::format("  {:<24} = {}{} {}   [{}; more: {}]  {}\n", p->name(), p->value_text(), changed,
                          p->unit(), p->legal_text(), hw::effect_name(p->effect()), p->reason());
      for (const auto& [word, reason] : policies_of(*p)) text += fmt::format("    {:<24} {}\n", word, reason);
    }
  }
  for (const auto& [kind, counters] : d.units()) {
    text += fmt::format("{} counts\n", kind);
    for (const hw::Statistic* c : counters)
      text += fmt::format("  {:<24} {:<12} {}\n", c->name(), c->unit(), c->definition());
  }
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
  for (const auto& [path, params] : d.groups()) {
    parameters += fmt::format(
        "\n## {}\n\n| parameter | default | unit | legal | more is | what and why "
        "|\n|---|---|---|---|---|---|\n",
        path);
    for (const hw::ParamBase* p : params) {
      std::string policies;
      for (const auto& [word, reason] : policies_of(*p))
        policies += fmt::format("<br>`{}`: {}", word, cell(reason));
      parameters +=
          fmt::format("| `{}` | {} | {} | {} | {} | {}{} |\n", p->name(), p->default_text(), cell(p->unit()),
                      cell(p->legal_text()), hw::effect_name(p->effect()), cell(p->reason()), policies);
    }
  }
  for (const auto& [kind, counted] : d.units()) {
    counters += fmt::format("\n## {}\n\n| counter | unit | definition |\n|---|---|---|\n", kind);
    for (const hw::Statistic* c : counted)
      counters += fmt::format("| `{}` | {} | {} |\n", c->name(), cell(c->unit()), cell(c->definition()));
  }
  std::string text;
  if (!parameters.empty()) {
    text +=
        "# Parameters\n\nEvery parameter of a machine: a TOML file sets `[group]` `parameter = value`, the "
        "command line `--set "
        "group.parameter=value`.\n"
        "A file may begin with `base = \"large\"`, or the path of another file: it then says only what "
        "differs. `quadrille describe "
        "machine NAME "
        "--toml` writes a machine out whole.\n"
        "A tag in brackets is the source of the default ([sources](sources.md)); `[G]` is a guess.\n"
        "What more of a number, or `true`, does to the cycles of a frame stands under \"more is\": faster, "
        "slower, a trade-off, another "
        "picture, or nothing (neutral). `quadrille experiment parameters` holds each to it.\n" +
        parameters;
  }
  if (!counters.empty()) {
    text += std::string(text.empty() ? "" : "\n") +
            "# Counters\n\nWhat every kind of unit counts. In the JSON of `quadrille render --stats` they "
            "are under "
            "`units.<unit>.counters` and, those that are histograms, `units.<unit>.histograms`; a unit of "
            "which the\n"
            "machine has several carries its number (`core_0`).\n" +
            counters;
  }
  return text;
}

std::string json(const Description& d) {
  nlohmann::ordered_json document = {
      {"schema", "quadrille-description-1"}, {"machine", d.machine().name}, {"base", d.machine().base()}};
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object(),
                         counters = nlohmann::ordered_json::object();
  for (const auto& [path, params] : d.groups()) {
    for (const hw::ParamBase* p : params) {
      parameters[path + "." + std::string(p->name())] = {
          {"value", nlohmann::ordered_json::parse(p->literal())},
          {"default", nlohmann::ordered_json::parse(p->default_literal())},
          {"unit", p->unit()},
          {"legal", p->legal_text()},
          {"more", hw::effect_name(p->effect())},
          {"reason", p->reason()}};
      for (const auto& [word, reason] : policies_of(*p))
        parameters[path + "." + std::string(p->name())]["policies"][std::string(word)] = reason;
    }
  }
  for (const auto& [kind, counted] : d.units()) {
    nlohmann::ordered_json& unit = counters[kind] = nlohmann::ordered_json::object();
    for (const hw::Statistic* c : counted)
      unit[std::string(c->name())] = {{"unit", c->unit()}, {"definition", c->definition()}};
  }
  document["parameters"] = std::move(parameters);
  document["counters"] = std::move(counters);
  return document.dump(2) + "\n";
}

/// A machine file that stands by itself: it names no base.
std::string toml(const Description& d) {
  return fmt::format("# {}\n\n", one_line(d.machine().title())) + pipeline::machine_toml(d.groups());
}

int run_describe(const DescribeArguments& arguments) {
  if (arguments.as) {
    if (arguments.what != kCounters)
      throw user_error("describe: --as names counters: 'describe counters --as {}'", *arguments.as);
    fmt::print("{}", vendor_table(*arguments.as, arguments.markdown));
    return kDone;
  }
  const Description description(arguments);
  if (arguments.diagram) {
    fmt::print("{}", machine_diagram(description.machine()));
    return kDone;
  }
  const auto format = arguments.markdown ? markdown : arguments.json ? json : arguments.toml ? toml : plain;
  fmt::print("{}", format(description));
  return kDone;
}

}  // namespace

void add_describe(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "describe",
      "Lists parameters (value, default, unit, legal values, reason) and counters (unit, definition).");
  const auto arguments = std::make_shared<DescribeArguments>();
  command->add_option("WHAT", arguments->what,
                      "a unit, gpu, link or one link such as link.core_to_texture; one parameter or counter, "
                      "with its group or without; "
                      "machine: all parameters of the machine NAME; counters: all counters (default: all)");
  command->add_option("NAME", arguments->name, "with machine: which one, as --machine takes it");
  command->add_option("--only", arguments->only, "one half of it")
      ->check(CLI::IsMember({"all", "parameters", "counters"}))
      ->capture_default_str();
  CLI::Option* markdown_flag =
      command->add_flag("--markdown", arguments->markdown, "as a page of documentation");
  CLI::Option* json_flag = command->add_flag("--json", arguments->json, "as JSON")->excludes(markdown_flag);
  CLI::Option* toml_flag =
      command->add_flag("--toml", arguments->toml, "the parameters as a machine file that --machine reads")
          ->excludes(markdown_flag)
          ->excludes(json_flag);
  command
      ->add_flag("--diagram", arguments->diagram,
                 "with machine: its block diagram, as a page of documentation")
      ->excludes(markdown_flag)
      ->excludes(json_flag)
      ->excludes(toml_flag);
  command
      ->add_option(
          "--as", arguments->as,
          "with counters: those that a profiler of real GPUs has too, under its names, and what differs")
      ->check(CLI::IsMember(profiler_words()))
      ->excludes(json_flag)
      ->excludes(toml_flag);
  arguments->machine.add_to(*command);
  command->footer(R"(Examples:
  quadrille describe texture
  quadrille describe texture.cache_lines
  quadrille describe link.core           the links whose names begin so
  quadrille describe machine large --set gpu.cores=8 --toml
      a whole machine, to write into a file of your own
  quadrille describe machine small --diagram
  quadrille describe gpu --machine large
  quadrille describe counters --as nsight
  quadrille describe --only parameters --markdown)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return run_describe(*arguments); }; });
}

}  // namespace quadrille::cli
