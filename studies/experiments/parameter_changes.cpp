#include "studies/experiments/parameter_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "studies/experiments/experiment.h"

namespace quadrille::studies::experiments {
namespace {

using Settings = std::vector<std::string>;

struct Ground {
  std::string name;
  Settings settings;
};

const Settings kNarrowMemory{"gpu.channels=1",   "memory.t_burst=8",   "memory.t_ccd_s=8",
                             "memory.t_ccd_l=8", "l2.cache_lines=256", "gpu.cores=8"};
/// The front passes four triangles a cycle, on links as wide.
const Settings kFastGeometry{"gpu.cores=16",
                             "gpu.channels=8",
                             "command_processor.draw_clk=1",
                             "vertex_fetch.indices_per_clk=16",
                             "vertex_fetch.attributes_per_clk=16",
                             "vertex_fetch.batch_slots=64",
                             "vertex_fetch.cache_lines=1024",
                             "vertex_fetch.cache_misses=256",
                             "primitive_assembly.triangles_per_clk=4",
                             "clipper.triangles_per_clk=4",
                             "triangle_setup.drawn_per_clk=4",
                             "triangle_setup.culled_per_clk=4",
                             "triangle_setup.lines_per_clk=4",
                             "triangle_setup.points_per_clk=4",
                             "coarse_raster.tests_per_clk=16",
                             "coarse_raster.tiles_per_clk=4",
                             "fine_raster.quads_per_clk=16",
                             "fine_raster.tiles_per_clk=4",
                             "link.fetch_to_assembly.width=4",
                             "link.core_to_assembly.width=4",
                             "link.assembly_to_clipper.width=4",
                             "link.clipper_to_setup.width=4",
                             "link.setup_to_coarse.width=4",
                             "link.coarse_to_fine.width=4",
                             "link.fine_to_depth.width=4"};

const std::vector<Ground>& common_grounds() {
  static const std::vector<Ground> all{
      {"default", {}}, {"narrow memory", kNarrowMemory}, {"many cores", {"gpu.cores=16", "gpu.channels=4"}}};
  return all;
}

Settings with(Settings settings, const Settings& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

const Settings kFastWalking = with(kFastGeometry, {"coarse_raster.traversal=edge_walking"});

/// Where a parameter must show: by its path, or by the group that it ends with.
struct Tight {
  std::string_view path;
  Settings settings;
};

const std::vector<Tight>& tight_grounds() {
  static const std::vector<Tight> all{
      {"memory.page_idle", {"memory.page=adaptive"}},
      {"coarse_raster.hiz_min", with(kNarrowMemory, {"depth.cache_lines=8", "depth.cache_ways=4"})},
      {"memory.in_order_ahead", {"memory.scheduler=in_order"}},
      {"memory.t_rfc", {"memory.refresh=all_bank"}},
      {"memory.t_rtrs", with(kNarrowMemory, {"memory.ranks=2"})},
      {"memory.age_cap", with(kNarrowMemory, {"memory.age_cap=50"})},
      {"memory.", with(kNarrowMemory, {"memory.banks=4", "memory.bank_groups=2", "memory.queue_depth=8",
                                       "memory.write_queue=8"})},
      {"l2.write_back_lines", with(kNarrowMemory, {"l2.write_back=row"})},
      {"l2.", with(kNarrowMemory, {"l2.cache_lines=32", "l2.cache_ways=2", "l2.cache_misses=4"})},
      {"texture.",
       {"texture.cache_lines=8", "texture.cache_ways=2", "texture.cache_misses=1",
        "texture.groups_in_flight=2"}},
      {"load_store.",
       {"load_store.cache_lines=8", "load_store.cache_ways=2", "load_store.cache_misses=1",
        "load_store.groups_in_flight=2", "load_store.requests_queued=2"}},
      {"rop.half_blend_turns", {"rop.quads_per_clk=1", "gpu.cores=16"}},
      {"rop.float_blend_turns", {"rop.quads_per_clk=1", "gpu.cores=16"}},
      {"core.export_bytes_per_clk", {"core.export_bytes_per_clk=4"}},
      {"rop.", with(kNarrowMemory, {"rop.cache_lines=8", "rop.cache_ways=2", "rop.cache_misses=1",
                                    "rop.warps_in_flight=2"})},
      {"depth.", with(kNarrowMemory, {"depth.cache_lines=8", "depth.cache_ways=2", "depth.cache_misses=1",
                                      "depth.tiles_in_flight=2"})},
      {"vertex_fetch.reuse_entries", {"vertex_fetch.reuse=fifo"}},
      {"vertex_fetch.range_primitives", with(kFastGeometry, {"gpu.front_ends=2"})},
      {"work_distributor.block_tiles", {"work_distributor.policy=tile"}},
      {"clipper.", kFastGeometry},
      {"primitive_assembly.", kFastGeometry},
      {"triangle_setup.", kFastGeometry},
      {"coarse_raster.rows_per_clk", kFastWalking},
      {"coarse_raster.segments_per_clk", kFastWalking},
      {"coarse_raster.walk_setup_clk", kFastWalking},
      {"coarse_raster.", kFastGeometry},
      {"fine_raster.", kFastGeometry},
  };
  return all;
}

/// A link of one place passes a token in as many cycles as its latencies take together; its width shows when
/// both its ends are fast.
Settings tight_link(const std::string& path) {
  const std::string link = path.substr(0, path.rfind('.'));
  if (path.ends_with(".width")) return with(kFastGeometry, {link + ".width=4", link + ".depth=64"});
  if (path.ends_with(".depth"))
    return {link + ".depth=1", link + ".latency=256", link + ".credit_latency=256"};
  return {link + ".depth=1"};
}

Settings tight_settings(const std::string& path) {
  if (path.starts_with("link.")) return tight_link(path);
  const auto found =
      std::ranges::find_if(tight_grounds(), [&](const Tight& tight) { return path.starts_with(tight.path); });
  return found == tight_grounds().end() ? Settings{} : found->settings;
}

std::vector<std::string> values_of(const hw::ParamBase& p, const std::vector<double>& factors) {
  std::vector<std::string> values;
  const auto numbers = [&](double value, double least, double most, bool whole) {
    for (const double factor : factors) {
      double other = std::clamp(value == 0 ? (factor > 1 ? factor * 4 : 0) : value * factor, least, most);
      if (whole) other = factor < 1 ? std::floor(other) : std::ceil(other);
      const std::string text = whole ? fmt::format("{:.0f}", other) : fmt::format("{}", other);
      if (other != value && std::ranges::find(values, text) == values.end()) values.push_back(text);
    }
  };
  if (const auto* n = dynamic_cast<const hw::Param<int>*>(&p))
    numbers(n->value(), n->range().min, n->range().max, true);
  if (const auto* d = dynamic_cast<const hw::Param<double>*>(&p))
    numbers(d->value(), d->range().min, d->range().max, false);
  for (const std::string_view word : p.words())
    if (word != p.value_text()) values.emplace_back(word);
  return values;
}

bool refused(const Change& c) {
  try {
    pipeline::MachineConfig machine;
    apply_settings(machine, with(c.settings, {c.path + "=" + c.value}));
    machine.check();
    return false;
  } catch (const UserError&) { return true; }
}

bool is_more(const hw::ParamBase& p, const std::string& value) {
  return p.words().empty() ? std::stod(value) > std::stod(p.value_text()) : value == "true";
}

void add_changes(std::vector<Change>& changes, const Ground& ground, const std::string& path,
                 const hw::ParamBase& p, const std::vector<double>& factors) {
  if (p.effect() == hw::Effect::kPicture) return;
  for (const std::string& value : values_of(p, factors)) {
    Change change{path, value, ground.name, ground.settings, p.effect(), is_more(p, value)};
    if (!refused(change)) changes.push_back(std::move(change));
  }
}

/// The parameters of a ground, by path.
template <class Visit>
void visit_parameters(const Ground& ground, const Visit& visit) {
  pipeline::MachineConfig machine;
  apply_settings(machine, ground.settings);
  for (const auto& [group, params] : machine.groups())
    for (const hw::ParamBase* p : params->params()) visit(group + "." + std::string(p->name()), *p);
}

/// Links are two thirds of all parameters: they are tried on the default machine alone, but for widths that
/// do nothing there.
bool is_tried(const Ground& ground, const std::string& path) {
  return ground.settings.empty() || !path.starts_with("link.");
}

}  // namespace

std::vector<Change> near_changes() {
  std::vector<Change> changes;
  for (const Ground& ground : common_grounds())
    visit_parameters(ground, [&](const std::string& path, const hw::ParamBase& p) {
      if (is_tried(ground, path)) add_changes(changes, ground, path, p, {0.5, 2.0});
    });
  return changes;
}

std::vector<Change> far_changes(const std::vector<std::string>& paths) {
  std::vector<Change> changes;
  const auto add = [&](const Ground& ground, const std::string& wanted, const std::vector<double>& factors) {
    visit_parameters(ground, [&](const std::string& path, const hw::ParamBase& p) {
      if (path == wanted) add_changes(changes, ground, path, p, factors);
    });
  };
  for (const std::string& path : paths) {
    for (const Ground& ground : common_grounds())
      if (is_tried(ground, path) || path.ends_with(".width")) add(ground, path, {0.125, 8.0});
    add({"tight", tight_settings(path)}, path, {0.125, 0.5, 2.0, 8.0, 512.0});
  }
  return changes;
}

}  // namespace quadrille::studies::experiments
