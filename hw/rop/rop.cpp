#include "hw/rop/rop.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"
#include "hw/rop/touched_tiles.h"

#include <algorithm>
#include <bit>
#include <span>

namespace quadrille::hw {

Rop::Rop(sc_core::sc_module_name name, const UnitContext& context, const Params& params, WarpStore& warps)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      device_(context.memory),
      warps_(warps),
      partition_(context.partition()),
      partitions_(static_cast<std::uint32_t>(context.machine.partitions)),
      port_(*this, stats_, context.machine.channels),
      cache_(stats_, params.cache_lines, params.cache_ways, params.cache_misses, context.memory,
             surface_writer(SurfaceKind::kColor, context.partition()),
             SurfaceCompression::of(params.compression)),
      shaded_(static_cast<std::size_t>(warps.size()), false),
      transparency_(stats_, context.memory, cache_, port_),
      compose_(context.memory, cache_, port_, transparency_),
      resolve_(context.memory, cache_, port_) {
  add_initiation_rate("quads_per_clk");
  add_places("warps_in_flight",
             [this] { return acquired_ >= static_cast<std::size_t>(params_.warps_in_flight.value()); });
  add_memory_places("cache_misses", [this] { return cache_.full(); });
  for (int i = 0; i < context.machine.cores; ++i) done_in.add(*this, fmt::format("done_in_{}", i).c_str());
}

std::string Rop::state_text() const {
  return fmt::format("{} entries in its reorder buffer, {} tested, {} with colours", entries_.size(),
                     awaiting_, acquired_);
}

// --- When ---

Wake Rop::test_wake() const {
  if (tested_ >= entries_.size()) return Wake::never(order_in);
  const Entry& entry = entries_[tested_];
  if (entry.token.kind != TokenKind::kWork) return Wake(test_free_);
  if (!shaded_[entry.token.slot.index()]) return Wake::never(done_in[0]);
  return warps_[entry.token.slot].late ? Wake(test_free_).output(late_out) : Wake(test_free_);
}

Wake Rop::acquire_wake() const {
  if (acquired_ >= awaiting_ || acquired_ >= static_cast<std::size_t>(params_.warps_in_flight.value()))
    return Wake(kNever);
  // What follows a pass's begin must find its surface set up.
  if (acquired_ > 0 && entries_[acquired_ - 1].token.kind == TokenKind::kPassBegin) return Wake(kNever);
  return stalled_ ? Wake::never(port_.response_in[0]) : Wake(acquire_free_);
}

Wake Rop::outputs_of(const Entry& entry, Wake wake) const {
  switch (entry.token.kind) {
    case TokenKind::kWork:
      wake.output(release_out);
      return entry.token.sync != 0 ? wake.output(sync_out) : wake;
    case TokenKind::kSync: return wake.output(sync_out);
    case TokenKind::kDrawEnd: return wake.output(retire_out);
    case TokenKind::kPassEnd: return wake.output(late_out);
    case TokenKind::kPassBegin:
    case TokenKind::kBatchEnd:
    case TokenKind::kRangeEnd: return wake;
  }
  return wake;
}

Wake Rop::retire_wake() const {
  if (flush_.done()) return Wake(free_).output(retire_out);
  if (compose_.running()) return end_wake(compose_.next(free_));
  if (resolve_.running()) return end_wake(resolve_.next(free_));
  if (depth_flushes_ || flush_.running()) return Wake(kNever);
  if (entries_.empty() || acquired_ == 0) return Wake(kNever);
  const Entry& head = entries_.front();
  if (head.missing > 0 || claim_stalled_) return Wake::never(port_.response_in[0]);
  return outputs_of(head, Wake(std::max(free_, head.ready)));
}

Wake Rop::end_wake(Tick at) const { return at == kNever ? Wake::never(port_.response_in[0]) : Wake(at); }

Wake Rop::next() const {
  Wake wake = Wake::sooner(retire_wake(), acquire_wake());
  wake = Wake::sooner(wake, test_wake());
  wake = Wake::sooner(wake, Wake().input(late_in));
  if (entries_.size() < warps_.size()) wake = Wake::sooner(wake, Wake().input(order_in));
  wake = Wake::sooner(wake, done_in.earliest(Wake().output(load_out)));
  wake = Wake::sooner(wake, port_.receive_wake());
  if (!port_.queue_empty()) wake = Wake::sooner(wake, port_.send_wake());
  return wake;
}

// --- What ---

void Rop::act(Tick now) {
  take_inputs(now);
  if (depth_flushed_ && cache_.idle()) end_pass();
  if (test_wake().at() <= now) test(now);
  if (acquire_wake().at() <= now) acquire(now);
  if (retire_wake().at() <= now) retire(now);
  port_.send(now);
  if (flush_.advance()) free_ = after(now, 1);
}

void Rop::take_inputs(Tick now) {
  port_.receive(now, [&](const MemoryResponse& answer) {
    if (flush_.take(answer)) return;
    stalled_ = false;
    claim_stalled_ = false;
    compose_.wake();
    cache_.fill(answer, [&](std::uint32_t number) {
      const bool own = compose_.running() ? compose_.answer(number, now) : resolve_.answer(number, now);
      if (!own) entries_.answer(number, now);
    });
  });
  done_in.visit_holding(0, [&](std::size_t core, FifoIn<FragmentDoneToken>& in) {
    for (; in.ready_at(now) && load_out.room_at(now);
         load_out.push(now, {static_cast<std::uint32_t>(core), 0}))
      shaded_[in.pop(now).slot.index()] = true;
    return false;
  });
  while (late_in.ready_at(now)) take_late(now);
  while (entries_.size() < warps_.size() && order_in.ready_at(now)) entries_.push_back({order_in.pop(now)});
}

void Rop::take_late(Tick now) {
  if (late_in.pop(now).kind == TokenKind::kPassEnd) {
    depth_flushed_ = true;
    return;
  }
  entries_[awaiting_].stage = Stage::kTested;
  while (awaiting_ < tested_ && entries_[awaiting_].stage == Stage::kTested) ++awaiting_;
}

void Rop::end_pass() {
  depth_flushes_ = depth_flushed_ = false;
  const PassState& pass = frame_.pass(pass_);
  if (pass.transparency.on()) compose_.begin(partition_, partitions_, params_.warps_in_flight);
  else begin_resolve();
}

void Rop::compose(Tick now) {
  stats_.working_for(kNoDraw);
  const int turns = compose_.step(now);
  if (!compose_.running()) return begin_resolve();
  const int cycles = std::max(1, (turns + params_.quads_per_clk - 1) / params_.quads_per_clk);
  free_ = after(now, cycles);
  occupy(now, cycles);
}

void Rop::begin_resolve() {
  const PassState& pass = frame_.pass(pass_);
  if (pass.resolved != 0) resolve_.begin(pass, partition_, partitions_, params_.warps_in_flight);
  else begin_flush();
}

void Rop::begin_flush() {
  stats_.working_for(kNoDraw);
  cache_.flush(port_);
  flush_.begin();
}

void Rop::resolve(Tick now) {
  stats_.working_for(kNoDraw);
  const Resolve::Done done = resolve_.step(now);
  stats_.resolved += static_cast<std::uint64_t>(done.tiles);
  stats_.resolved_clear += static_cast<std::uint64_t>(done.cleared);
  if (!resolve_.running()) return begin_flush();
  const int cycles = std::max(1, (done.quads + params_.quads_per_clk - 1) / params_.quads_per_clk);
  free_ = after(now, cycles);
  occupy(now, cycles);
}

void Rop::test(Tick now) {
  Entry& entry = entries_[tested_++];
  entry.stage = Stage::kTested;
  if (entry.token.kind == TokenKind::kWork) {
    const WarpSlot& warp = warps_[entry.token.slot];
    entry.shaded = std::popcount(warp.alive);
    entry.discarded_samples =
        warp.packed_samples - warp.alive_samples(frame_.draw(warp.draw).samples().count);
    if (warp.late) {
      entry.stage = Stage::kTesting;
      late_out.push(now, {TokenKind::kWork, entry.token.slot});
    }
  }
  while (awaiting_ < tested_ && entries_[awaiting_].stage == Stage::kTested) ++awaiting_;
  test_free_ = after(now, 1);
}

void Rop::acquire(Tick now) {
  Entry& entry = entries_[acquired_];
  if (entry.token.kind == TokenKind::kWork && !acquire_colors(entry, entries_.number(acquired_))) {
    stalled_ = true;
    return;
  }
  entry.stage = Stage::kAcquired;
  entry.ready = std::max(entry.ready, now);
  ++acquired_;
  acquire_free_ = after(now, 1);
}

bool Rop::acquire_colors(Entry& entry, std::uint32_t number) {
  const WarpSlot& warp = warps_[entry.token.slot];
  stats_.working_for(warp.draw);
  const DrawState& draw = frame_.draw(warp.draw);
  bool placed = true;
  int part = 0;
  const auto ask = [&](const SurfaceTile& tile, const SectorWishes& wishes) {
    if (!placed || part++ < entry.parts) return;
    placed = cache_.acquire(tile, wishes, number, entry.missing, entry.done, port_);
    if (!placed) return;
    ++entry.parts;
    entry.done = {};
  };
  if (draw.order_independent) {
    transparency_.visit_tiles(warp, draw.samples().count, ask);
    return placed;
  }
  const TouchedTiles touched(warp, draw.samples().count);
  draw.visit_colors([&](std::size_t color) {
    const bool reads = draw.reads_color(color);
    const std::uint32_t bytes = frame_.pass(draw.pass).color[color].surface.pixel_bytes;
    for (const TileTouch& touch : touched.all())
      ask(touch.tile_of(color), wishes_of_write(touch.pixels, bytes, reads));
  });
  return placed;
}

void Rop::retire(Tick now) {
  if (compose_.running()) return compose(now);
  if (resolve_.running()) return resolve(now);
  if (flush_.done()) {
    retire_out.push(now, {TokenKind::kPassEnd, pass_});
    flush_.end();
    return;
  }
  const Entry entry = entries_.front();
  int cycles = 1;
  if (entry.token.kind == TokenKind::kWork) {
    const WarpSlot& warp = warps_[entry.token.slot];
    stats_.working_for(warp.draw);
    if (!claim_colors(warp)) {  // a line was evicted since, and there is no place for it before the next fill
      claim_stalled_ = true;
      return;
    }
    const int live = std::popcount(warp.alive);
    ++stats_.warps;
    stats_.fragments_in += static_cast<std::uint64_t>(std::popcount(warp.covered));
    stats_.bytes_in += static_cast<std::uint64_t>(entry.shaded) * frame_.color_bytes(frame_.draw(warp.draw));
    const auto discarded = static_cast<std::uint64_t>(std::popcount(warp.covered) - entry.shaded);
    stats_.discarded += discarded;
    stats_.samples_discarded += entry.discarded_samples;
    if (warp.late) stats_.late_discarded += entry.discarded_samples;
    stats_.late_killed += static_cast<std::uint64_t>(entry.shaded - live);
    cycles = write_colors(warp);
    cache_.pixels_written();
    shaded_[entry.token.slot.index()] = false;
    release_out.push(now, {entry.token.slot});
    if (entry.token.sync != 0) sync_out.push(now, {0, entry.token.sync});
  } else {
    retire_boundary(now, entry);
  }
  entries_.pop_front();
  --tested_;
  --awaiting_;
  --acquired_;
  free_ = after(now, cycles);
  occupy(now, cycles);
}

void Rop::retire_boundary(Tick now, const Entry& entry) {
  stats_.working_for(entry.token.part.draw());
  switch (entry.token.kind) {
    case TokenKind::kPassBegin: {
      pass_ = entry.token.part.pass();
      const PassState& pass = frame_.pass(pass_);
      cache_.begin_pass({pass.color.data(), pass.colors}, partition_, partitions_);
      transparency_.begin_pass(pass, partition_, partitions_);
      return;
    }
    case TokenKind::kDrawEnd:
      ++stats_.draws;
      retire_out.push(now, {TokenKind::kDrawEnd, entry.token.part});
      return;
    case TokenKind::kPassEnd:
      depth_flushes_ = true;
      late_out.push(now, {TokenKind::kPassEnd, {}});
      return;
    case TokenKind::kSync: sync_out.push(now, {0, entry.token.sync}); return;
    case TokenKind::kWork:
    case TokenKind::kBatchEnd:
    case TokenKind::kRangeEnd: return;
  }
}

void Rop::audit(Audit& audit) const {
  audit.right(laws::kDraws, stats_.draws.value());
  audit.right(laws::kFragmentsDeferred, stats_.late_discarded.value());
  audit.right(laws::kWarpsDistributed, stats_.warps.value());
  audit.right(laws::kFragmentsShaded, stats_.fragments_in.value());
  audit.right(laws::kColorsExported, stats_.bytes_in.value());
  audit.both(laws::kFragmentsRetired, stats_.fragments_in.value(),
             stats_.discarded.value() + stats_.late_killed.value() + stats_.written.value());
  audit.right(laws::kSamplesRetired, stats_.samples_discarded.value() + stats_.samples_written.value());
  audit.left(laws::kKilledLate, stats_.late_killed.value());
  transparency_.audit(audit);
  cache_.audit(audit, laws::kColorCache, port_);
  port_.audit(audit);
}

void Rop::details(Details& details) const {
  details.by_draw(DrawCount::kAtRop, stats_.fragments_in);
  details.by_draw(DrawCount::kDiscarded, stats_.discarded);
  details.by_draw(DrawCount::kWritten, stats_.written);
  details.by_draw(DrawCount::kSamplesWritten, stats_.samples_written);
  details.by_draw(DrawCount::kSamplesDiscarded, stats_.samples_discarded);
  details.by_tile(TileCount::kWritten, stats_.written);
  port_.details(details, DrawCount::kColorBytes, TileCount::kBytes);
}

std::vector<Facet> Rop::row() const {
  return {rate("written", stats_.written, params_.quads_per_clk * models::kQuadPixels),
          share("written", stats_.written, stats_.fragments_in),
          share("discarded", stats_.discarded, stats_.fragments_in),
          share("blended", stats_.blended, stats_.pixels_written),
          share("cache hit", cache_.stats().hits, cache_.stats().requests)};
}

}  // namespace quadrille::hw
