#include "pipeline/driver/transparency.h"

#include "models/rop/transparency.h"

#include <algorithm>

namespace quadrille::pipeline {
namespace {

hw::AttachmentState hidden(const models::SurfaceLayout& surface) {
  hw::AttachmentState state;
  state.surface = surface;
  state.load = models::LoadOp::kClear;
  state.store = models::StoreOp::kDiscard;
  state.read_later = false;
  state.encodes = false;
  return state;
}

/// Nodes that a pixel can come to have: one of each triangle at most, or of each of its edges or corners;
/// and as many of each sample where these are shaded by themselves.
std::uint32_t most_nodes(std::span<const hw::DrawState> draws, std::uint64_t layers) {
  std::uint64_t pieces = 0;
  for (const hw::DrawState& d : draws) {
    if (!d.order_independent) continue;
    const bool whole = d.primitives.pieces() == d.primitives.assembled;
    const auto each = static_cast<std::uint64_t>((whole ? 1 : 3) * (d.by_sample ? d.samples().count : 1));
    pieces += each * d.count * d.instances;  // no fewer vertices than primitives
  }
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(pieces, 1, layers));
}

}  // namespace

void place_transparency(const models::TransparencyState& wanted, std::span<const hw::DrawState> draws,
                        DeviceResources& resources, hw::PassState& pass) {
  if (std::ranges::none_of(draws, &hw::DrawState::order_independent)) return;
  hw::TransparencyPass& out = pass.transparency;
  out.mode = wanted.mode;
  out.layers = wanted.layers;
  if (!out.lists()) {
    const auto planes = static_cast<std::uint32_t>(pass.samples) * wanted.layers;
    out.hidden = hidden(
        resources.surface(models::surface_layout(pass.width, pass.height, planes, models::kNodeBytes)));
    return;
  }
  out.hidden =
      hidden(resources.surface(models::surface_layout(pass.width, pass.height, 1, models::kListHeadBytes)));
  const models::SurfaceLayout& heads = out.hidden.surface;
  const std::uint32_t blocks = heads.tiles_x * heads.tiles_y * most_nodes(draws, wanted.layers);
  out.pool = hidden(resources.surface(
      models::surface_layout(models::kTileSize, models::kTileSize * blocks, 1, models::kNodeBytes)));
}

}  // namespace quadrille::pipeline
