#include "hw/rop/compose.h"

#include "models/memory/interleave.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw {

namespace {

constexpr std::uint32_t kLineNodes = models::kLineBytes / models::kNodeBytes;

/// Bits 0 to 3 where some pixel of a quad is among these.
bool touches(std::uint64_t pixels, int quad) { return (pixels >> (4 * quad) & 0xfu) != 0; }

}  // namespace

void Compose::begin(PartitionId partition, std::uint32_t partitions, int in_flight) {
  partition_ = partition;
  partitions_ = partitions;
  in_flight_ = static_cast<std::size_t>(in_flight);
  running_ = true;
  stalled_ = false;
  next_ = {};
  find_next();
}

/// Moves `next_` to the first tile of the partition with nodes at or behind it.
void Compose::find_next() {
  const models::SurfaceLayout& layout = pass().transparency.hidden.surface;
  for (; next_.y < layout.tiles_y; ++next_.y, next_.x = 0) {
    for (; next_.x < layout.tiles_x; ++next_.x) {
      if (models::partition_of(next_.x, next_.y, partitions_) != partition_) continue;
      for (std::uint32_t plane = 0; plane < layout.samples; ++plane)
        if (!cache_.is_cleared(buffer_.head_tile(next_.x, next_.y, plane))) return;
    }
  }
}

Tick Compose::tile_next(const Tile& tile, Tick free) const {
  if (!acquired(tile) || tile.unasked != 0) return stalled_ ? kNever : free;
  if (tile.missing > 0 || (complete(tile) && &tile != &tiles_.front())) return kNever;
  return stalled_ ? kNever : std::max(free, tile.ready);
}

Tick Compose::next(Tick free) const {
  if (tiles_.empty() && !has_next()) return cache_.idle() ? free : kNever;
  Tick wake = kNever;
  for (std::size_t i = 0; i < tiles_.size(); ++i) wake = std::min(wake, tile_next(tiles_[i], free));
  const bool room = tiles_.size() < in_flight_ && (tiles_.empty() || acquired(tiles_.back()));
  return has_next() && room && !stalled_ ? free : wake;
}

int Compose::step(Tick now) {
  if (tiles_.empty() && !has_next()) {
    running_ = !cache_.idle();  // lines that writes needed and no one waits for are still to come
    return 0;
  }
  ask(now);
  if (tiles_.empty() || stalled_) return 0;
  const Tile& front = tiles_.front();
  return complete(front) && front.ready <= now ? compose(front) : 0;
}

/// The oldest tile that can go on does; else the next one begins.
void Compose::ask(Tick now) {
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    Tile& tile = tiles_[i];
    if (complete(tile) || tile_next(tile, now) > now) continue;
    return acquired(tile) ? walk(tile, tiles_.number(i), now) : acquire(tile, tiles_.number(i), now);
  }
  if (!has_next() || stalled_ || tiles_.size() == in_flight_) return;
  tiles_.push_back(next_);
  ++next_.x;
  find_next();
  acquire(tiles_.back(), tiles_.newest(), now);
}

void Compose::acquire(Tile& tile, std::uint32_t number, Tick now) {
  for (; !acquired(tile); ++tile.parts, tile.done = {}) {
    const bool hidden = tile.parts < hidden_planes();
    const SurfaceTile part = hidden ? buffer_.head_tile(tile.x, tile.y, tile.parts)
                                    : SurfaceTile{0, tile.x, tile.y, tile.parts - hidden_planes()};
    const AttachmentState& surface = hidden ? pass().transparency.hidden : pass().color[0];
    const SectorWishes wishes{.read = sectors_of(~std::uint64_t{0}, surface.surface.pixel_bytes)};
    if (!cache_.acquire(part, wishes, number | kOwn, tile.missing, tile.done, port_)) {
      stalled_ = !cache_.idle();
      return;
    }
  }
  tile.ready = std::max(tile.ready, now);
}

/// Asks for the line that the next node of a pixel is in, for all pixels whose next nodes are in it.
void Compose::walk(Tile& tile, std::uint32_t number, Tick now) {
  if (tile.unasked == 0) follow(tile);
  if (tile.unasked == 0) {
    tile.ready = std::max(tile.ready, now);
    return;
  }
  const std::uint32_t line =
      (tile.node[static_cast<std::size_t>(std::countr_zero(tile.unasked))] - 1) / kLineNodes;
  std::uint64_t pixels = 0, nodes = 0;
  for (std::uint64_t rest = tile.unasked; rest != 0; rest &= rest - 1) {
    const auto pixel = static_cast<std::size_t>(std::countr_zero(rest));
    const std::uint32_t node = tile.node[pixel] - 1;
    if (node / kLineNodes != line) continue;
    pixels |= std::uint64_t{1} << pixel;
    nodes |= std::uint64_t{1} << node % models::kTilePixels;
  }
  AcquiredLines done;
  const SectorWishes wishes{.read = sectors_of(nodes, models::kNodeBytes)};
  if (!cache_.acquire(buffer_.block_of(line * kLineNodes), wishes, number | kOwn, tile.missing, done,
                      port_)) {
    stalled_ = !cache_.idle();
    return;
  }
  tile.unasked &= ~pixels;
  tile.ready = std::max(tile.ready, now);
}

/// What was asked for is here: heads, or nodes that tell of the next ones.
void Compose::follow(Tile& tile) const {
  const PassState& of = pass();
  if (!tile.walking) tile.left = ~std::uint64_t{0};
  for (std::uint64_t rest = tile.left; rest != 0; rest &= rest - 1) {
    const auto pixel = static_cast<std::size_t>(std::countr_zero(rest));
    tile.node[pixel] = tile.walking ? node_at(of, tile.node[pixel], memory_).next
                                    : head_at(of, tile.x, tile.y, static_cast<int>(pixel), memory_).first;
    if (tile.node[pixel] == 0) tile.left &= ~(std::uint64_t{1} << pixel);
  }
  tile.walking = true;
  tile.unasked = tile.left;
}

int Compose::compose(const Tile& tile) {
  const TileNodes nodes = tile_nodes(pass(), tile.x, tile.y, memory_);
  for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(pass().samples); ++s) {
    if (nodes.pixels[s] == 0) continue;
    // Its lines may have been evicted since, and there may be no place.
    if (!cache_.write({0, tile.x, tile.y, s}, nodes.pixels[s], port_)) {
      stalled_ = !cache_.idle();
      return 0;
    }
  }
  compose_tile(pass(), tile.x, tile.y, memory_);
  cache_.pixels_written();
  TransparencyStats& stats = buffer_.stats();
  stats.composed += nodes.nodes;
  ++stats.tiles;
  stats.a_tile.note(*std::ranges::max_element(nodes.most));
  tiles_.pop_front();
  return turns_of(nodes);
}

int Compose::turns_of(const TileNodes& nodes) const {
  const int path = std::max(1, static_cast<int>(pass().color[0].surface.pixel_bytes) / 4);
  int turns = 0;
  for (int q = 0; q < models::kTileQuads; ++q) {
    int samples = 0;
    for (const std::uint64_t pixels : nodes.pixels) samples += touches(pixels, q) ? 1 : 0;
    const int levels = pass().transparency.lists() ? nodes.most[static_cast<std::size_t>(q)]
                                                   : pass().transparency.layers * samples;
    const int at_once = pass().transparency.lists() ? samples : 1;
    turns += 2 * path * samples + levels * std::max(TransparencyBuffer::kNodeTurns, at_once);
  }
  return turns;
}

}  // namespace quadrille::hw
