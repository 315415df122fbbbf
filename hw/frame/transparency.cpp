#include "hw/frame/transparency.h"

#include "models/memory/interleave.h"
#include "models/raster/quad_place.h"

#include <algorithm>
#include <bit>
#include <span>

namespace quadrille::hw {
namespace {

using models::ListHead;
using models::Transparency;
using models::TransparencyNode;

constexpr std::size_t kMostNodes = static_cast<std::size_t>(models::most_layers(Transparency::kAbuffer));

std::array<TransparencyNode, 4> nodes_of(const DrawState& draw, const PassState& pass, const WarpSlot& warp,
                                         int q, const std::array<std::uint8_t, 4>& samples) {
  float rgba[4][4], depth[4];
  for (std::size_t c = 0; c < 4; ++c) std::copy_n(warp.color[0][c].begin() + 4 * q, 4, rgba[c]);
  std::copy_n(warp.depth.begin() + 4 * q, 4, depth);
  return models::make_nodes(draw.blend[0], pass.color[0].format, rgba, depth, samples);
}

std::uint64_t node_address(const PassState& pass, std::uint32_t node) {
  return pass.transparency.pool.surface.base + std::uint64_t{models::kNodeBytes} * node;
}

std::uint64_t head_address(const PassState& pass, std::uint32_t tile_x, std::uint32_t tile_y, int pixel) {
  return pass.transparency.hidden.surface.tile_address(tile_x, tile_y) +
         models::kListHeadBytes * static_cast<std::uint64_t>(pixel);
}

/// The entries of a sample: a plane each.
std::uint64_t entry_address(const PassState& pass, std::uint32_t tile_x, std::uint32_t tile_y, int sample,
                            int layer, int pixel) {
  const auto plane = static_cast<std::uint32_t>(sample * pass.transparency.layers + layer);
  return pass.transparency.hidden.surface.tile_address(tile_x, tile_y, plane) +
         models::kNodeBytes * static_cast<std::uint64_t>(pixel);
}

/// Nodes of a pixel: those of layers nearest first, those of a list newest first until they are sorted.
class PixelNodes {
 public:
  void take_list(const PassState& pass, std::uint32_t tile_x, std::uint32_t tile_y, int pixel,
                 const models::DeviceMemory& memory) {
    count_ = 0;
    for (std::uint32_t at = head_at(pass, tile_x, tile_y, pixel, memory).first; at != 0;
         at = node_[count_ - 1].next)
      node_[count_++] = node_at(pass, at, memory);
  }
  void sort() { models::sort_nodes(std::span(node_).first(count_)); }
  void take_layers(const PassState& pass, std::uint32_t tile_x, std::uint32_t tile_y, int sample, int pixel,
                   const models::DeviceMemory& memory) {
    for (count_ = 0; count_ < static_cast<std::size_t>(pass.transparency.layers); ++count_) {
      node_[count_] = memory.load<TransparencyNode>(
          entry_address(pass, tile_x, tile_y, sample, static_cast<int>(count_), pixel));
      if (!node_[count_].exists()) return;
    }
  }
  [[nodiscard]] std::span<const TransparencyNode> all() const { return std::span(node_).first(count_); }

