#include "hw/rop/resolve.h"

#include "models/memory/interleave.h"
#include "models/rop/resolve.h"

#include <algorithm>
#include <span>

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
  if (!tiles_.empty() && !acquired(tiles_[tiles_.size() - 1])) return true;
  return next_.color < pass_->colors && tiles_.size() < in_flight_;
}

bool Resolve::head_ready() const {
  return !tiles_.empty() && acquired(tiles_.front()) && tiles_.front().missing == 0;
}

Tick Resolve::next(Tick free) const {
  if (can_ask() || (tiles_.empty() && next_.color == pass_->colors)) return free;
  return head_ready() && !stalled_ ? std::max(free, tiles_.front().ready) : kNever;
}

bool Resolve::is_cleared(const Tile& tile) const {
  for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(pass_->samples); ++s)
    if (!cache_.is_cleared({tile.color, tile.x, tile.y, s})) return false;
  return true;
}

void Resolve::ask(Tick now) {
  if (tiles_.empty() || acquired(tiles_.back())) {
    tiles_.push_back(next_);
    ++next_.x;
    find_next();
  }
  Tile& tile = tiles_.back();
  const auto samples = static_cast<std::uint32_t>(pass_->samples);
  for (; !acquired(tile); ++tile.parts, tile.done = 0) {
    const bool reads = tile.parts < samples;
    const SurfaceTile part = reads ? SurfaceTile{tile.color, tile.x, tile.y, tile.parts} : target_of(tile);
    const SectorWishes wishes = reads ? SectorWishes{.read = 0xff} : SectorWishes{.write = 0xff};
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
  if (can_ask() && tiles_.empty() && is_cleared(next_)) {
    compute(next_);
    cache_.clear(target_of(next_));
    done = {1, 1, 0};
    ++next_.x;
    find_next();
  } else {
    if (can_ask()) ask(now);
    if (head_ready() && tiles_.front().ready <= now && resolve(tiles_.front())) {
      tiles_.pop_front();
      done = {1, 0, models::kTileQuads * (pass_->samples + 1)};
    }
  }
  return done;
}

bool Resolve::resolve(const Tile& tile) {
  SectorPixels all;
  all.fill(0xff);
  if (!cache_.write(target_of(tile), all, port_)) {  // its lines were evicted since, and there is no place
    stalled_ = !cache_.idle();
    return false;
  }
  compute(tile);
  return true;
}

void Resolve::compute(const Tile& tile) {
  const models::SurfaceLayout& from = pass_->color[tile.color].surface;
  const models::SurfaceLayout& to = pass_->resolve[tile.color].surface;
  const std::size_t bytes = std::size_t{models::kTileBytes} * from.samples;
  const auto* const planes =
      reinterpret_cast<const std::uint32_t*>(memory_.read(from.tile_address(tile.x, tile.y), bytes).data());
  auto* const pixels = reinterpret_cast<std::uint32_t*>(
      memory_.write(to.tile_address(tile.x, tile.y), models::kTileBytes).data());
  models::resolve_tile(pass_->color[tile.color].format, std::span(planes, bytes / sizeof(std::uint32_t)),
                       pixels);
}

}  // namespace quadrille::hw
