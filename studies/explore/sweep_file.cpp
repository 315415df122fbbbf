/// Reading a sweep from its file: TOML tables become the parts of a `Sweep`.
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include <fmt/ranges.h>

#include "models/base/error.h"
#include "models/base/near_name.h"
#include "pipeline/machine/machine_config.h"
#include "studies/explore/dimension.h"
#include "studies/explore/sweep.h"
#include "traces/whole_file.h"

namespace quadrille::studies::explore {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 20;
constexpr std::uint32_t kMostPoints = 1'000'000;
constexpr std::int64_t kLongestWindow = 1'000'000;
constexpr std::uint32_t kMostSearched = 2000;  // the time of a guess grows with what it is made from

/// A name that formulas can use and that is no path of a parameter.
bool is_plain_name(std::string_view name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !name.empty() && letter(name.front()) &&
         std::ranges::all_of(name, [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

/// A key with its value.
using KeyedNode = std::pair<std::string, const toml::node*>;

/// What a table holds, in the order of the file; the library has it in that of the alphabet.
std::vector<KeyedNode> in_order(const toml::table& table) {
  std::vector<KeyedNode> all;
  for (const auto& [key, node] : table) all.emplace_back(std::string(key.str()), &node);
  const auto place = [](const KeyedNode& entry) {
    const toml::source_position at = entry.second->source().begin;
    return std::pair(at.line, at.column);
  };
  std::sort(all.begin(), all.end(),
            [&](const KeyedNode& a, const KeyedNode& b) { return place(a) < place(b); });
  return all;
}

class Reader {
 public:
  explicit Reader(const std::string& file) : folder_(fs::path(file).parent_path()) {
    sweep_.file = file;
    const std::vector<std::byte> bytes = traces::read_whole_file(file, kMaxFileBytes);
    sweep_.text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  Sweep read() {
    try {
      table_ = toml::parse(sweep_.text, sweep_.file);
    } catch (const toml::parse_error& e) {
      throw user_error("{}:{}: {}", sweep_.file, e.source().begin.line, e.description());
    }
    check_keys(table_, "",
               {"design", "points", "seed", "seconds", "memory_mib", "window", "screen", "machines", "scene",
                "set", "vary", "derive", "constraints", "objective"});
    read_design();
    read_limits();
    read_scenes();
    read_machines();
    if (const toml::table* table = group("screen")) read_screen(*table);
    if (const toml::table* set = group("set")) read_settings(*set, "");
    if (const toml::table* vary = group("vary")) read_dimensions(*vary, "");
    if (const toml::table* derive = group("derive")) read_derived(*derive, "");
    read_constraints();
    read_objectives();
    check_design();
    return std::move(sweep_);
  }

 private:
  [[nodiscard]] std::string at(const toml::node& node) const {
    return fmt::format("{}:{}", sweep_.file, node.source().begin.line);
  }
  void check_keys(const toml::table& table, const std::string& about,
                  const std::vector<std::string>& legal) const {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::ranges::find(legal, name) == legal.end())
        throw user_error("{}: unknown key '{}'; {}there are {}{}", at(node), name, about,
                         fmt::join(legal, ", "), did_you_mean(name, legal));
    }
  }
  template <class T>
  [[nodiscard]] T whole(const toml::table& table, const char* key, T otherwise, std::int64_t least,
                        std::int64_t most) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return otherwise;
    const toml::value<std::int64_t>* value = node->as_integer();
    if (value == nullptr || value->get() < least || value->get() > most)
      throw user_error("{}: {}: a whole number within {}..{} is expected", at(*node), key, least, most);
    return static_cast<T>(value->get());
  }
  [[nodiscard]] std::optional<double> number(const toml::table& table, const char* key) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return std::nullopt;
    const auto value = node->is_number() ? node->value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) throw user_error("{}: {}: a number is expected", at(*node), key);
    return value;
  }
  [[nodiscard]] std::string text(const toml::table& table, const char* key,
                                 const std::string& otherwise) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return otherwise;
    if (!node->is_string() || node->as_string()->get().empty())
      throw user_error("{}: {}: a text in quotes is expected", at(*node), key);
    return node->as_string()->get();
  }
  /// The number of a word in a list.
  template <class Words>
  [[nodiscard]] std::size_t word(const toml::table& table, const char* key, const Words& words) const {
    const std::string given = text(table, key, std::string(*std::begin(words)));
    const auto found = std::ranges::find(words, given);
    if (found == std::end(words))
      throw user_error("{}: {}: '{}' is none of {}", at(*table.get(key)), key, given, fmt::join(words, ", "));
    return static_cast<std::size_t>(found - std::begin(words));
  }
  [[nodiscard]] const toml::table* group(const char* key) const {
    const toml::node* node = table_.get(key);
    if (node != nullptr && !node->is_table())
      throw user_error("{}: {}: a table is expected, as in [{}]", at(*node), key, key);
    return node == nullptr ? nullptr : node->as_table();
  }
  /// Calls `read` with each table of a list: [[scene]].
  void each(const char* key, const std::function<void(const toml::table&)>& read) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr || !list->is_array_of_tables())
      throw user_error("{}: {}: tables are expected, as in [[{}]]", at(*node), key, key);
    for (const toml::node& entry : *list) read(*entry.as_table());
  }
  /// A path of the file, seen from where the program runs.
  [[nodiscard]] std::string seen_from_here(const std::string& path) const {
    return path.starts_with("builtin:") ? path : (folder_ / path).string();
  }

  void read_design() {
    sweep_.design = static_cast<DesignKind>(word(table_, "design", kDesignNames));
    sweep_.points = whole<std::uint32_t>(table_, "points", 0, 1, kMostPoints);
    sweep_.seed = whole<std::uint64_t>(table_, "seed", 1, 0, std::int64_t{1} << 31);
  }
  void check_design() const {
    const std::string name(kDesignNames[static_cast<std::size_t>(sweep_.design)]);
    if (sweep_.design == DesignKind::kGrid) {
      if (table_.contains("points"))
        throw user_error("{}: points: a grid has all of its points; leave it out, or choose another design",
                         at(*table_.get("points")));
      for (const Dimension& d : sweep_.dimensions)
        if (d.continuous())
          throw user_error("{}: {}: a grid needs single values: give the range a step, a factor or a count",
                           d.where, d.name);
    } else {
      if (sweep_.points == 0)
        throw user_error("{}: points is missing: how many machines the design {} draws", sweep_.file, name);
      if (sweep_.dimensions.empty())
        throw user_error("{}: nothing differs from machine to machine; [vary] says what does", sweep_.file);
    }
    if (sweep_.design == DesignKind::kSearch) check_search();
  }
  void check_search() const {
    if (sweep_.points > kMostSearched)
      throw user_error("{}: points: a search draws at most {} machines", at(*table_.get("points")),
                       kMostSearched);
    if (sweep_.objectives.size() < 2)
      throw user_error("{}: design: a search needs two [[objective]] or more, such as cycles and a cost",
                       at(*table_.get("design")));
  }
  void read_limits() {
    if (const auto seconds = number(table_, "seconds")) {
      if (!(*seconds > 0))
        throw user_error("{}: seconds: more than 0 is expected", at(*table_.get("seconds")));
      sweep_.seconds = *seconds;
    }
    sweep_.memory_mib = whole<std::uint64_t>(table_, "memory_mib", 0, 1, std::int64_t{1} << 24);
    sweep_.window = whole<std::int64_t>(table_, "window", 0, 0, kLongestWindow);
  }
  void read_screen(const toml::table& table) {
    check_keys(table, "in [screen] ", {"window", "machines"});
    for (const char* key : {"window", "machines"})
      if (!table.contains(key)) throw user_error("{}: {} is missing", at(table), key);
    sweep_.screen = {whole<std::int64_t>(table, "window", 0, 1, kLongestWindow),
                     whole<std::uint32_t>(table, "machines", 0, 1, kMostPoints)};
    if (sweep_.window > 0)
      throw user_error("{}: screen: the window above is of all points; leave it out", at(table));
    if (sweep_.design == DesignKind::kSearch)
      throw user_error("{}: screen: a search chooses by exact frames; choose another design", at(table));
  }
  void read_scenes() {
    std::set<std::string> names;
    each("scene", [&](const toml::table& table) {
      SceneEntry entry;
      entry.where = at(table);
      if (!table.contains("file"))
        throw user_error("{}: file is missing: a path, or builtin:NAME", entry.where);
      const std::string file = text(table, "file", "");
      entry.scene = seen_from_here(file);
      entry.name = text(table, "name", fs::path(file.substr(file.find(':') + 1)).stem().string());
      if (!names.insert(entry.name).second)
        throw user_error("{}: two scenes are called '{}'; give one a name", entry.where, entry.name);
      for (const auto& [key, node] : table) {
        const std::string option(key.str());
        if (option == "file" || option == "name") continue;
        std::string value = value_text(node, fmt::format("{}: {}", at(node), option));
        if (option == "vert" || option == "frag") value = seen_from_here(value);
        entry.options.push_back({option, value, at(node)});
      }
      sweep_.scenes.push_back(std::move(entry));
    });
    if (sweep_.scenes.empty())
      throw user_error("{}: no scene; [[scene]] with file = \"...\" names one", sweep_.file);
  }
  void read_machines() {
    const toml::node* node = table_.get("machines");
    if (node == nullptr) sweep_.machines = {"default"};
    else {
      const Dimension list = read_dimension("machine", *node, false, at(*node) + ": machines");
      for (const std::string& name : list.levels)
        sweep_.machines.push_back(name.ends_with(".toml") ? seen_from_here(name) : name);
    }
    const std::string where = node == nullptr ? sweep_.file : at(*node) + ": machines";
    for (const std::string& name : sweep_.machines) {
      pipeline::MachineConfig machine;
      try {
        pipeline::load_machine(machine, name);
      } catch (const UserError& e) { throw user_error("{}: {}", where, e.what()); }
    }
    if (sweep_.machines.size() > 1) {
      Dimension machines;
      machines.name = "machine";
      machines.where = where;
      machines.levels = sweep_.machines;
      sweep_.dimensions.push_back(std::move(machines));
    }
  }
  /// Claims a name for one of [set], [vary] and [derive].
  void claim(const std::string& name, const std::string& where) {
    const auto [entry, fresh] = taken_.emplace(name, where);
    if (!fresh) throw user_error("{}: {} stands at {} too", where, name, entry->second);
    if (name.find('.') == std::string::npos) {
      if (!is_plain_name(name) || name == "machine")
        throw user_error("{}: '{}' is no name that a formula could use", where, name);
      return;
    }
    if (scratch_.find(name) == nullptr) {
      const std::vector<std::string> paths = scratch_.paths();
      throw user_error("{}: no parameter is called '{}'; `quadrille describe` lists them{}", where, name,
                       did_you_mean(name, paths));
    }
  }
  /// A value of a parameter, tried on a machine that nobody draws with.
  void check_value(const std::string& name, const std::string& value, const std::string& where) {
    if (name.find('.') != std::string::npos) scratch_.set(name, value, where);
  }
  void read_settings(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, value] : in_order(table)) {
      const toml::node& node = *value;
      const std::string name = prefix + key;
      if (const toml::table* inner = node.as_table()) {
        read_settings(*inner, name + ".");
        continue;
      }
      claim(name, at(node));
      sweep_.settings.push_back({name, value_text(node, fmt::format("{}: {}", at(node), name)), at(node)});
      check_value(name, sweep_.settings.back().value, at(node));
    }
  }
  void read_dimensions(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, value] : in_order(table)) {
      const toml::node& node = *value;
      const std::string name = prefix + key;
      if (const toml::table* inner = node.as_table(); inner != nullptr && !inner->contains("from")) {
        read_dimensions(*inner, name + ".");
        continue;
      }
      claim(name, at(node));
      const hw::ParamBase* parameter = scratch_.find(name);
      const bool whole = parameter == nullptr || dynamic_cast<const hw::Param<double>*>(parameter) == nullptr;
      const bool free = name.find('.') == std::string::npos;
      Dimension dimension = read_dimension(name, node, whole && !free, fmt::format("{}: {}", at(node), name));
      dimension.where = at(node);
      for (const std::string& level : dimension.levels) check_value(name, level, at(node));
      if (dimension.continuous())
        for (const double end : {0.0, 1.0}) check_value(name, dimension.at(end), at(node));
      if (free)
        for (const std::string& level : dimension.levels)
          if (level.find_first_not_of("0123456789+-.e") != std::string::npos)
            throw user_error("{}: {}: '{}' is no number; a name that is no parameter is one of a formula",
                             at(node), name, level);
      sweep_.dimensions.push_back(std::move(dimension));
    }
  }
  void read_derived(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, value] : in_order(table)) {
      const toml::node& node = *value;
      const std::string name = prefix + key;
      if (const toml::table* inner = node.as_table()) {
        read_derived(*inner, name + ".");
        continue;
      }
      claim(name, at(node));
      if (!node.is_string()) throw user_error("{}: {}: a formula in quotes is expected", at(node), name);
      sweep_.derived.push_back({name, formula(*node.as_string(), name)});
    }
  }
  [[nodiscard]] Expression formula(const toml::value<std::string>& node, const std::string& about) const {
    return {node.get(), fmt::format("{}: {}", at(node), about)};
  }
  void read_constraints() {
    const toml::node* node = table_.get("constraints");
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr) throw user_error("{}: constraints: a list of formulas is expected", at(*node));
    for (const toml::node& entry : *list) {
      if (!entry.is_string()) throw user_error("{}: constraints: a formula in quotes is expected", at(entry));
      sweep_.constraints.push_back(formula(*entry.as_string(), "constraints"));
    }
  }
  void read_objectives() {
    constexpr std::string_view kGoals[] = {"least", "most"}, kOver[] = {"worst", "mean", "sum"};
    each("objective", [&](const toml::table& table) {
      check_keys(table, "an objective: ",
                 {"name", "formula", "unit", "goal", "over", "at_most", "at_least", "noise"});
      const std::string name = text(table, "name", ""), where = at(table);
      if (!is_plain_name(name))
        throw user_error("{}: name: letters, digits and underscores are expected", where);
      claim(name, where);
      const toml::node* text_node = table.get("formula");
      if (text_node == nullptr || !text_node->is_string())
        throw user_error("{}: formula: a formula in quotes is expected, as in \"frame.cycles\"", where);
      Objective objective{name, text(table, "unit", ""), formula(*text_node->as_string(), name)};
      objective.most = word(table, "goal", kGoals) == 1;
      objective.over = static_cast<Objective::Over>(word(table, "over", kOver));
      objective.at_most = number(table, "at_most");
      objective.at_least = number(table, "at_least");
      objective.noise = number(table, "noise").value_or(0);
      if (!(objective.noise >= 0 && objective.noise < 1))
        throw user_error("{}: noise: a part of the value within 0..1 is expected", where);
      sweep_.objectives.push_back(std::move(objective));
    });
    if (sweep_.objectives.empty())
      sweep_.objectives.push_back({"cycles", "cycle", {"frame.cycles", sweep_.file + ": cycles"}});
  }

  fs::path folder_;
  Sweep sweep_;
  toml::table table_;
  pipeline::MachineConfig scratch_;
  std::map<std::string, std::string> taken_;
};

}  // namespace

Sweep read_sweep(const std::string& file) { return Reader(file).read(); }

}  // namespace quadrille::studies::explore
