/// The files of data that come with the program (configs/), and what holds for every one of them, ours or a
/// user's.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::pipeline {

inline constexpr std::uint64_t kMaxConfigBytes = std::uint64_t{1} << 20;

/// Folders that may hold the files that come with the program, the likeliest first.
[[nodiscard]] std::vector<std::filesystem::path> config_folders();
/// Throws `UserError` with file and line for a line too long to be read: it bounds how deep a dotted key can
/// nest tables, which are walked and freed by recursion.
void check_config_lines(std::string_view text, const std::string& file);

}  // namespace quadrille::pipeline
