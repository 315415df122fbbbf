/// Malformed files: each loads or is refused by a UserError, in bounded time and memory.
#include <fmt/format.h>
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <random>

#include "models/base/error.h"
#include "scenes/scene.h"
#include "tests/host_speed.h"
#include "tests/scenes/gltf_builder.h"
#include "tests/scenes/gltf_text.h"
#include "tests/scenes/scene_folder.h"
#include "traces/whole_file.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

void load_or_refuse(const std::string& path, std::optional<double> time = std::nullopt) {
  try {
    SceneOptions options;
    options.time = time;
    if (time) options.animation = "all";
    options.width = options.height = 64;
    (void)load_scene(path, options);
  } catch (const UserError& error) {
    REQUIRE(std::string_view(error.what()).find('\n') == std::string_view::npos);
    REQUIRE(std::string_view(error.what()).starts_with(path));
  }
}

}  // namespace

TEST_CASE(
    "hostile files: every one loads or is refused with its name, within 10 s of processor time and 2 GiB") {
  const auto folder = scene_folder();
  if (!folder || !std::filesystem::is_directory(*folder / "Hostile")) {
    WARN("skipped: no folder of hostile scenes");
    return;
  }
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder / "Hostile")) {
    if (entry.path().extension() != ".gltf" && entry.path().extension() != ".glb") continue;
    CAPTURE(entry.path().string());
    const double start = tests::processor_seconds();
    load_or_refuse(entry.path().string());
    load_or_refuse(entry.path().string(), 0.3);
    const double taken = tests::processor_seconds() - start;
    if (taken > 10) REQUIRE(taken < 10 * tests::host_slowness());
    ++files;
  }
  REQUIRE(files > 100);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  REQUIRE(usage.ru_maxrss < 2 * 1024 * 1024);  // KiB
}

TEST_CASE("hostile files: random damage to a good file never crashes the loader") {
  const std::string good = triangle_gltf(
      R"(,"material":0)",
      R"(,"materials":[{"alphaMode":"MASK"}],"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}])",
      R"(,"camera":0)");
  std::mt19937 dice(1);
  for (int i = 0; i < 3000; ++i) {
    std::string bad = good;
    for (unsigned k = 0; k < 1 + dice() % 3; ++k)
      bad[dice() % bad.size()] = static_cast<char>(dice() % 96 + 32);
    if (dice() % 4 == 0) bad.resize(dice() % bad.size());
    const std::string result = load_result(bad);
    REQUIRE(result.find('\n') == std::string::npos);
  }
}

TEST_CASE(
    "hostile files: random damage to skins, morph targets and animations never crashes loader, posing or "
    "recorder") {
  std::mt19937 dice(3);
  const TempGltf file("");
  for (int i = 0; i < 600; ++i) {
    std::string bad = i % 2 == 0 ? arm_gltf() : morph_gltf(4, "[0.5,0,1,0]");
    // Half of the damage is to the numbers of the buffer, half to the JSON after it.
    const std::size_t start = bad.find("base64,") + 7, end = bad.find('"', start);
    for (unsigned k = 0; k < 1 + dice() % 3; ++k) {
      if (dice() % 2 == 0) {
        bad[start + dice() % (end - start)] = "AZaz09+/"[dice() % 8];
      } else {
        bad[end + dice() % (bad.size() - end)] = "0123456789[]{},"[dice() % 15];
      }
    }
    traces::write_whole_file(file.path(), std::as_bytes(std::span(bad)));
    load_or_refuse(file.path(), 0.3);
  }
}

TEST_CASE("hostile files: random damage to a binary file never crashes the loader") {
  const auto folder = scene_folder();
  if (!folder) {
    WARN("skipped: no folder of scenes");
    return;
  }
  const std::vector<std::byte> good =
      traces::read_whole_file((*folder / "BoxVertexColors/BoxVertexColors.glb").string(), 1 << 20);
  const TempGltf file("", "t.glb");
  std::mt19937 dice(2);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> bad = good;
    for (unsigned k = 0; k < 1 + dice() % 4; ++k)
      bad[dice() % (i % 2 == 0 ? 32 : bad.size())] = static_cast<std::byte>(dice() % 256);
    if (dice() % 4 == 0) bad.resize(dice() % bad.size());
    traces::write_whole_file(file.path(), bad);
    load_or_refuse(file.path());
  }
}
