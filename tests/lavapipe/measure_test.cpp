/// Statistics of a Vulkan device against the counters of the simulated machine, mesh by mesh, and what the
/// measuring programs refuse.
///
/// Where Vulkan fixes the meaning of a statistic, the two are equal. Where it leaves it to the driver
/// (vertices that are not shaded again, fragment shaders run beside covered pixels), each side is held to its
/// own meaning, counted from the mesh: docs/hardware.md.
#include <catch2/catch.hpp>

#include <sys/wait.h>
#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include "models/base/error.h"
#include "studies/experiments/triangle_work.h"
#include "tests/lavapipe/llvmpipe_counts.h"
#include "tests/lavapipe/measure_machine.h"
#include "tests/lavapipe/measure_vulkan.h"

namespace quadrille::lavapipe {
namespace {

constexpr std::uint32_t kWidth = 256, kHeight = 192;
MeasureOptions statistics_alone() { return {.times = false}; }

struct Pair {
  PassStatistics ours, theirs;
  studies::experiments::TriangleMesh mesh;
};

/// Each point of the experiment on both; empty where there is no driver. The machine comes first: it forks,
/// which no thread of a driver survives.
std::vector<Pair> both(const std::string& name) {
  const std::vector<MeasuredExperiment> experiment = chosen_experiments({name}, kWidth, kHeight);
  const Measurement ours = simulate_all(experiment, {}, 1, [](const std::string&) {});
  std::optional<VulkanDevice> device;
  try {
    device.emplace(DeviceWish{});
  } catch (const UserError& error) {
    WARN("skipped: " << error.what());
    return {};
  }
  const Measurement theirs = measure_all(*device, experiment, statistics_alone(), [](const std::string&) {});
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < experiment.front().points.size(); ++i) {
    pairs.push_back({*ours.curves.front().points[i].statistics, *theirs.curves.front().points[i].statistics,
                     experiment.front().points[i].mesh()});
  }
  return pairs;
}

/// What means the same to every driver.
void check_equal(const Pair& p) {
  CHECK(p.theirs.input_vertices == 3 * p.mesh.triangles.size());
  CHECK(p.ours.input_vertices == p.theirs.input_vertices);
  CHECK(p.theirs.input_primitives == p.ours.input_primitives);
  CHECK(p.theirs.clipping_invocations == p.ours.clipping_invocations);
  CHECK(p.theirs.clipping_primitives == p.ours.clipping_primitives);
  CHECK(p.theirs.samples_passed == p.ours.samples_passed);
}

void check_vertices(const Pair& p) {
  CHECK(p.theirs.vertex_invocations == llvmpipe_vertex_invocations(p.mesh));
  CHECK(p.ours.vertex_invocations == studies::experiments::work_of(p.mesh, {}).vertices);
}

/// Of a mesh whose every triangle is drawn and none hidden.
void check_fragments(const Pair& p) {
  CHECK(p.theirs.fragment_invocations == llvmpipe_fragment_invocations(p.mesh));
  CHECK(p.ours.fragment_invocations == p.theirs.samples_passed);
}

/// The exit code and all that a program says.
std::pair<int, std::string> run(const std::string& command) {
  std::string said;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 4096> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) said += part.data();
  const int status = ::pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, said};
}

void check_refused(const std::string& command, const std::string& reason) {
  INFO(command);
  const auto [code, said] = run(command);
  CHECK(code == 2);
  CHECK_THAT(said, Catch::Contains(reason));
  CHECK(std::count(said.begin(), said.end(), '\n') == 1);
}

const std::string kVulkan = QUADRILLE_MEASURE_VULKAN, kSimulated = QUADRILLE_MEASURE_SIMULATED;

}  // namespace

TEST_CASE("statistics of meshes that are drawn whole equal the machine's counters") {
  for (const char* name : {"small-triangles", "thin-triangles", "vertex-reuse", "quad-overhead"}) {
    std::size_t point = 0;
    for (const Pair& p : both(name)) {
      INFO(name << ", point " << point++);
      check_equal(p);
      check_vertices(p);
      check_fragments(p);
    }
  }
}

