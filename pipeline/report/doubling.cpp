/// What doubles each resource, and nothing else (sensitivity.h).
#include "pipeline/report/sensitivity.h"

#include <algorithm>
#include <cmath>

namespace quadrille::pipeline {

namespace {

template <class T>
std::string scaled_within(const hw::Param<T>& p, double value) {
  const T legal = static_cast<T>(
      std::clamp(value, static_cast<double>(p.range().min), static_cast<double>(p.range().max)));
  return fmt::format("{}", legal);
}
std::string scaled(const hw::ParamBase& p, double factor) {
  if (const auto* whole = dynamic_cast<const hw::Param<int>*>(&p))
    return scaled_within(*whole, std::floor(whole->value() * factor));
  const auto* number = dynamic_cast<const hw::Param<double>*>(&p);
  QUADRILLE_CHECK(number != nullptr, "{} is no number", p.name());
  return scaled_within(*number, number->value() * factor);
}

}  // namespace

const std::vector<Doubling>& doublings() {
  static const std::vector<Doubling> all{
      {"command_processor.draw_clk", "draws a cycle", {{"command_processor.draw_clk", 0.5}}},
      {"command_processor.draws_in_flight", "draws under way", {{"command_processor.draws_in_flight", 2}}},
      {"vertex_fetch.rates",
       "indices and attributes a cycle",
       {{"vertex_fetch.indices_per_clk", 2}, {"vertex_fetch.attributes_per_clk", 2}}},
      {"vertex_fetch.batch_slots", "vertex batches under way", {{"vertex_fetch.batch_slots", 2}}},
      {"vertex_fetch.cache_misses",
       "misses of the vertex cache under way",
       {{"vertex_fetch.cache_misses", 2}}},
      {"triangle_setup.triangle_slots", "triangles under way", {{"triangle_setup.triangle_slots", 2}}},
      {"primitive_assembly.rate",
       "triangles assembled a cycle",
       {{"primitive_assembly.triangles_per_clk", 2}}},
      {"clipper.rate",
       "triangles and pieces clipped a cycle",
       {{"clipper.triangles_per_clk", 2}, {"clipper.clip_clk", 0.5}, {"clipper.line_clip_clk", 0.5}}},
      {"triangle_setup.rate",
       "triangles set up a cycle",
       {{"triangle_setup.drawn_per_clk", 2},
        {"triangle_setup.culled_per_clk", 2},
        {"triangle_setup.lines_per_clk", 2},
        {"triangle_setup.points_per_clk", 2}}},
      {"coarse_raster.tests_per_clk", "tiles tested a cycle", {{"coarse_raster.tests_per_clk", 2}}},
      {"coarse_raster.walk",
       "rows walked a cycle",
       {{"coarse_raster.rows_per_clk", 2},
        {"coarse_raster.segments_per_clk", 2},
        {"coarse_raster.walk_setup_clk", 0.5}}},
      {"fine_raster.quads_per_clk", "quads rasterised a cycle", {{"fine_raster.quads_per_clk", 2}}},
      {"depth.quads_per_clk", "quads a cycle of the depth units", {{"depth.quads_per_clk", 2}}},
      {"depth.tiles_in_flight", "tiles that wait for their depths", {{"depth.tiles_in_flight", 2}}},
      {"depth.cache_misses", "misses of the depth caches under way", {{"depth.cache_misses", 2}}},
      {"warp_packer.quads_per_clk", "quads packed a cycle", {{"warp_packer.quads_per_clk", 2}}},
      {"warp_packer.warp_slots", "fragment warps under way", {{"warp_packer.warp_slots", 2}}},
      {"core.issue", "plain and special lanes of the SIMDs", {{"core.simd_lanes", 2}, {"core.sfu_lanes", 2}}},
      {"core.export", "bytes of colours that leave a core a cycle", {{"core.export_bytes_per_clk", 2}}},
      {"core.warp_slots", "warps resident on a core", {{"core.warp_slots", 2}}},
      {"core.register_rows", "registers of a core", {{"core.register_rows", 2}}},
      {"texture.address",
       "quads addressed and tags looked up a cycle",
       {{"texture.address_quads_per_clk", 2}, {"texture.tags_per_clk", 2}}},
      {"texture.filter", "bilinear quads a cycle", {{"texture.filter_quads_per_clk", 2}}},
      {"texture.decode", "blocks of textures decoded a cycle", {{"texture.decode_blocks_per_clk", 2}}},
      {"texture.groups_in_flight", "request groups of a texture unit", {{"texture.groups_in_flight", 2}}},
      {"texture.cache_misses", "misses of the texture caches under way", {{"texture.cache_misses", 2}}},
      {"rop.quads_per_clk", "quads a cycle of the ROPs", {{"rop.quads_per_clk", 2}}},
      {"rop.warps_in_flight", "warps that wait for their colours", {{"rop.warps_in_flight", 2}}},
      {"rop.cache_misses", "misses of the colour caches under way", {{"rop.cache_misses", 2}}},
      {"scan_out.lines_in_flight", "lines that scan-out has under way", {{"scan_out.lines_in_flight", 2}}},
      {"l2.cache_misses", "misses of the L2 cache under way", {{"l2.cache_misses", 2}}},
      {"memory.bus",
       "width of the data bus",
       {{"memory.t_burst", 0.5}, {"memory.t_ccd_s", 0.5}, {"memory.t_ccd_l", 0.5}}},
      {"memory.rows",
       "speed of rows, turns and refresh",
       {{"memory.t_rcd", 0.5},
        {"memory.t_rcd_wr", 0.5},
        {"memory.t_rp", 0.5},
        {"memory.t_ras", 0.5},
        {"memory.t_rc", 0.5},
        {"memory.t_rrd_s", 0.5},
        {"memory.t_rrd_l", 0.5},
        {"memory.t_faw", 0.5},
        {"memory.t_wr", 0.5},
        {"memory.t_wtr_s", 0.5},
        {"memory.t_wtr_l", 0.5},
        {"memory.t_rtp", 0.5},
        {"memory.t_rtw", 0.5},
        {"memory.t_rfc", 0.5},
        {"memory.t_rfc_pb", 0.5}}},
      {"memory.queue_depth", "reads that a controller holds", {{"memory.queue_depth", 2}}},
      {"memory.write_queue", "writes that a controller holds", {{"memory.write_queue", 2}}}};
  return all;
}

const Doubling* doubling_of(std::string_view resource) {
  const auto found = std::ranges::find(doublings(), resource,
                                       [](const Doubling& d) { return std::string_view(d.resource); });
  return found == doublings().end() ? nullptr : &*found;
}

std::vector<std::string> settings_of(const Doubling& doubling, const MachineConfig& machine) {
  std::vector<std::string> settings;
  for (const DoublingStep& step : doubling.steps) {
    const std::string path = step.parameter;
    const std::size_t dot = path.rfind('.');
    for (const auto& [name, group] : machine.groups()) {
      if (name != path.substr(0, dot)) continue;
      const hw::ParamBase* p = group->find(path.substr(dot + 1));
      QUADRILLE_CHECK(p != nullptr, "no parameter {}", path);
      if (const std::string value = scaled(*p, step.factor); value != p->value_text())
        settings.push_back(fmt::format("{}={}", path, value));
    }
  }
  return settings;
}

}  // namespace quadrille::pipeline
