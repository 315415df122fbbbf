#include "hw/shader/load_store_unit.h"

#include "hw/base/leg_log.h"
#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw {
namespace {

/// Answers to atomic requests name their group; those to loads name the cache's miss.
constexpr std::uint32_t kAtomicTag = 1u << 31;

}  // namespace

LoadStoreUnit::LoadStoreUnit(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                             Store<CoreSlot>& slots)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      slots_(slots),
      port_(*this, stats_, context.machine.channels),
      cache_(stats_, params.cache_lines, params.cache_ways, params.cache_misses) {
  add_initiation_rate("lines");
  add_places("groups_in_flight",
             [this] { return groups_.size() >= static_cast<std::size_t>(params_.groups_in_flight.value()); });
  add_memory_places("requests_queued", [this] { return queue_full(); });
  add_memory_places("cache_misses", [this] { return cache_.full(); });
}

std::string LoadStoreUnit::state_text() const {
  return fmt::format("{} request groups, {} lines left, {} requests for the L2 cache", groups_.size(),
                     lines_.size() - next_line_, port_.queued());
}

bool LoadStoreUnit::queue_full() const {
  return port_.queued() >= static_cast<std::size_t>(params_.requests_queued.value());
}

Wake LoadStoreUnit::line_wake() const {
  if (next_line_ < lines_.size()) {
    if (stalled_) return Wake::never(port_.response_in[0]);
    return queue_full() ? Wake(kNever) : Wake(line_free_);
  }
  if (groups_.size() >= static_cast<std::size_t>(params_.groups_in_flight.value()))
    return Wake::never(response_out);
  return Wake(line_free_).input(request_in);
}

Wake LoadStoreUnit::answer_wake() const {
  if (groups_.empty()) return Wake::never(request_in);
  const Group& head = groups_.front();
  const bool still_moving = groups_.size() == 1 && next_line_ < lines_.size();
  if (head.missing > 0 || still_moving) return Wake::never(port_.response_in[0]);
  return Wake(after(head.ready, params_.response_clk)).output(response_out);
}

Wake LoadStoreUnit::next() const {
  Wake wake = Wake::sooner(line_wake(), answer_wake());
  wake = Wake::sooner(wake, port_.receive_wake());
  if (!port_.queue_empty()) wake = Wake::sooner(wake, port_.send_wake());
  return wake;
}

void LoadStoreUnit::act(Tick now) {
  port_.receive(now, [&](const MemoryResponse& answer) {
    const auto answered = [&](std::uint32_t number) {
      groups_.answer(number, now);
      if (LegLog* log = leg_log(); log != nullptr) [[unlikely]]
        log->take_answer(groups_.numbered(number), now, port_.answers_of(answer.line).number());
    };
    if ((answer.tag & kAtomicTag) != 0) return answered(answer.tag & ~kAtomicTag);
    stalled_ = false;
    cache_.fill(answer, answered);
  });
  if (answer_wake().at() <= now) {
    if (LegLog* log = leg_log(); log != nullptr) [[unlikely]]
      log->end({groups_.front().leg_take, 0, after(groups_.front().ready, params_.response_clk), now,
                after(0, params_.response_clk), response_out.number(), false, true});
    response_out.push(now, groups_.front().token);
    groups_.pop_front();
    ++stats_.groups_answered;
  }
  if (line_wake().at() <= now) {
    if (next_line_ < lines_.size()) move_lines(now);
    else take(now);
  }
  port_.send(now);
}

void LoadStoreUnit::gather(const CoreSlot& slot, const StorageToken& token) {
  const std::vector<models::StorageView>& buffers = frame_.draw(token.draw).stage(token.stage).buffers;
  lines_.clear();
  next_line_ = 0;
  for (int i = 0; i < slot.warp.access_count; ++i) {
    const models::StorageRequest& request = slot.warp.accesses[static_cast<std::size_t>(i)];
    gathered_.clear();
    models::add_lines(request, buffers[request.binding], gathered_);
    for (const models::StorageLine& line : gathered_) lines_.push_back({line, request.op});
    const auto lanes = static_cast<std::uint64_t>(std::popcount(request.active));
    ++stats_.requests;
    if (models::is_atomic(request.op)) stats_.atomics += lanes;
    else (models::writes_buffer(request.op) ? stats_.stores : stats_.loads) += lanes;
  }
  stats_.lines += lines_.size();
}

void LoadStoreUnit::take(Tick now) {
  const Tick arrived = request_in.ready();
  const StorageToken token = request_in.pop(now);
  const CoreSlot& slot = slots_[token.slot];
  if (token.stage == models::ShaderStage::kVertex) stats_.working_for(token.draw);
  else stats_.working_for(token.draw, slot.tile_x, slot.tile_y);
  if (const PassId pass = frame_.draw(token.draw).pass; pass != pass_) {
    pass_ = pass;
    cache_.forget();
  }
  gather(slot, token);
  ++stats_.groups;
  const auto rate = static_cast<std::size_t>(params_.lines_per_clk.value());
  const auto cycles = static_cast<std::int64_t>(std::max<std::size_t>(1, (lines_.size() + rate - 1) / rate));
  line_free_ = after(now, cycles);
  occupy(now, cycles);
  groups_.push_back(
      {token, 0, line_free_, noted(leg_log(), {arrived, now, request_in.number(), true, token.draw})});
  move_lines(now);
}

void LoadStoreUnit::move_lines(Tick now) {
  for (; next_line_ < lines_.size(); ++next_line_)
    if (queue_full() || !move(lines_[next_line_])) return;
  groups_.back().ready = std::max(groups_.back().ready, now);
}

bool LoadStoreUnit::move(const Line& moved) {
  const models::StorageLine& line = moved.line;
  if (models::is_atomic(moved.op)) {
    port_.atomic(line.line, line.sectors, groups_.newest() | kAtomicTag);
    ++groups_.back().missing;
    return true;
  }
  if (models::writes_buffer(moved.op)) {
    const auto parts = static_cast<std::uint8_t>(line.sectors & ~line.whole);
    if (line.whole != 0) port_.write(line.line, line.whole);
    if (parts != 0) port_.write_part(line.line, parts);
    return true;
  }
  switch (cache_.access(line.line, line.sectors, groups_.newest(), port_)) {
    case L1Cache::Result::kHit: return true;
    case L1Cache::Result::kPending: ++groups_.back().missing; return true;
    case L1Cache::Result::kStall: stalled_ = true; return false;
  }
  return true;
}

void LoadStoreUnit::audit(Audit& audit) const {
  audit.right(laws::kStorageRequests, stats_.requests.value());
  audit.both(laws::kStorageGroups, stats_.groups.value(), stats_.groups_answered.value());
  cache_.stats().audit(audit, laws::kStorageCache);
  port_.audit(audit);
}

void LoadStoreUnit::details(Details& details) const { port_.details(details, DrawCount::kStorageBytes); }

std::vector<Facet> LoadStoreUnit::row() const {
  return {count("requests", stats_.requests), mean("lines/request", stats_.lines, stats_.requests),
          share("cache hit", cache_.stats().hits, cache_.stats().requests), count("atomics", stats_.atomics)};
}

}  // namespace quadrille::hw