TEST_CASE("statistics of culled, off-screen and one-pixel triangles equal the machine's counters") {
  const std::vector<Pair> pairs = both("setup-rate");
  if (pairs.empty()) return;
  REQUIRE(pairs.size() == 3);
  for (const Pair& p : pairs) {
    check_equal(p);
    check_vertices(p);
  }
  check_fragments(pairs[2]);
  // culling comes after clipping
  CHECK(pairs[0].theirs.clipping_primitives == pairs[0].theirs.input_primitives);
  CHECK(pairs[1].theirs.clipping_primitives == 0);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(pairs[i].theirs.fragment_invocations == 0);
    CHECK(pairs[i].ours.fragment_invocations == 0);
  }
}

TEST_CASE("statistics of triangles that the near plane cuts equal the machine's counters") {
  const std::vector<Pair> pairs = both("near-plane");
  if (pairs.empty()) return;
  REQUIRE(pairs.size() == 4);
  const std::uint64_t pieces[] = {1, 2, 1, 0};  // of a triangle, by its corners before the plane
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    INFO(i);
    check_equal(pairs[i]);
    check_vertices(pairs[i]);
    CHECK(pairs[i].theirs.clipping_primitives == pieces[i] * pairs[i].theirs.input_primitives);
    CHECK(pairs[i].ours.fragment_invocations == pairs[i].theirs.samples_passed);
  }
}

TEST_CASE("statistics of layers equal the machine's counters, llvmpipe counts hidden fragments as well") {
  for (const char* name : {"front-to-back", "back-to-front", "opaque-layers", "blended-layers"}) {
    for (const Pair& p : both(name)) {
      INFO(name);
      check_equal(p);
      check_vertices(p);
      CHECK(p.theirs.fragment_invocations == llvmpipe_fragment_invocations(p.mesh));
      CHECK(p.ours.fragment_invocations == p.theirs.samples_passed);
    }
  }
}

TEST_CASE("statistics of layers in every format equal the machine's counters") {
  for (const char* name : {"opaque-formats", "blended-formats", "depth-formats"}) {
    for (const Pair& p : both(name)) {
      INFO(name);
      check_equal(p);
      check_vertices(p);
      CHECK(p.ours.fragment_invocations == p.theirs.samples_passed);
    }
  }
}

TEST_CASE("samples that pass are counted by sample, and fragments once a pixel and triangle") {
  for (const char* name : {"samples", "samples-with-depth"}) {
    const std::vector<Pair> pairs = both(name);
    if (pairs.empty()) return;
    REQUIRE(pairs.size() == 4);  // of one sample, then of four
    for (const std::size_t i : {0U, 1U}) {
      const Pair &one = pairs[i], &four = pairs[i + 2];
      CHECK(four.ours.samples_passed == 4 * one.ours.samples_passed);
      CHECK(four.theirs.samples_passed == four.ours.samples_passed);
      // Both triangles of a layer shade the pixels of the diagonal between them.
      CHECK(four.ours.fragment_invocations > one.ours.fragment_invocations);
      CHECK(four.ours.fragment_invocations <= one.ours.fragment_invocations * (kWidth + 2) / kWidth);
    }
  }
}

TEST_CASE("a time is a median of what was measured, and the JSON holds each") {
  CHECK(median({3, 1, 2}) == 2);
  CHECK(median({4, 1, 2, 3}) == 2.5);
  const Measurement m{"a device",
                      "a driver",
                      std::nullopt,
                      "ns",
                      4,
                      2,
                      {{"curve", "axis", {{"first", 1, {30, 10, 20}, std::nullopt}}}}};
  CHECK_THAT(to_json(m), Catch::Contains("\"median\": 20.0") && Catch::Contains("\"least\": 10.0") &&
                             !Catch::Contains("statistics"));
}

