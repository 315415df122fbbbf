/// Malformed files: each loads or is refused by a UserError, in bounded time and memory.
#include <fmt/format.h>
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <random>

#include "models/base/error.h"
#include "scenes/scene.h"
#include "tests/scenes/gltf_text.h"
#include "tests/scenes/scene_folder.h"
#include "traces/whole_file.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

void load_or_refuse(const std::string& path) {
  try {
    SceneOptions options;
    options.width = options.height = 64;
    (void)load_scene(path, options);
  } catch (const UserError& error) {
    REQUIRE(std::string_view(error.what()).find('\n') == std::string_view::npos);
    REQUIRE(std::string_view(error.what()).starts_with(path));
  }
}

}  // namespace

TEST_CASE("hostile files: every one loads or is refused with its name, within 10 s and 2 GiB") {
  const auto folder = scene_folder();
  if (!folder || !std::filesystem::is_directory(*folder / "Hostile")) {
    WARN("skipped: no folder of hostile scenes");
    return;
  }
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder / "Hostile")) {
    if (entry.path().extension() != ".gltf" && entry.path().extension() != ".glb") continue;
    CAPTURE(entry.path().string());
    const auto start = std::chrono::steady_clock::now();
    load_or_refuse(entry.path().string());
    REQUIRE(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
    ++files;
  }
  REQUIRE(files > 100);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  REQUIRE(usage.ru_maxrss < 2 * 1024 * 1024);  // KiB
}

TEST_CASE("hostile files: random damage to a good file never crashes the loader") {
  const std::string good = triangle_gltf(
      R"(,"material":0)", R"(,"materials":[{"alphaMode":"MASK"}],"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}])",
      R"(,"camera":0)");
  std::mt19937 dice(1);
  for (int i = 0; i < 3000; ++i) {
    std::string bad = good;
    for (unsigned k = 0; k < 1 + dice() % 3; ++k) bad[dice() % bad.size()] = static_cast<char>(dice() % 96 + 32);
    if (dice() % 4 == 0) bad.resize(dice() % bad.size());
    const std::string result = load_result(bad);
    REQUIRE(result.find('\n') == std::string::npos);
  }
}

TEST_CASE("hostile files: random damage to a binary file never crashes the loader") {
  const auto folder = scene_folder();
  if (!folder) {
    WARN("skipped: no folder of scenes");
    return;
  }
  const std::vector<std::byte> good = traces::read_whole_file((*folder / "BoxVertexColors/BoxVertexColors.glb").string(), 1 << 20);
  const TempGltf file("", "t.glb");
  std::mt19937 dice(2);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> bad = good;
    for (unsigned k = 0; k < 1 + dice() % 4; ++k) bad[dice() % (i % 2 == 0 ? 32 : bad.size())] = static_cast<std::byte>(dice() % 256);
    if (dice() % 4 == 0) bad.resize(dice() % bad.size());
    traces::write_whole_file(file.path(), bad);
    load_or_refuse(file.path());
  }
}
