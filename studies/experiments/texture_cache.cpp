/// First-level texture caches: bytes fetched by size, by ways, by the order of tiles and by the layout of
/// texels, and hit rates beside published ones.
#include <fmt/format.h>

#include <array>
#include <limits>

#include "studies/experiments/experiment.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

constexpr std::array kKibibytes{1, 2, 4, 8, 16, 32, 64, 128};
constexpr std::array kWays{1, 2, 4, 8, 16};
constexpr std::array kOrders{"scan", "morton", "hilbert"};
constexpr std::array kOrderedKibibytes{2, 8, 32};  ///< of the caches that the orders are compared with
constexpr std::array kReplacements{"lru", "tree", "fifo", "random", "srrip"};
constexpr std::array kReplacedKibibytes{4, 8, 16};  ///< of the caches that the policies are compared with
constexpr std::array kLayouts{"tiled", "linear", "morton", "williams"};  ///< of texels in memory
constexpr int kLineBytes = 128, kUsualWays = 8;
constexpr int kPublishedKnee = 16;  ///< KiB
constexpr double kAtKnee = 0.95;    ///< of the bytes that the largest cache saves
constexpr double kLeastSaved = 3;   ///< times fewer bytes than without a cache, at the published knee

std::vector<std::string> cache(int kibibytes, int ways, const char* order = "scan") {
  return {"gpu.cores=1", fmt::format("texture.cache_lines={}", kibibytes * 1024 / kLineBytes),
          fmt::format("texture.cache_ways={}", ways), fmt::format("coarse_raster.order={}", order)};
}

/// The machines that each scene is drawn on, in the order of `SceneReadings`.
std::vector<std::vector<std::string>> machines() {
  std::vector<std::vector<std::string>> all;
  all.reserve(kKibibytes.size() + kWays.size() + kOrderedKibibytes.size() * kOrders.size() +
              kReplacedKibibytes.size() * kReplacements.size() + kOrderedKibibytes.size() * kLayouts.size() +
              1);
  for (const int size : kKibibytes) all.push_back(cache(size, kUsualWays));
  for (const int ways : kWays) all.push_back(cache(kPublishedKnee, ways));
  for (const int size : kOrderedKibibytes)
    for (const char* order : kOrders) all.push_back(cache(size, kUsualWays, order));
  for (const int size : kReplacedKibibytes)
    for (const char* replacement : kReplacements) {
      all.push_back(cache(size, kUsualWays));
      all.back().push_back(fmt::format("texture.replacement={}", replacement));
    }
  for (const int size : kOrderedKibibytes)
    for (const char* layout : kLayouts) {
      all.push_back(cache(size, kUsualWays));
      all.back().push_back(fmt::format("texture.layout={}", layout));
    }
  all.emplace_back();
  return all;
}

/// Bytes fetched for a fragment.
double fetched(const Readings& r) { return r["texture.read_bytes"] / r["frame.fragments_shaded"]; }
/// Bytes of a fragment's texels, each read by itself. Textures of scenes have 4 bytes a texel.
double without_cache(const Readings& r) { return 4 * r["texture.texels"] / r["frame.fragments_shaded"]; }

struct SceneReadings {
  explicit SceneReadings(const Readings* next) : none(without_cache(*next)) {
    for (double& bytes : by_size) bytes = fetched(*next++);
    for (double& bytes : by_ways) bytes = fetched(*next++);
    for (auto& orders : by_order)
      for (double& bytes : orders) bytes = fetched(*next++);
    for (auto& policies : by_replacement)
      for (double& bytes : policies) bytes = fetched(*next++);
    for (auto& layouts : by_layout)
      for (double& bytes : layouts) bytes = fetched(*next++);
    usual = next;
  }
  /// KiB of the smallest cache that saves nearly all that the largest saves.
  [[nodiscard]] int knee() const {
    std::size_t at = 0;
    while (none - by_size[at] < kAtKnee * (none - by_size.back())) ++at;
    return kKibibytes[at];
  }

  double none = 0;  ///< bytes a fragment, as in the others
  std::array<double, kKibibytes.size()> by_size{};
  std::array<double, kWays.size()> by_ways{};
  std::array<std::array<double, kOrders.size()>, kOrderedKibibytes.size()> by_order{};
  std::array<std::array<double, kReplacements.size()>, kReplacedKibibytes.size()> by_replacement{};
  std::array<std::array<double, kLayouts.size()>, kOrderedKibibytes.size()> by_layout{};
  const Readings* usual = nullptr;  ///< the default machine
};

std::vector<std::string> row_of(const std::string& name, const auto& values) {
  std::vector<std::string> row{name};
  for (const double value : values) row.push_back(fmt::format("{:.2f}", value));
  return row;
}

Table table_of(const std::string& first, const auto& columns, const char* unit = "") {
  Table table{{first}, {}};
  for (const auto& column : columns) table.head.push_back(fmt::format("{}{}", column, unit));
  return table;
}

void judge(const std::string& name, const SceneReadings& scene, Result& result) {
  for (std::size_t i = 1; i < kKibibytes.size(); ++i)
    result.verdicts.push_back(
        {fmt::format("{}: bytes at {} KiB over those at half of it", name, kKibibytes[i]),
         scene.by_size[i] / scene.by_size[i - 1], 0, 1.01});
  result.verdicts.push_back({name + ": bytes with 16 ways over those with one",
                             scene.by_ways.back() / scene.by_ways.front(), 0, 1});
  result.verdicts.push_back(
      {name + ": KiB at the knee", static_cast<double>(scene.knee()), 1, kPublishedKnee});
  const auto& small = scene.by_layout.front();
  result.verdicts.push_back({name + ": bytes in Williams' layout over those in tiles, at 2 KiB",
                             small[3] / small[0], 1, std::numeric_limits<double>::infinity()});
  const double at_knee = scene.by_size[4];
  static_assert(kKibibytes[4] == kPublishedKnee);
  result.verdicts.push_back({name + ": bytes without a cache over those at 16 KiB", scene.none / at_knee,
                             kLeastSaved, std::numeric_limits<double>::infinity()});
}

