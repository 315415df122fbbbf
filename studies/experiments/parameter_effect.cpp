#include "studies/experiments/parameter_effect.h"

#include <algorithm>
#include <array>
#include <utility>

namespace quadrille::studies::experiments {

namespace {

using enum Effect;

/// Parameters by name, before the endings below.
constexpr std::pair<std::string_view, Effect> kNamed[] = {
    {"gpu.memory_mib", kNeutral},
    {"gpu.subpixel_bits", kPicture},
    {"gpu.subtexel_bits", kPicture},
    {"gpu.lod_bits", kPicture},
    {"gpu.linear_log2", kPicture},
    {"gpu.clock_mhz", kTradeOff},   // in cycles of that clock, memory gets slower
    {"gpu.partitions", kTradeOff},  // each packs its own warps
    {"vertex_fetch.reuse", kTradeOff},
    {"vertex_fetch.batch_vertices", kTradeOff},
    {"vertex_fetch.batch_triangles", kTradeOff},
    {"vertex_fetch.reuse_entries", kTradeOff},
    {"coarse_raster.hiz", kFaster},
    {"coarse_raster.reports", kTradeOff},
    {"warp_packer.patience_clk", kTradeOff},
    {"work_distributor.policy", kTradeOff},
    {"work_distributor.block_tiles", kTradeOff},
    {"core.scheduler", kTradeOff},
    {"l2.write_back", kTradeOff},
    {"l2.write_back_lines", kTradeOff},
    {"memory.kind", kTradeOff},
    {"memory.pseudo_channels", kFaster},
    {"memory.ranks", kTradeOff},  // more banks, and turns between ranks
    {"memory.bank_groups", kTradeOff},
    {"memory.rows", kNeutral},
    {"memory.row_bytes", kTradeOff},
    {"memory.burst_bytes", kTradeOff},  // a wider bus, and more that was not asked for
    {"memory.refresh", kTradeOff},
    {"memory.t_refi", kFaster},
    {"memory.refresh_postpone", kTradeOff},
    {"memory.separate_buses", kFaster},
    {"memory.shared_commands", kSlower},
    {"memory.mapping", kTradeOff},
    {"memory.bank_hash", kTradeOff},
    {"memory.scheduler", kTradeOff},
    {"memory.in_order_ahead", kNeutral},
    {"memory.age_cap", kTradeOff},
    {"memory.write_drain", kTradeOff},
    {"memory.write_high", kTradeOff},
    {"memory.write_low", kTradeOff},
    {"memory.page", kTradeOff},
    {"memory.page_idle", kNeutral},
};

/// More of what ends so is slower; of all others faster.
constexpr std::array<std::string_view, 2> kSlowerEndings{"_clk", "latency"};

}  // namespace

Effect effect_of(std::string_view path) {
  const auto named = std::ranges::find(kNamed, path, &std::pair<std::string_view, Effect>::first);
  if (named != std::end(kNamed)) return named->second;
  if (path.ends_with("_per_clk")) return kFaster;
  if (path.starts_with("memory.t_") || path == "memory.act_slots" || path == "memory.column_slots") return kSlower;
  return std::ranges::any_of(kSlowerEndings, [&](std::string_view end) { return path.ends_with(end); }) ? kSlower : kFaster;
}

std::string_view effect_name(Effect effect) {
  switch (effect) {
    case kFaster: return "faster";
    case kSlower: return "slower";
    case kTradeOff: return "trade-off";
    case kPicture: return "picture";
    case kNeutral: return "neutral";
  }
  return "";
}

}  // namespace quadrille::studies::experiments
