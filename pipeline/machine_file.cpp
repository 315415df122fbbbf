/// Machine files: TOML tables that mirror the parameter paths.
#include "pipeline/machine_config.h"

#include <toml++/toml.h>

#include <filesystem>

namespace quadrille::pipeline {

namespace {

namespace fs = std::filesystem;

/// Folders that may hold the machines that come with the program, the likeliest first.
std::vector<fs::path> config_folders() {
  std::vector<fs::path> folders;
  std::error_code error;
  const fs::path exe = fs::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(exe.parent_path().parent_path() / "share" / "quadrille" / "configs");
  folders.emplace_back(QUADRILLE_CONFIG_DIR);
  return folders;
}

std::string value_text(const toml::node& node, const std::string& where, const std::string& key) {
  if (const auto* v = node.as_integer()) return fmt::format("{}", v->get());
  if (const auto* v = node.as_floating_point()) return fmt::format("{}", v->get());
  if (const auto* v = node.as_boolean()) return v->get() ? "true" : "false";
  throw user_error("{}: {}: a number or true/false is expected", where, key);
}

void apply(MachineConfig& config, const toml::table& table, const std::string& prefix, const std::string& file) {
  for (const auto& [name, node] : table) {
    const std::string key = prefix.empty() ? std::string(name.str()) : prefix + "." + std::string(name.str());
    const std::string where = fmt::format("{}:{}", file, node.source().begin.line);
    if (const toml::table* inner = node.as_table()) {
      apply(config, *inner, key, file);
    } else if (key == "name") {
      const auto text = node.value<std::string>();
      if (!text) throw user_error("{}: name: a string is expected", where);
      config.name = *text;
    } else {
      config.set(key, value_text(node, where, key), where);
    }
  }
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

void load_machine(MachineConfig& config, const std::string& name_or_path) {
  fs::path path = name_or_path;
  if (path.extension() != ".toml") {
    for (const fs::path& folder : config_folders()) {
      path = folder / (name_or_path + ".toml");
      if (fs::exists(path)) break;
    }
    if (!fs::exists(path)) {
      throw user_error("machine '{}' is unknown; machines: {}; or give a path that ends in .toml", name_or_path,
                       fmt::join(machine_names(), ", "));
    }
    config.name = name_or_path;
  }
  if (!fs::is_regular_file(path)) throw user_error("{}: no such machine file", path.string());
  try {
    apply(config, toml::parse_file(path.string()), "", path.string());
  } catch (const toml::parse_error& e) { throw user_error("{}:{}: {}", path.string(), e.source().begin.line, e.description()); }
  config.check();
}

}  // namespace quadrille::pipeline
