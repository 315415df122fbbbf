/// The hostile files of others: malformed, out of range, recursive, infinite, truncated. A list beside them
/// says which a validator finds without errors.
#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/hostile/hostile_case.h"
#include "tests/scenes/scene_folder.h"

namespace quadrille::hostile {
namespace {

/// Valid by the list and yet not drawable as their authors meant; each is refused for what it says.
constexpr std::array<std::string_view, 2> kRefusedThoughValid{
    "camera/perspective_yfov.gltf",  // a field of view of 4 radians
    "root/unused_objects.gltf",      // draws from a buffer without bytes
};

/// Files without errors in EXPECTED.tsv: file, errors, warnings, ...
std::map<std::string, bool> validity(const fs::path& folder) {
  std::map<std::string, bool> valid;
  std::ifstream list(folder / "EXPECTED.tsv");
  for (std::string line; std::getline(list, line);) {
    std::istringstream fields(line);
    std::string file, errors;
    std::getline(fields, file, '\t');
    std::getline(fields, errors, '\t');
    valid[file] = errors == "0";
  }
  return valid;
}

}  // namespace

Group outside_cases() {
  Group group{"files of others", "the hostile files of other projects, exact and functional", {}};
  const auto scenes = scenes::scene_folder();
  if (!scenes || !fs::is_directory(*scenes / "Hostile")) return group;
  const fs::path folder = fs::canonical(*scenes / "Hostile");
  const std::map<std::string, bool> valid = validity(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string path = entry.path().string(), name = fs::relative(entry.path(), folder).string(),
                      end = entry.path().extension().string();
    if (end == ".png" || end == ".jpg")
      group.cases.push_back({name, {"diff", path, path}, path, {}, Expect::kEither});
    if (end != ".gltf" && end != ".glb") continue;
    const auto found = valid.find(name);
    const bool excepted =
        std::ranges::any_of(kRefusedThoughValid, [&](std::string_view s) { return name.ends_with(s); });
    const Expect expect =
        found != valid.end() && found->second && !excepted ? Expect::kRendered : Expect::kEither;
    for (const std::string fidelity : {"functional", "exact"})
      group.cases.push_back({name + ", " + fidelity, render_arguments(path, fidelity), path, {}, expect});
  }
  std::ranges::sort(group.cases, {}, &Case::name);
  return group;
}

}  // namespace quadrille::hostile
