#include "hw/rop/resolve.h"

#include "hw/frame/fragment_output.h"
#include "models/memory/interleave.h"

#include <algorithm>

namespace quadrille::hw {

void Resolve::begin(const PassState& pass, PartitionId partition, std::uint32_t partitions, int in_flight) {
  pass_ = &pass;
  partition_ = partition;
  partitions_ = partitions;
  in_flight_ = static_cast<std::size_t>(in_flight);
  running_ = true;
  stalled_ = false;
  for (std::size_t c = 0; c < pass.colors; ++c)
    if ((pass.resolved >> c & 1u) != 0) surface_[c] = cache_.add_surface(pass.resolve[c]);
  next_ = {};
  find_next();
}

/// Moves `next_` to the first tile of the partition at or behind it.
void Resolve::find_next() {
  for (; next_.color < pass_->colors; ++next_.color, next_.x = next_.y = 0) {
    if ((pass_->resolved >> next_.color & 1u) == 0) continue;
    const models::SurfaceLayout& layout = pass_->color[next_.color].surface;
    for (; next_.y < layout.tiles_y; ++next_.y, next_.x = 0)
      for (; next_.x < layout.tiles_x; ++next_.x)
        if (models::partition_of(next_.x, next_.y, partitions_) == partition_) return;
  }
}

bool Resolve::can_ask() const {
  if (stalled_) return false;
  if (!newest_acquired()) return true;
  return next_.color < pass_->colors && tiles_.size() < in_flight_;
}

bool Resolve::head_ready() const {
  return !tiles_.empty() && acquired(tiles_.front()) && tiles_.front().missing == 0;
}

Tick Resolve::next(Tick free) const {
  if (can_ask() || next_is_cleared() || (tiles_.empty() && next_.color == pass_->colors)) return free;
  return head_ready() && !stalled_ ? std::max(free, tiles_.front().ready) : kNever;
}

bool Resolve::next_is_cleared() const {
  if (next_.color == pass_->colors || !newest_acquired()) return false;
  for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(pass_->samples); ++s)
    if (!cache_.is_cleared({next_.color, next_.x, next_.y, s})) return false;
  return true;
}

void Resolve::advance() {
  ++next_.x;
  find_next();
}

void Resolve::ask(Tick now) {
  if (newest_acquired()) {
    tiles_.push_back(next_);
    advance();
  }
  Tile& tile = tiles_.back();
  const auto samples = static_cast<std::uint32_t>(pass_->samples);
  for (; !acquired(tile); ++tile.parts, tile.done = {}) {
    const bool reads = tile.parts < samples;
    const SurfaceTile part = reads ? SurfaceTile{tile.color, tile.x, tile.y, tile.parts} : target_of(tile);
    const std::uint32_t all = sectors_of(~std::uint64_t{0}, pass_->color[tile.color].surface.pixel_bytes);
    const SectorWishes wishes = reads ? SectorWishes{.read = all} : SectorWishes{.write = all};
    if (!cache_.acquire(part, wishes, tiles_.newest() | kOwn, tile.missing, tile.done, port_)) {
      stalled_ = !cache_.idle();
      return;
    }
  }
  tile.ready = std::max(tile.ready, now);
}

Resolve::Done Resolve::step(Tick now) {
  Done done;
  if (tiles_.empty() && next_.color == pass_->colors) {
    running_ = false;
    return done;
  }
  if (next_is_cleared()) {
    resolve_tile(*pass_, next_.color, next_.x, next_.y, memory_);
    cache_.clear(target_of(next_));
    ++done.tiles;
    ++done.cleared;
    advance();
  } else if (can_ask()) {
    ask(now);
  }
  if (!head_ready() || tiles_.front().ready > now) return done;
  const std::size_t color = tiles_.front().color;
  if (resolve(tiles_.front())) {
    const int words = std::max(1, static_cast<int>(pass_->color[color].surface.pixel_bytes) / 4);
    tiles_.pop_front();
    ++done.tiles;
    done.quads = models::kTileQuads * (pass_->samples + 1) * words;
  }
  return done;
}

bool Resolve::resolve(const Tile& tile) {
  if (!cache_.write(target_of(tile), ~std::uint64_t{0},
                    port_)) {  // its lines were evicted since, and there is no place
    stalled_ = !cache_.idle();
    return false;
  }
  resolve_tile(*pass_, tile.color, tile.x, tile.y, memory_);
  cache_.pixels_written();
  return true;
}

}  // namespace quadrille::hw
