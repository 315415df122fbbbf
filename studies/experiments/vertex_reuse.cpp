/// Vertices shaded, by the policy of their reuse, against an analyser written by others and the published
/// steps.
#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "studies/experiments/draw_meshes.h"
#include "studies/experiments/experiment.h"
#include "studies/plot.h"
#include "studies/stability/stream_builder.h"

namespace quadrille::studies::experiments {
namespace {

/// A policy as the machine's parameters, and as the analyser's; a cache of 0 is none: every corner is shaded.
struct Policy {
  const char* name;
  std::vector<std::string> settings;
  unsigned cache, warp, group;
};

const std::vector<Policy>& policies() {
  static const std::vector<Policy> all{
      {"batch of 32, 32 triangles", {}, 32, 32, 32},
      {"batch of 32, 128 triangles", {"vertex_fetch.batch_triangles=128"}, 32, 32, 128},
      {"batch of 16, 16 triangles",
       {"vertex_fetch.batch_vertices=16", "vertex_fetch.batch_triangles=16"},
       16,
       16,
       16},
      {"FIFO of 16", {"vertex_fetch.reuse=fifo", "vertex_fetch.reuse_entries=16"}, 16, 0, 0},
      {"FIFO of 128", {"vertex_fetch.reuse=fifo", "vertex_fetch.reuse_entries=128"}, 128, 0, 0},
      {"none", {"vertex_fetch.reuse=none"}, 0, 0, 0}};
  return all;
}

/// What was seen when the indices 0, 1, 2 were drawn again and again.
struct Step {
  const char* card;
  std::vector<std::string> settings;
  std::uint32_t indices;
  int vertices;
};

const std::vector<Step>& steps() {
  static const std::vector<Step> all{{"GeForce GTX 1080 Ti", {}, 96, 3},
                                     {"GeForce GTX 1080 Ti", {}, 99, 6},
                                     {"Radeon R7 200", {"vertex_fetch.batch_triangles=128"}, 384, 3},
                                     {"Radeon R7 200", {"vertex_fetch.batch_triangles=128"}, 387, 6}};
  return all;
}

traces::CommandStream repeated(std::uint32_t indices) {
  const stability::Corners corners{{{-0.5F, -0.5F, 0, 1}, {1, 0, 0, 1}, {}},
                                   {{0, 0.5F, 0, 1}, {0, 1, 0, 1}, {}},
                                   {{0.5F, -0.5F, 0, 1}, {0, 0, 1, 1}, {}}};
  std::vector<std::uint32_t> list(indices);
  for (std::uint32_t i = 0; i < indices; ++i) list[i] = i % 3;
  stability::StreamBuilder builder(fmt::format("0,1,2 to {} indices", indices), 64, 64);
  return builder.draw_indexed(corners, list).finish();
}

struct Scene {
  std::string name;
  traces::CommandStream stream;
  std::vector<DrawMesh> meshes;
  [[nodiscard]] double sum(const std::function<double(const DrawMesh&)>& value) const {
    return std::accumulate(meshes.begin(), meshes.end(), 0.0,
                           [&](double total, const DrawMesh& m) { return total + value(m); });
  }
};

double triangles(const DrawMesh& m) {
  return static_cast<double>(m.instances) * static_cast<double>(m.corners.size()) / 3;
}

double analysed(const Scene& scene, const Policy& p) {
  return scene.sum([&](const DrawMesh& m) {
    return p.cache == 0 ? 3 * triangles(m)
                        : static_cast<double>(analysed_vertices(m, p.cache, p.warp, p.group));
  });
}

std::vector<Scene> scenes_of(const Setting& setting) {
  std::vector<Scene> all;
  for (const auto& [name, load] : setting.scenes) {
    all.push_back({name, load(), {}});
    all.back().meshes = draw_meshes(all.back().stream);
  }
  return all;
}

/// A row a policy; the verdict is that of all.
void add_scene(const Scene& scene, const Readings* readings, Result& result, std::string& data) {
  const double count = scene.sum(triangles),
               distinct = scene.sum([](const DrawMesh&m) { return 1.0 * m.vertices * m.instances; });
  double apart = 0;
  data += quoted(scene.name);
  for (const Policy& p : policies()) {
    const Readings& r = *readings++;
    const double shaded = r["core.vertices"], counted = analysed(scene, p);
    apart += std::abs(shaded - counted);
    const bool first = &p == &policies().front();
    result.table.rows.push_back(
        {first ? scene.name : "", first ? fmt::format("{}", scene.meshes.size()) : "",
         first ? fmt::format("{:.0f}", count) : "", first ? fmt::format("{:.0f}", distinct) : "", p.name,
         fmt::format("{:.0f}", shaded), fmt::format("{:.0f}", counted), fmt::format("{:.3f}", shaded / count),
         fmt::format("{:.0f}", r["core.vertex_warps"]), fmt::format("{:.0f}", r["frame.render_cycles"])});
    data += fmt::format(" {}", shaded / count);
  }
  data += "\n";
  result.verdicts.push_back(
      {fmt::format("{}: vertices shaded apart from the analyser's, all policies", scene.name), apart, 0, 0});
}

void add_step(const Step& step, const Readings& r, Result& result) {
  const double shaded = r["core.vertices"];
  result.table.rows.push_back(
      {fmt::format("0,1,2 to {} indices", step.indices), "1", fmt::format("{}", step.indices / 3), "3",
       fmt::format("batch, as {}", step.card), fmt::format("{:.0f}", shaded),
       fmt::format("{} (measured)", step.vertices), fmt::format("{:.3f}", 3 * shaded / step.indices),
       fmt::format("{:.0f}", r["core.vertex_warps"]), fmt::format("{:.0f}", r["frame.render_cycles"])});
  const double least = step.vertices;
  result.verdicts.push_back(
      {fmt::format("{}, {} indices: vertices shaded", step.card, step.indices), shaded, least, least});
}

}  // namespace

Result vertex_reuse(const Setting& setting) {
  const std::vector<Scene> scenes = scenes_of(setting);
  std::vector<traces::CommandStream> repeats;
  for (const Step& step : steps()) repeats.push_back(repeated(step.indices));
  std::vector<Frame> frames;
  for (const Scene& scene : scenes) {
    for (const Policy& p : policies()) frames.push_back({&scene.stream, p.settings});
  }
  for (std::size_t i = 0; i < repeats.size(); ++i) frames.push_back({&repeats[i], steps()[i].settings});
  const std::vector<Readings> read = draw(frames, setting);
  Result result;
  result.table.head = {"scene",  "meshes",   "triangles",       "vertices",     "policy",
                       "shaded", "expected", "shaded/triangle", "vertex warps", "cycles"};
  std::string data;
  const Readings* next = read.data();
  for (const Scene& scene : scenes) {
    add_scene(scene, next, result, data);
    next += policies().size();
  }
  for (const Step& step : steps()) add_step(step, *next++, result);
  result.remarks = {
      "Expected is the analyser's sum over the draws, each with its own mesh: no reuse reaches from one draw "
      "or instance to the next. Its "
      "three "
      "numbers (FIFO, vertices of a warp, triangles of a group) are (n, n, m) for batches of n vertices and "
      "m triangles, and (n, 0, 0) for "
      "a FIFO of n vertices; without reuse it is every corner."};
  result.plot =
      "set style data histograms\nset style fill solid 0.8\nset xtics rotate by -30 font ',9'\nset ylabel "
      "'vertices shaded a "
      "triangle'\nset yrange "
      "[0:*]\nset key outside top center horizontal\nset grid y\n$d << EOD\n" +
      data + "EOD\nplot ";
  for (std::size_t i = 0; i < policies().size(); ++i) {
    result.plot += i == 0 ? fmt::format("$d using 2:xtic(1) title '{}'", policies()[i].name)
                          : fmt::format(", '' using {} title '{}'", i + 2, policies()[i].name);
  }
  return result;
}

}  // namespace quadrille::studies::experiments
