#include "pipeline/machine/config_files.h"

#include "models/base/error.h"

namespace quadrille::pipeline {

namespace {

constexpr std::size_t kMaxLineBytes = 1000;

}  // namespace

std::vector<std::filesystem::path> config_folders() {
  std::vector<std::filesystem::path> folders;
  std::error_code error;
  const std::filesystem::path exe = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(exe.parent_path().parent_path() / "share" / "quadrille" / "configs");
  folders.emplace_back(QUADRILLE_CONFIG_DIR);
  return folders;
}

void check_config_lines(std::string_view text, const std::string& file) {
  std::size_t line = 1, begin = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size() && text[i] != '\n') continue;
    if (i - begin > kMaxLineBytes)
      throw user_error("{}:{}: the line has {} bytes; at most {} are read", file, line, i - begin,
                       kMaxLineBytes);
    begin = i + 1;
    ++line;
  }
}

}  // namespace quadrille::pipeline