 private:
  std::array<TransparencyNode, kMostNodes> node_;
  std::size_t count_ = 0;
};

enum class NodeOrder : std::uint8_t { kAsKept, kByDepth };

/// Calls `visit(quad, nodes of its four pixels)` for each quad of a tile; of a k-buffer, of one sample.
template <NodeOrder order, class Visit>
void visit_quads(const PassState& pass, std::uint32_t tile_x, std::uint32_t tile_y, int sample,
                 const models::DeviceMemory& memory, const Visit& visit) {
  std::array<PixelNodes, 4> pixels;
  for (int q = 0; q < models::kTileQuads; ++q) {
    std::array<std::span<const TransparencyNode>, 4> nodes;
    for (std::size_t i = 0; i < 4; ++i) {
      const int pixel = 4 * q + static_cast<int>(i);
      if (pass.transparency.lists()) pixels[i].take_list(pass, tile_x, tile_y, pixel, memory);
      else pixels[i].take_layers(pass, tile_x, tile_y, sample, pixel, memory);
      if (order == NodeOrder::kByDepth && pass.transparency.lists()) pixels[i].sort();
      nodes[i] = pixels[i].all();
    }
    visit(q, nodes);
  }
}

}  // namespace

ListHead head_at(const PassState& pass, std::uint32_t tile_x, std::uint32_t tile_y, int pixel,
                 const models::DeviceMemory& memory) {
  return memory.load<ListHead>(head_address(pass, tile_x, tile_y, pixel));
}

TransparencyNode node_at(const PassState& pass, std::uint32_t number, const models::DeviceMemory& memory) {
  return memory.load<TransparencyNode>(node_address(pass, number - 1));
}

NodePool node_pool_of(const PassState& pass, PartitionId partition, std::uint32_t partitions) {
  const models::SurfaceLayout& heads = pass.transparency.hidden.surface;
  const std::uint32_t tiles = heads.tiles_x * heads.tiles_y;
  const std::uint32_t nodes =
      pass.transparency.pool.surface.tiles_y / tiles * models::kTilePixels;  // a tile's
  NodePool pool;
  for (std::uint32_t y = 0; y < heads.tiles_y; ++y) {
    for (std::uint32_t x = 0; x < heads.tiles_x; ++x) {
      const std::uint32_t owner = models::partition_of(x, y, partitions).index();
      if (owner < partition.index()) pool.next += nodes;
      if (owner <= partition.index()) pool.end += nodes;
    }
  }
  return pool;
}

NodeCounts put_layers(const DrawState& draw, const PassState& pass, const WarpSlot& warp,
                      const QuadOfWarp& quad, models::DeviceMemory& memory) {
  const auto bit = static_cast<std::uint8_t>(1u << quad.sample);
  const std::array<TransparencyNode, 4> nodes = nodes_of(draw, pass, warp, quad.number, {bit, bit, bit, bit});
  NodeCounts counts;
  std::array<TransparencyNode, kMostNodes> entries;
  const auto layers = static_cast<std::size_t>(pass.transparency.layers);
  for (models::LaneMask lanes = quad.lanes; lanes != 0; lanes &= lanes - 1) {
    const int i = std::countr_zero(lanes);
    const auto address = [&](std::size_t layer) {
      return entry_address(pass, quad.place.tile_x, quad.place.tile_y, quad.sample, static_cast<int>(layer),
                           quad.place.first_pixel() + i);
    };
    for (std::size_t l = 0; l < layers; ++l) entries[l] = memory.load<TransparencyNode>(address(l));
    ++counts.offered;
    if (models::insert_node(nodes[static_cast<std::size_t>(i)], std::span(entries).first(layers)))
      ++counts.overflowed;
    for (std::size_t l = 0; l < layers; ++l) memory.store(address(l), entries[l]);
  }
  return counts;
}

AppendPlan plan_append(const PassState& pass, const WarpSlot& warp, const models::DeviceMemory& memory) {
  AppendPlan plan;
  for (models::LaneMask lanes = warp.alive; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    const WarpSlot::Quad& quad = warp.quad[lane / 4];
    const models::QuadPlace place = models::place_of_quad(quad.x, quad.y);
    const std::uint64_t head =
        head_address(pass, place.tile_x, place.tile_y, place.first_pixel() + static_cast<int>(lane % 4));
    const auto earlier =
        std::count(plan.head.begin(), plan.head.begin() + static_cast<std::ptrdiff_t>(lane), head);
    ++plan.counts.offered;
    if (memory.load<ListHead>(head).count + static_cast<std::uint64_t>(earlier) >=
        static_cast<std::uint64_t>(pass.transparency.layers)) {
      ++plan.counts.overflowed;
      continue;
    }
    plan.head[lane] = head;
    ++plan.nodes;
  }
  return plan;
}

void append_nodes(const DrawState& draw, const PassState& pass, const WarpSlot& warp, const AppendPlan& plan,
                  NodePool& pool, models::DeviceMemory& memory) {
  QUADRILLE_CHECK(pool.next + plan.nodes <= pool.end, "{} nodes where the pool ends at {}",
                  pool.next + plan.nodes, pool.end);
  const bool several = draw.samples().count > 1;
  for (int q = 0; q < warp.quads; ++q) {
    if (warp.lanes_of(q) == 0) continue;
    std::array<std::uint8_t, 4> samples{1, 1, 1, 1};
    if (several) std::copy_n(warp.samples.begin() + 4 * q, 4, samples.begin());
    std::array<TransparencyNode, 4> nodes = nodes_of(draw, pass, warp, q, samples);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint64_t address = plan.head[4 * static_cast<std::size_t>(q) + i];
      if (address == 0) continue;
      auto head = memory.load<ListHead>(address);
      nodes[i].next = head.first;
      memory.store(node_address(pass, pool.next), nodes[i]);
      memory.store(address, ListHead{++pool.next, head.count + 1});
    }
  }
}

TileNodes tile_nodes(const PassState& pass, std::uint32_t tile_x, std::uint32_t tile_y,
                     const models::DeviceMemory& memory) {
  TileNodes tile;
  for (int s = 0; s < (pass.transparency.lists() ? 1 : pass.samples); ++s) {
    visit_quads<NodeOrder::kAsKept>(pass, tile_x, tile_y, s, memory, [&](int q, const auto& nodes) {
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t pixel = 4 * static_cast<std::size_t>(q) + i;
        tile.nodes += nodes[i].size();
        auto& most = tile.most[static_cast<std::size_t>(q)];
        most = std::max(most, static_cast<std::uint8_t>(nodes[i].size()));
        for (const TransparencyNode& node : nodes[i])
          for (std::uint32_t sample = 0; sample < static_cast<std::uint32_t>(pass.samples); ++sample)
            if (node.covers(sample)) tile.pixels[sample] |= std::uint64_t{1} << pixel;
      }
    });
  }
  return tile;
}

void compose_tile(const PassState& pass, std::uint32_t tile_x, std::uint32_t tile_y,
                  models::DeviceMemory& memory) {
  const AttachmentState& color = pass.color[0];
  const std::size_t quad_bytes = std::size_t{4} * color.surface.pixel_bytes;
  const auto compose = [&](int q, const auto& nodes, std::uint32_t sample) {
    if (std::ranges::all_of(nodes, [](const auto& n) { return n.empty(); })) return;
    std::byte* const tile =
        memory.write(color.surface.tile_address(tile_x, tile_y, sample), color.surface.plane_bytes()).data();
    models::compose_quad(color.format, nodes, sample, tile + quad_bytes * static_cast<std::size_t>(q));
  };
  const auto samples = static_cast<std::uint32_t>(pass.samples);
  if (pass.transparency.lists()) {
    visit_quads<NodeOrder::kByDepth>(pass, tile_x, tile_y, 0, memory, [&](int q, const auto& nodes) {
      for (std::uint32_t s = 0; s < samples; ++s) compose(q, nodes, s);
    });
    return;
  }
  for (std::uint32_t s = 0; s < samples; ++s)
    visit_quads<NodeOrder::kByDepth>(pass, tile_x, tile_y, static_cast<int>(s), memory,
                                     [&](int q, const auto& nodes) { compose(q, nodes, s); });
}

}  // namespace quadrille::hw
