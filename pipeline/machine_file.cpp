/// Machine files: TOML tables that mirror the parameter paths.
#include "pipeline/machine_config.h"

#include <toml++/toml.h>

#include <filesystem>

#include "traces/whole_file.h"

namespace quadrille::pipeline {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 20;
constexpr std::size_t kMaxLineBytes = 1000;  // bounds how deep a dotted key can nest tables, which are walked and freed by recursion

/// Folders that may hold the machines that come with the program, the likeliest first.
std::vector<fs::path> config_folders() {
  std::vector<fs::path> folders;
  std::error_code error;
  const fs::path exe = fs::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(exe.parent_path().parent_path() / "share" / "quadrille" / "configs");
  folders.emplace_back(QUADRILLE_CONFIG_DIR);
  return folders;
}

void check_lines(std::string_view text, const std::string& file) {
  std::size_t line = 1, begin = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size() && text[i] != '\n') continue;
    if (i - begin > kMaxLineBytes)
      throw user_error("{}:{}: the line has {} bytes; at most {} are read", file, line, i - begin, kMaxLineBytes);
    begin = i + 1;
    ++line;
  }
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

void apply_machine_text(MachineConfig& config, std::string_view text, const std::string& file) {
  check_lines(text, file);
  try {
    apply(config, toml::parse(text, file), "", file);
  } catch (const toml::parse_error& e) { throw user_error("{}:{}: {}", file, e.source().begin.line, e.description()); }
  try {
    config.check();
  } catch (const UserError& e) { throw user_error("{}: {}", file, e.what()); }
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
  const std::vector<std::byte> bytes = traces::read_whole_file(path.string(), kMaxFileBytes);
  apply_machine_text(config, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.string());
}

}  // namespace quadrille::pipeline
