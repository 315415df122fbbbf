#include "pipeline/machine/machine_config.h"

#include <algorithm>

#include "models/base/near_name.h"

namespace quadrille::pipeline {

MachineConfig::MachineConfig() {
  groups_.emplace_back("gpu", &gpu);
#define QUADRILLE_GROUP(name, type, how_often, frames) groups_.emplace_back(#name, &name);
  QUADRILLE_UNITS(QUADRILLE_GROUP)
#undef QUADRILLE_GROUP
#define QUADRILLE_GROUP(name, depth, width, latency, flow, way, ...) \
  groups_.emplace_back("link." #name, &link.name);
  QUADRILLE_LINKS(QUADRILLE_GROUP)
#undef QUADRILLE_GROUP
  base_values_ = values();
}

std::vector<std::string> MachineConfig::values() const {
  std::vector<std::string> all;
  for (const auto& [path, group] : groups_) {
    for (const hw::ParamBase* p : group->params()) all.push_back(p->literal());
  }
  return all;
}

void MachineConfig::become_base(const std::string& name_of_base) {
  name = base_ = name_of_base;
  base_values_ = values();
}

std::vector<MachineConfig::Change> MachineConfig::changes() const {
  std::vector<Change> all;
  std::size_t i = 0;
  for (const auto& [path, group] : groups_) {
    for (const hw::ParamBase* p : group->params()) {
      const std::string value = p->literal(), &before = base_values_[i++];
      if (value != before) all.push_back({fmt::format("{}.{}", path, p->name()), value, before});
    }
  }
  return all;
}

std::string MachineConfig::title() const {
  constexpr std::size_t kMaxListed = 6;
  std::string text = name == base_ ? name : fmt::format("{}: {}", one_line(name), base_);
  const std::vector<Change> changed = changes();
  for (std::size_t i = 0; i < std::min(changed.size(), kMaxListed); ++i)
    text += fmt::format("{}{}={} ({})", i == 0 ? " with " : ", ", changed[i].path, changed[i].value,
                        changed[i].base_value);
  return changed.size() > kMaxListed ? fmt::format("{} and {} more", text, changed.size() - kMaxListed)
                                     : text;
}

namespace {

/// Groups by their names; the links, which are many, as "link.*".
std::string legal_groups(const std::vector<std::pair<std::string, hw::ParamGroup*>>& groups) {
  std::string legal;
  for (const auto& [path, group] : groups) {
    if (!path.starts_with("link.")) legal += path + ", ";
  }
  return legal + "link.*";
}

std::string legal_parameters(const hw::ParamGroup& group) {
  std::string legal;
  for (const hw::ParamBase* p : group.params())
    legal += fmt::format("{}{}", legal.empty() ? "" : ", ", p->name());
  return legal;
}

}  // namespace

std::vector<std::string> MachineConfig::paths() const {
  std::vector<std::string> all;
  for (const auto& [path, group] : groups_) {
    for (const hw::ParamBase* p : group->params()) all.push_back(fmt::format("{}.{}", path, p->name()));
  }
  return all;
}

const hw::ParamBase* MachineConfig::find(std::string_view key) const {
  const std::size_t dot = std::min(key.rfind('.'), key.size());
  const auto group =
      std::ranges::find(groups_, key.substr(0, dot), [](const auto& g) { return std::string_view(g.first); });
  return group == groups_.end() || dot == key.size() ? nullptr : group->second->find(key.substr(dot + 1));
}

void MachineConfig::assign(std::string_view key, std::string_view value, std::string_view where) {
  const std::size_t dot = key.rfind('.');
  const std::string_view group_name = dot == std::string_view::npos ? std::string_view{} : key.substr(0, dot);
  const auto group = std::ranges::find_if(groups_, [&](const auto& g) { return g.first == group_name; });
  hw::ParamBase* const param = group == groups_.end() ? nullptr : group->second->find(key.substr(dot + 1));
  if (param == nullptr) {
    const bool known = group != groups_.end();
    throw user_error("{}: unknown key '{}'; {}: {}{}", where, key,
                     known ? fmt::format("parameters of {}", group_name) : "groups",
                     known ? legal_parameters(*group->second) : legal_groups(groups_),
                     did_you_mean(key, paths()));
  }
  try {
    param->parse(value);
  } catch (const UserError& e) { throw user_error("{}: {}: {}", where, key, e.what()); }
}

void MachineConfig::set(std::string_view key, std::string_view value, std::string_view where) {
  assign(key, value, where);
  given_.emplace(key);
  if (key != "memory.kind") return;
  for (const auto& [path, number] : memory_kind_values(std::string(value))) {
    if (!given_.contains(path)) assign(path, number, where);
  }
}

void MachineConfig::check_memory() const {
  const hw::MemoryChannel::Params& m = memory;
  if (m.banks % m.bank_groups != 0)
    throw user_error("machine: memory.banks ({}) is not a multiple of memory.bank_groups ({})",
                     m.banks.value(), m.bank_groups.value());
  if (m.burst_bytes != 32 && m.burst_bytes != 64 && m.burst_bytes != 128)
    throw user_error("machine: memory.burst_bytes ({}) is none of 32, 64 and 128", m.burst_bytes.value());
  if (m.row_bytes % 128 != 0)
    throw user_error("machine: memory.row_bytes ({}) is not a multiple of 128, a line", m.row_bytes.value());
  if (m.write_low >= m.write_high)
    throw user_error("machine: memory.write_low ({}) is not below memory.write_high ({})",
                     m.write_low.value(), m.write_high.value());
  if (m.refresh == models::DramRefresh::kAllBank && m.t_refi < 2 * m.t_rfc)
    throw user_error(
        "machine: memory.t_rfc ({}) is more than half of memory.t_refi ({}): refresh leaves too little time",
        m.t_rfc.value(), m.t_refi.value());
}

void MachineConfig::check() const {
  // The slower clock's cycle is many of the faster one's, and each costs the simulation time: refreshes, for
  // example.
  constexpr double kFarthestClocks = 1e4;
  const double ratio = gpu.clock_mhz / gpu.memory_mhz;
  if (ratio > kFarthestClocks || ratio < 1 / kFarthestClocks)
    throw user_error("machine: gpu.clock_mhz ({}) and gpu.memory_mhz ({}) are more than {:.0f} times apart",
                     gpu.clock_mhz.value(), gpu.memory_mhz.value(), kFarthestClocks);
  if (gpu.partitions % gpu.engines != 0)
    throw user_error("machine: gpu.partitions ({}) is not a multiple of gpu.engines ({})",
                     gpu.partitions.value(), gpu.engines.value());
  if (&coarse_raster.traversal.value() == &hw::kEdgeWalking &&
      &coarse_raster.order.value() != &models::kScanTileOrder)
    throw user_error(
        "machine: coarse_raster.order is {0}, but coarse_raster.traversal={1} goes by rows: it can be {2}, "
        "or "
        "coarse_raster.traversal={3}",
        coarse_raster.order.value_text(), hw::kEdgeWalking.name, models::kScanTileOrder.name,
        hw::kEdgeFunctions.name);
  check_memory();
  const auto cache = [](std::string_view path, int lines, int ways) {
    if (lines % ways == 0) return;  // whole sets
    const int fewer = lines - lines % ways, more = fewer + ways;
    throw user_error(
        "machine: {0}.cache_lines ({1}) is not a multiple of {0}.cache_ways ({2}): it can be {3}, or give it "
        "other ways",
        path, lines, ways, fewer > 0 ? fmt::format("{} or {}", fewer, more) : fmt::format("{}", more));
  };
  cache("vertex_fetch", vertex_fetch.cache_lines, vertex_fetch.cache_ways);
  cache("texture", texture.cache_lines, texture.cache_ways);
  cache("depth", depth.cache_lines, depth.cache_ways);
  cache("rop", rop.cache_lines, rop.cache_ways);
  cache("l2", l2.cache_lines, l2.cache_ways);
}

}  // namespace quadrille::pipeline