std::vector<std::string> rates_of(const std::string& name, const Readings& r) {
  const auto hits = [&](const std::string& cache) {
    return 100 * (r[cache + "hits"] + r[cache + "merged"]) / r[cache + "requests"];
  };
  return {name, fmt::format("{:.1f} %", hits("texture.cache_")),
          fmt::format("{:.1f} %", 100 * (1 - fetched(r) / without_cache(r))),
          fmt::format("{:.1f} %", hits("l2."))};
}

const char* const kPlotHead =
    "set logscale x 2\nset xlabel 'KiB of the texture cache'\nset ylabel 'bytes fetched a fragment'\nset "
    "yrange "
    "[0:*]\nset grid\n$d << EOD\n";

}  // namespace

Result texture_cache(const Setting& setting) {
  std::vector<traces::CommandStream> streams;
  for (const auto& [name, load] : setting.scenes) streams.push_back(load());
  const std::vector<std::vector<std::string>> all = machines();
  std::vector<Frame> frames;
  for (const traces::CommandStream& stream : streams)
    for (const std::vector<std::string>& machine : all) frames.push_back({&stream, machine});
  const std::vector<Readings> read = draw(frames, setting);

  Result result;
  result.table = table_of("bytes a fragment, by size", kKibibytes, " KiB");
  result.table.head.insert(result.table.head.end(), {"no cache", "knee"});
  Table by_ways = table_of("16 KiB, by ways", kWays), by_order = table_of("by order of tiles", kOrders),
        by_replacement = table_of("by replacement", kReplacements),
        by_layout = table_of("by layout in memory", kLayouts),
        rates{{"default machine", "look-ups that hit", "bytes of texels not fetched", "L2 requests that hit"},
              {}};
  std::string data, curves;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const std::string& name = setting.scenes[i].first;
    const SceneReadings scene(&read[i * all.size()]);
    result.table.rows.push_back(row_of(name, scene.by_size));
    result.table.rows.back().push_back(fmt::format("{:.1f}", scene.none));
    result.table.rows.back().push_back(fmt::format("{} KiB", scene.knee()));
    by_ways.rows.push_back(row_of(name, scene.by_ways));
    for (std::size_t s = 0; s < kOrderedKibibytes.size(); ++s)
      by_order.rows.push_back(
          row_of(fmt::format("{}, {} KiB", name, kOrderedKibibytes[s]), scene.by_order[s]));
    for (std::size_t s = 0; s < kReplacedKibibytes.size(); ++s)
      by_replacement.rows.push_back(
          row_of(fmt::format("{}, {} KiB", name, kReplacedKibibytes[s]), scene.by_replacement[s]));
    for (std::size_t s = 0; s < kOrderedKibibytes.size(); ++s)
      by_layout.rows.push_back(
          row_of(fmt::format("{}, {} KiB", name, kOrderedKibibytes[s]), scene.by_layout[s]));
    rates.rows.push_back(rates_of(name, *scene.usual));
    judge(name, scene, result);
    for (std::size_t s = 0; s < kKibibytes.size(); ++s)
      data += fmt::format("{} {}\n", kKibibytes[s], scene.by_size[s]);
    data += "\n\n";
    curves +=
        fmt::format("{}$d index {} using 1:2 with linespoints title {}", i > 0 ? ", " : "", i, quoted(name));
  }
  result.further_tables = {by_ways, by_order, by_layout, by_replacement, rates};
  result.remarks = {
      "The knee is the smallest cache that saves 95 % of the bytes that 128 KiB save. It stands for all "
      "textures "
      "of a scene together; `builtin:quad` has one.",
      "More is saved than the published 3 to 15 times. A fragment reads eight texels or more, neighbours "
      "read "
      "the same ones, and these scenes look at their textures from near: many fragments lie in one texel.",
      "Every order here goes by tiles of 8x8 pixels; rows of single pixels, the worst of the published "
      "orders, "
      "are not built. Row by row of tiles is the best where a row's lines fit, since then nothing is fetched "
      "twice. Squares win only in between, and only if the texture lies along the screen: on `builtin:quad` "
      "it "
      "lies across, and an exact LRU cache of the same look-ups confirms the order.",
      "The first level's rate counts a warp's distinct lines, of which each is looked up once for 32 "
      "fragments: "
      "it is lower than a rate by texels, which the third column is near to."};
  result.remarks.emplace_back(
      "Layouts: a line of tiles or of Morton order has 8x4 texels, one of rows 32x1, one of Williams' "
      "pyramid 128 "
      "bytes of one component, so a texel there is four look-ups. Where textures lie along the screen's rows "
      "and "
      "the cache holds a row of tiles, rows of texels do as well as tiles. Levels that are narrower than a "
      "tile "
      "of 32 texels leave lines of it empty and few sets for the others; Morton order has no such holes.");
  result.plot = kPlotHead + data + "EOD\nplot " + curves;
  return result;
}

}  // namespace quadrille::studies::experiments
