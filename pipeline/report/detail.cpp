/// What the counts of a draw and of a tile are called, and the laws of their sums.
#include "pipeline/report/detail.h"

#include <algorithm>
#include <numeric>

namespace quadrille::pipeline {

namespace {

/// A law that holds for each draw by itself, between counts of different units.
struct DrawLaw {
  hw::Law law;
  std::vector<DrawCount> left, right;
};

constexpr hw::Law of_each_draw(std::string_view text) { return {text, "draws that differ", "none"}; }

const std::vector<DrawLaw>& draw_laws() {
  using enum DrawCount;
  static const std::vector<DrawLaw> laws{
      {of_each_draw("each draw: vertices fetched = vertices shaded"), {kVerticesFetched}, {kVerticesShaded}},
      {of_each_draw("each draw: vertices shaded = vertices assembled"),
       {kVerticesShaded},
       {kVerticesAssembled}},
      {of_each_draw("each draw: triangles fetched = triangles assembled"),
       {kTrianglesFetched},
       {kTrianglesIn}},
      {of_each_draw("each draw: triangles assembled = triangles to clip"),
       {kTrianglesIn},
       {kTrianglesClipped}},
      {of_each_draw("each draw: triangles kept = triangles walked"), {kTrianglesDrawn}, {kTrianglesWalked}},
      {of_each_draw("each draw: fragments covered = killed early + packed"),
       {kCovered},
       {kKilledEarly, kSamplesPacked}},
      {of_each_draw("each draw: fragments packed = fragments shaded"), {kPacked}, {kShaded}},
      {of_each_draw("each draw: fragments shaded = fragments at the ROP"), {kShaded}, {kAtRop}},
      {of_each_draw("each draw: fragments shaded = discarded + killed late + written"),
       {kShaded},
       {kDiscarded, kKilledLate, kWritten}},
      {of_each_draw("each draw: texture requests sent = answered"), {kTextureSent}, {kTextureTaken}},
      {of_each_draw("each draw: requests of clients = requests looked up in L2"),
       {kClientRequests},
       {kL2Requests}},
      {of_each_draw("each draw: bytes filled into L2 = bytes read from memory"),
       {kFillBytes},
       {kMemoryReadBytes}}};
  return laws;
}

constexpr hw::Law kBusyOfDraws{"busy cycles for draws and for none = of the units",
                               "draws.busy + outside_draws.busy", "units.busy"};

std::uint64_t sum(const DrawFigures& draw, const std::vector<DrawCount>& counts) {
  std::uint64_t sum = 0;
  for (const DrawCount c : counts) sum += draw.of(c);
  return sum;
}

}  // namespace

const std::array<DetailCount, kDrawCounts>& draw_counts() {
  static const std::array<DetailCount, kDrawCounts> counts{{
      {"triangles",
       "in",
       {"triangles of draws and of none = of the frame", "draws.triangles.in + outside_draws",
        "primitive_assembly.triangles"}},
      {"triangles",
       "drawn",
       {"triangles drawn of draws and of none = of the frame", "draws.triangles.drawn + outside_draws",
        "triangle_setup.kept"}},
      {"vertices",
       "shaded",
       {"vertices shaded for draws and for none = for the frame", "draws.vertices.shaded + outside_draws",
        "core.vertices"}},
      {"fragments",
       "covered",
       {"fragments covered of draws and of none = of the frame", "draws.fragments.covered + outside_draws",
        "fine_raster.fragments"}},
      {"fragments",
       "shaded",
       {"fragments shaded of draws and of none = of the frame", "draws.fragments.shaded + outside_draws",
        "core.fragments"}},
      {"fragments",
       "killed_early",
       {"fragments killed early of draws and of none = of the frame",
        "draws.fragments.killed_early + outside_draws", "depth.early_killed"}},
      {"fragments",
       "killed_late",
       {"fragments killed late of draws and of none = of the frame",
        "draws.fragments.killed_late + outside_draws", "depth.late_killed"}},
      {"fragments",
       "discarded",
       {"fragments discarded of draws and of none = of the frame",
        "draws.fragments.discarded + outside_draws", "rop.discarded"}},
      {"fragments",
       "written",
       {"fragments written of draws and of none = of the frame", "draws.fragments.written + outside_draws",
        "rop.written"}},
      {"texture",
       "samples",
       {"samples for draws and for none = for the frame", "draws.texture.samples + outside_draws",
        "texture.lanes"}},
      {"texture",
       "texels",
       {"texels for draws and for none = for the frame", "draws.texture.texels + outside_draws",
        "texture.texels"}},
      {"texture",
       "cache_misses",
       {"texture misses for draws and for none = for the frame", "draws.texture.cache_misses + outside_draws",
        "texture.cache_misses"}},
      {"bytes",
       "vertex_fetch",
       {"bytes of vertex fetch for draws and for none = for the frame",
        "draws.bytes.vertex_fetch + outside_draws", "vertex_fetch.read_bytes + write_bytes"}},
      {"bytes",
       "texture",
       {"bytes of textures for draws and for none = for the frame", "draws.bytes.texture + outside_draws",
        "texture.read_bytes + write_bytes"}},
      {"bytes",
       "depth",
       {"bytes of depth for draws and for none = for the frame", "draws.bytes.depth + outside_draws",
        "depth.read_bytes + write_bytes"}},
      {"bytes",
       "color",
       {"bytes of colour for draws and for none = for the frame", "draws.bytes.color + outside_draws",
        "rop.read_bytes + write_bytes"}},
      {"bytes",
       "storage",
       {"bytes of storage buffers for draws and for none = for the frame",
        "draws.bytes.storage + outside_draws", "load_store.read_bytes + write_bytes"}},
      {"bytes",
       "memory",
       {"bytes of memory for draws and for none = for the frame", "draws.bytes.memory + outside_draws",
        "memory.read_bytes + write_bytes"}},
      {"", "", {}},
      {"", "", {}},
      {"", "", {}},
      {"", "", {}},
      {"", "", {}},
      {"", "", {}},
      {"", "", {}},
      {"", "", {}},
      {"", "", {}},
      {"",
       "",
       {"cycles of SIMD units for draws and for none = for the frame", "draws.busy.core + outside_draws",
        "core.simd_busy"}},
      {"", "", {}},
      {"", "", {}},
      {"", "", {}},
      {"", "", {}},
      {"",
       "",
       {"indices of draws and of none = of the frame", "draws.indices + outside_draws",
        "vertex_fetch.indices"}},
      {"",
       "",
       {"pieces clipped of draws and of none = of the frame", "draws.pieces + outside_draws",
        "clipper.passed + pieces"}},
      {"",
       "",
       {"samples written of draws and of none = of the frame", "draws.samples_written + outside_draws",
        "rop.samples_written"}},
      {"",
       "",
       {"samples discarded of draws and of none = of the frame", "draws.samples_discarded + outside_draws",
        "rop.samples_discarded"}},
  }};
  return counts;
}

const std::array<DetailCount, kTileCounts>& tile_counts() {
  static const std::array<DetailCount, kTileCounts> counts{{
      {"",
       "fragments_shaded",
       {"fragments of tiles and of none = shaded", "tiles.fragments_shaded + outside_tiles",
        "core.fragments"}},
      {"",
       "fragments_killed_early",
       {"fragments killed early of tiles and of none = of the frame",
        "tiles.fragments_killed_early + outside_tiles", "depth.early_killed"}},
      {"",
       "tiles_hidden",
       {"tiles hidden by Hi-Z of tiles and of none = of the frame", "tiles.tiles_hidden + outside_tiles",
        "coarse_raster.tiles_hidden"}},
      {"",
       "fragments_written",
       {"fragments written of tiles and of none = of the frame", "tiles.fragments_written + outside_tiles",
        "rop.written"}},
      {"",
       "texture_cache_misses",
       {"texture misses of tiles and of none = of the frame", "tiles.texture_cache_misses + outside_tiles",
        "texture.cache_misses"}},
      {"",
       "bytes",
       {"bytes of depth and colour of tiles and of none = of the frame", "tiles.bytes + outside_tiles",
        "depth.read_bytes + write_bytes + rop.read_bytes + write_bytes"}},
  }};
  return counts;
}

DrawLimiter Detail::limiter(const DrawFigures& draw) const {
  const auto most = std::ranges::max_element(draw.work);
  if (most == draw.work.end() || *most <= 0) return {};
  const auto cycles = static_cast<double>(std::max<std::int64_t>(1, draw.in_flight()));
  return {kinds[static_cast<std::size_t>(most - draw.work.begin())], *most, *most / cycles};
}

void Detail::audit(hw::Audit& audit) const {
  std::vector<const DrawFigures*> all{&outside_draws};
  for (const DrawFigures& draw : draws) all.push_back(&draw);
  for (std::size_t i = 0; i < kDrawCounts; ++i) {
    const hw::Law& law = draw_counts()[i].law;
    if (law.text.empty()) continue;
    for (const DrawFigures* draw : all) audit.left(law, draw->counts[i]);
    audit.right(law, draw_totals[i]);
  }
  for (const DrawLaw& l : draw_laws()) {
    const auto differs = [&](const DrawFigures* draw) { return sum(*draw, l.left) != sum(*draw, l.right); };
    audit.both(l.law, static_cast<std::uint64_t>(std::ranges::count_if(all, differs)), 0);
  }
  for (const DrawFigures* draw : all)
    audit.left(kBusyOfDraws, static_cast<std::uint64_t>(
                                 std::accumulate(draw->busy.begin(), draw->busy.end(), std::int64_t{0})));
  audit.right(kBusyOfDraws, static_cast<std::uint64_t>(busy_total));
  for (std::size_t i = 0; i < kTileCounts; ++i) {
    for (const std::uint64_t n : tiles.counts[i]) audit.left(tile_counts()[i].law, n);
    audit.right(tile_counts()[i].law, tile_totals[i]);
  }
}

}  // namespace quadrille::pipeline
