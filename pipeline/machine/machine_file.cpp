/// Machine files: TOML tables that mirror the parameter paths.
#include "pipeline/machine/machine_config.h"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>

#include "models/base/near_name.h"
#include "pipeline/machine/config_files.h"
#include "traces/whole_file.h"

namespace quadrille::pipeline {

namespace {

namespace fs = std::filesystem;

/// The value as `set` reads it. A word is in quotes, and nothing else is.
std::string value_text(const toml::node& node, bool word, const std::string& where, const std::string& key) {
  if (word) {
    if (const auto* v = node.as_string()) return v->get();
    throw user_error("{}: {}: a word in quotes is expected", where, key);
  }
  if (const auto* v = node.as_integer()) return fmt::format("{}", v->get());
  if (const auto* v = node.as_floating_point()) return fmt::format("{}", v->get());
  if (const auto* v = node.as_boolean()) return v->get() ? "true" : "false";
  throw user_error("{}: {}: a number or true/false is expected", where, key);
}

/// Files and names that are being applied, the outermost first: a machine among its own bases would never
/// end.
struct Layers {
  std::vector<std::string> places;  ///< canonical paths
  std::vector<std::string> names;   ///< as they were given
};

void load_layer(MachineConfig& config, const std::string& name_or_path, const Layers& above);

/// Applies the machine that a file names as its base; a path is seen from the file.
void apply_base(MachineConfig& config, const toml::node& node, const std::string& file,
                const Layers& layers) {
  const std::string where = fmt::format("{}:{}: base", file, node.source().begin.line);
  const auto base = node.value<std::string>();
  if (!base)
    throw user_error(
        "{}: the name of a machine or the path of a .toml file is expected, as in base = \"large\"", where);
  const bool is_path = fs::path(*base).extension() == ".toml";
  try {
    load_layer(config, is_path ? (fs::path(file).parent_path() / *base).string() : *base, layers);
  } catch (const UserError& e) { throw user_error("{}: {}", where, e.what()); }
}

void apply(MachineConfig& config, const toml::table& table, const std::string& prefix,
           const std::string& file) {
  for (const auto& [name, node] : table) {
    const std::string key = prefix.empty() ? std::string(name.str()) : prefix + "." + std::string(name.str());
    const std::string where = fmt::format("{}:{}", file, node.source().begin.line);
    if (const toml::table* inner = node.as_table()) {
      const auto is_group = [&](const auto& group) {
        return group.first == key || group.first.starts_with(key + ".");
      };
      if (std::ranges::none_of(config.groups(), is_group)) {
        std::vector<std::string> names;
        for (const auto& [path, group] : config.groups()) names.push_back(path);
        throw user_error("{}: unknown group '{}'; `quadrille describe` lists them{}", where, key,
                         did_you_mean(key, names));
      }
      apply(config, *inner, key, file);
    } else if (key == "name") {
      const auto text = node.value<std::string>();
      if (!text) throw user_error("{}: name: a string is expected", where);
      config.name = *text;
    } else if (key == "base") {
      continue;  // applied before
    } else if (prefix.empty()) {
      std::vector<std::string> names = config.paths();
      names.insert(names.end(), {"name", "base"});
      throw user_error("{}: unknown key '{}'; outside of groups there are name and base{}", where, key,
                       did_you_mean(key, names));
    } else {
      const hw::ParamBase* const param = config.find(key);
      config.set(key, value_text(node, param != nullptr && param->is_word(), where, key), where);
    }
  }
}

/// Applies a file and what it is based on. What must hold between parameters is checked later: a layer above
/// may mend it.
void apply_layers(MachineConfig& config, std::string_view text, const std::string& file,
                  const Layers& layers) {
  check_config_lines(text, file);
  try {
    const toml::table table = toml::parse(text, file);
    if (const toml::node* base = table.get("base")) apply_base(config, *base, file, layers);
    config.name = fs::path(file).filename().string();  // unless it says another
    config.begin_layer();
    apply(config, table, "", file);
  } catch (const toml::parse_error& e) {
    throw user_error("{}:{}: {}", file, e.source().begin.line, e.description());
  }
}

/// The file of a machine that comes with the program. Throws `UserError` when there is none of that name.
fs::path file_of_machine(const std::string& name) {
  for (const fs::path& folder : config_folders()) {
    fs::path file = folder / (name + ".toml");
    if (name.find('/') == std::string::npos && fs::exists(file)) return file;
  }
  const std::vector<std::string> names = machine_names();
  throw user_error("machine '{}' is unknown; machines: {}; or give a path that ends in .toml{}", name,
                   fmt::join(names, ", "), did_you_mean(name, names));
}

/// The data file of a kind of memory.
fs::path file_of_memory(const std::string& kind) {
  for (const fs::path& folder : config_folders()) {
    fs::path file = folder / "memory" / (kind + ".toml");
    if (fs::exists(file)) return file;
  }
  throw user_error("memory '{}': no file memory/{}.toml beside the machines that come with the program", kind,
                   kind);
}

void load_layer(MachineConfig& config, const std::string& name_or_path, const Layers& above) {
  constexpr std::size_t kMaxLayers = 32;
  const bool by_name = fs::path(name_or_path).extension() != ".toml";
  const std::string path = by_name ? file_of_machine(name_or_path).string() : name_or_path;
  std::error_code ignored;
  Layers layers = above;
  layers.places.push_back(fs::weakly_canonical(path, ignored).string());
  layers.names.push_back(name_or_path);
  if (std::ranges::find(above.places, layers.places.back()) != above.places.end())
    throw user_error("the bases of machines go in a circle: {}", fmt::join(layers.names, " -> "));
  if (layers.names.size() > kMaxLayers)
    throw user_error("{} machines, each the base of another; at most {} are read", layers.names.size(),
                     kMaxLayers);
  const std::vector<std::byte> bytes = traces::read_whole_file(path, kMaxConfigBytes);
  apply_layers(config, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, layers);
  if (by_name) config.become_base(name_or_path);
}

void check(const MachineConfig& config, const std::string& file) {
  try {
    config.check();
  } catch (const UserError& e) { throw user_error("{}: {}", file, e.what()); }
}

}  // namespace

std::vector<std::string> machine_names() {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::path& folder : config_folders()) {
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    }
    if (!names.empty()) break;
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::pair<std::string, std::string>> memory_kind_values(const std::string& kind) {
  const std::string file = file_of_memory(kind).string();
  const std::vector<std::byte> bytes = traces::read_whole_file(file, kMaxConfigBytes);
  std::vector<std::pair<std::string, std::string>> values;
  try {
    const toml::table table =
        toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), file);
    const toml::table* memory = table["memory"].as_table();
    if (memory == nullptr) throw user_error("{}: has no table [memory]", file);
    for (const auto& [name, node] : *memory) {
      const std::string key =
          name.str() == "clock_mhz" ? "gpu.memory_mhz" : fmt::format("memory.{}", name.str());
      values.emplace_back(
          key, value_text(node, node.is_string(), fmt::format("{}:{}", file, node.source().begin.line), key));
    }
  } catch (const toml::parse_error& e) {
    throw user_error("{}:{}: {}", file, e.source().begin.line, e.description());
  }
  return values;
}

void apply_machine_text(MachineConfig& config, std::string_view text, const std::string& file) {
  apply_layers(config, text, file, {});
  check(config, file);
}

void load_machine(MachineConfig& config, const std::string& name_or_path) {
  load_layer(config, name_or_path, {});
  check(config, name_or_path);
}

std::string machine_toml(const std::vector<DescribedGroup>& groups) {
  std::string text;
  for (const auto& [path, params] : groups) {
    text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", path);
    for (const hw::ParamBase* p : params) {
      const std::string unit = p->unit().empty() ? "" : fmt::format("{}, ", p->unit());
      text +=
          fmt::format("{} = {}  # {}{}: {}\n", p->name(), p->literal(), unit, p->legal_text(), p->reason());
    }
  }
  return text;
}

}  // namespace quadrille::pipeline
