#include "scenes/material/spirv_entry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>
#include <span>

#include "models/base/error.h"

namespace quadrille::scenes {
namespace {

// [SPV #instructions, #Execution_Model]
constexpr std::uint32_t kEntryPoint = 15;
constexpr std::size_t kHeaderWords = 5;
/// of the instruction: after its first word, the stage and the function
constexpr std::size_t kNameWord = 3;

struct Entry {
  std::size_t at = 0;
  std::uint32_t model = 0;
  std::string name;
  std::size_t name_words = 0;
};

std::vector<Entry> entry_points(std::span<const std::uint32_t> spirv) {
  std::vector<Entry> entries;
  for (std::size_t at = kHeaderWords; at < spirv.size();) {
    const std::size_t words = spirv[at] >> 16;
    if (words == 0 || words > spirv.size() - at) break;
    if ((spirv[at] & 0xffff) == kEntryPoint && words > kNameWord) {
      const auto* const text = reinterpret_cast<const char*>(spirv.data() + at + kNameWord);
      const std::size_t length = strnlen(text, (words - kNameWord) * 4);
      if (length == (words - kNameWord) * 4) break;  // its name does not end
      entries.push_back({at, spirv[at + 1], std::string(text, length), length / 4 + 1});
    }
    at += words;
  }
  return entries;
}

std::string_view stage_name(std::uint32_t model) {
  constexpr std::string_view kNames[] = {
      "vertex", "tessellation control", "tessellation evaluation", "geometry", "fragment", "compute"};
  return model < std::size(kNames) ? kNames[model] : "other";
}

std::string list(const std::vector<Entry>& entries) {
  std::vector<std::string> names;
  names.reserve(entries.size());
  for (const Entry& entry : entries)
    names.push_back(fmt::format("'{}' ({})", entry.name, stage_name(entry.model)));
  return fmt::format("{}", fmt::join(names, ", "));
}

void rename_to_main(std::vector<std::uint32_t>& spirv, const Entry& entry) {
  const auto name = spirv.begin() + static_cast<std::ptrdiff_t>(entry.at + kNameWord);
  spirv.erase(name + 1, name + static_cast<std::ptrdiff_t>(entry.name_words));
  spirv[entry.at + kNameWord] = 0x6e69616d;  // "main"
  spirv.insert(spirv.begin() + static_cast<std::ptrdiff_t>(entry.at + kNameWord) + 1, 0u);
  const std::size_t words = (spirv[entry.at] >> 16) - entry.name_words + 2;
  spirv[entry.at] = static_cast<std::uint32_t>(words) << 16 | kEntryPoint;
}

}  // namespace

void call_entry_point_main(std::vector<std::uint32_t>& spirv, traces::ShaderStage stage,
                           const std::string& path, std::string& note) {
  const std::uint32_t wanted = stage == traces::ShaderStage::kVertex ? 0 : 4;
  const std::vector<Entry> all = entry_points(spirv);
  std::vector<Entry> of_stage;
  for (const Entry& entry : all) {
    if (entry.model != wanted) continue;
    if (entry.name == "main") return;
    of_stage.push_back(entry);
  }
  if (of_stage.empty() && !all.empty())
    throw user_error("{}: no entry point of the {} stage; the module has {}", path, stage_name(wanted),
                     list(all));
  if (of_stage.size() > 1)
    throw user_error("{}: several entry points of the {} stage and none is called main: {}", path,
                     stage_name(wanted), list(of_stage));
  if (of_stage.empty()) return;
  note =
      one_line(fmt::format("{}: no entry point is called main; '{}', the only one of the {} stage, is used",
                           path, of_stage[0].name, stage_name(wanted)));
  rename_to_main(spirv, of_stage[0]);
}

}  // namespace quadrille::scenes