TEST_CASE("a device's times are one positive number a repetition") {
  std::optional<VulkanDevice> device;
  try {
    device.emplace(DeviceWish{});
  } catch (const UserError& error) {
    WARN("skipped: " << error.what());
    return;
  }
  MeasureOptions options{.statistics = false, .repeats = 3};
  options.enough = std::chrono::steady_clock::now() + std::chrono::hours(1);
  const auto stream = chosen_experiments({"setup-rate"}, 64, 64).front().points.back().stream();
  const MeasuredPoint point = measure(*device, stream, options);
  REQUIRE(point.times.size() == 3);
  for (const double t : point.times) CHECK(t > 0);
  CHECK_FALSE(point.statistics.has_value());
  options.enough = {};
  CHECK(measure(*device, stream, options).times.size() == 1);
}

TEST_CASE("a device that cannot measure what is asked is refused by the feature's name") {
  DeviceInfo able{
      .name = "a GPU", .pipeline_statistics = true, .precise_occlusion = true, .timestamp_bits = 36};
  CHECK_NOTHROW(require_features(able, {}));
  DeviceInfo device = able;
  device.timestamp_bits = 0;
  CHECK_THROWS_WITH(require_features(device, {}),
                    Catch::Contains("a GPU has no timestamps") && Catch::Contains("--no-times"));
  CHECK_NOTHROW(require_features(device, {.times = false}));
  device = able;
  device.pipeline_statistics = false;
  CHECK_THROWS_WITH(require_features(device, {}),
                    Catch::Contains("pipelineStatisticsQuery") && Catch::Contains("--no-statistics"));
  CHECK_NOTHROW(require_features(device, {.statistics = false}));
  device = able;
  device.precise_occlusion = false;
  CHECK_THROWS_WITH(require_features(device, {}), Catch::Contains("occlusionQueryPrecise"));
}

TEST_CASE("the measuring programs refuse with one line and exit code 2") {
  check_refused("VK_ICD_FILENAMES=/no/driver.json " + kVulkan, "no driver found");
  check_refused(kVulkan + " small-triangle", "did you mean");
  check_refused(kVulkan + " --size 3", "expected WIDTHxHEIGHT");
  check_refused(kVulkan + " --size 3x99999", "expected WIDTHxHEIGHT");
  check_refused(kVulkan + " --no-times --no-statistics", "nothing to measure");
  check_refused(kVulkan + " --scene builtin:quad setup-rate", "not together");
  check_refused(kVulkan + " --repeats 0", "--repeats");
  check_refused(kVulkan + " --pictures /no/folder setup-rate", "--pictures: /no/folder: not a folder");
  check_refused(kSimulated + " --traces /no/folder setup-rate", "--traces: /no/folder: not a folder");
  check_refused(kSimulated + " --scene builtin:quad setup-rate", "not together");
  check_refused(kSimulated + " thin", "there is no experiment 'thin'");
  check_refused(kSimulated + " --set nonsense thin-triangles", "expected KEY=VALUE");
  try {
    const VulkanDevice device{DeviceWish{}};
  } catch (const UserError& error) {
    WARN("skipped: " << error.what());
    return;
  }
  check_refused(kVulkan + " --device 'no such card'", "no device named 'no such card'; there are: '");
  check_refused(
      "VK_ICD_FILENAMES=$(ls /usr/share/vulkan/icd.d/lvp* /etc/vulkan/icd.d/lvp* 2>/dev/null | head -1) " +
          kVulkan,
      "no GPU; there are: 'llvmpipe");
  check_refused(kVulkan + " --device llvmpipe --scene builtin:none -q", "none");
  check_refused(kVulkan + " --device llvmpipe vertex-reuse -q --no-times --size 8x8 --out /no/folder/x.json",
                "--out: /no/folder/x.json");
}

}  // namespace quadrille::lavapipe
