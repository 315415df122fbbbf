#include "models/memory/dram/controller.h"

#include "models/base/error.h"
#include "models/memory/device_memory.h"
#include "models/memory/dram/pseudo_channel.h"

#include <algorithm>

namespace quadrille::models {

struct DramController::PseudoChannels {
  std::vector<DramCommandBus> buses;
  std::vector<PseudoChannel> all;
};

namespace {
/// A bit for each burst of a line that holds one of the sectors.
std::uint32_t bursts_of(std::uint8_t sectors, int burst_bytes) {
  const auto burst_sectors = static_cast<unsigned>(burst_bytes) / kSectorBytes;
  const std::uint32_t one = (1u << burst_sectors) - 1;
  std::uint32_t bursts = 0;
  for (unsigned burst = 0; burst * burst_sectors < kLineSectors; ++burst) {
    if ((sectors >> (burst * burst_sectors) & one) != 0) bursts |= 1u << burst;
  }
  return bursts;
}
}  // namespace

DramController::DramController(const DramControllerParams& params)
    : params_(params),
      mapping_(params.mapping->make(params.timing, params.hash)),
      parts_(std::make_unique<PseudoChannels>()) {
  const DramTiming& t = params_.timing;
  QUADRILLE_CHECK(
      t.burst_bytes >= static_cast<int>(kSectorBytes) && t.burst_bytes <= static_cast<int>(kLineBytes),
      "bursts of {} bytes", t.burst_bytes);
  const auto count = static_cast<std::size_t>(t.pseudo_channels);
  parts_->buses.assign(t.shared_commands ? 1 : count, DramCommandBus(t));
  parts_->all.reserve(count);
  for (std::size_t p = 0; p < count; ++p)
    parts_->all.emplace_back(params_, parts_->buses[t.shared_commands ? 0 : p], static_cast<std::uint8_t>(p));
}

DramController::~DramController() = default;

void DramController::take(const DramRequest& request, Cycle now) {
  if (held() == 0) catch_up(now);
  ++held_[request.write];
  DramEntry entry;
  entry.at = mapping_->place(request.line);
  entry.seq = seq_++;
  entry.arrived = now;
  entry.id = request.id;
  entry.bursts = bursts_of(request.sectors, params_.timing.burst_bytes);
  entry.write = request.write;
  PseudoChannel& channel = parts_->all[entry.at.pseudo_channel];
  channel.take(entry, now);
  now_ = now;
  fresh_ = false;
}

void DramController::update() const {
  fresh_ = true;
  next_ = kNever;
  if (held() == 0) return;
  for (PseudoChannel& channel : parts_->all) next_ = std::min(next_, channel.next(now_));
}

void DramController::step_channels(Cycle now, std::vector<DramDone>& done, const Trace& trace) {
  const std::size_t count = parts_->all.size();
  std::size_t p = turn_;
  for (std::size_t i = 0; i < count; ++i, p = p + 1 < count ? p + 1 : 0) {
    if (parts_->all[p].next(now) > now) continue;
    parts_->all[p].step(now, done, counts_, trace);
    turn_ = p + 1 < count ? p + 1 : 0;
    if (!params_.timing.shared_commands) continue;
    for (std::size_t other = 0; other < count; ++other) parts_->all[other].replan();
  }
}

void DramController::step(Cycle now, std::vector<DramDone>& done) {
  const std::size_t before = done.size();
  step_channels(now, done, trace_);
  caught_up_ = now_ = now;
  fresh_ = false;
  for (std::size_t i = before; i < done.size(); ++i) --held_[done[i].write];
}

void DramController::step_idle(Cycle end, const Trace& trace) {
  std::vector<DramDone> none;
  while (true) {
    Cycle at = kNever;
    for (PseudoChannel& channel : parts_->all) at = std::min(at, channel.next(caught_up_));
    if (at >= end) break;
    step_channels(at, none, trace);
    caught_up_ = at;
  }
  caught_up_ = end;
}

std::vector<std::array<DramController::Cycle, 4>> DramController::idle_round(Cycle round) {
  std::vector<std::array<Cycle, 4>> sent;
  bool refreshes = true;
  const Cycle begin = caught_up_;
  step_idle(begin + round, [&](const DramCommand& c) {
    refreshes &= c.kind == DramCommandKind::kRefresh || c.kind == DramCommandKind::kRefreshBank;
    sent.push_back({c.cycle - begin, c.pseudo_channel, c.rank, c.bank_group * Cycle{1 << 16} + c.bank});
  });
  if (!refreshes) sent.clear();
  return sent;
}

// What two equal rounds sent, when all rows are closed and no earlier command bounds another, all later ones
// send.
void DramController::skip_rounds(Cycle now) {
  const Cycle round = parts_->all.front().refresh_round();
  const Cycle settled = caught_up_ + params_.timing.longest() + (params_.timing.refresh_postpone + 2) * round;
  if (round == 0 || trace_ || now < settled + 4 * round) return;
  step_idle(settled, {});
  const auto first = idle_round(round);
  const std::size_t turn = turn_;
  const auto second = idle_round(round);
  if (first.empty() || first != second || turn_ != turn) return;
  const Cycle rounds = (now - caught_up_) / round;
  for (PseudoChannel& channel : parts_->all) channel.repeat_refreshes(rounds);
  counts_.refreshes += static_cast<std::uint64_t>(rounds) * second.size();
  caught_up_ += rounds * round;
}

void DramController::catch_up(Cycle now) {
  skip_rounds(now);
  step_idle(now, trace_);
}

std::int64_t DramController::charged(BusUse use) const {
  std::int64_t sum = 0;
  for (const PseudoChannel& channel : parts_->all) sum += channel.bus().charged(use);
  return sum;
}

BusAccount::Cycles DramController::bus_cycles(Cycle end) const {
  BusAccount::Cycles sum{};
  for (const PseudoChannel& channel : parts_->all) {
    const BusAccount::Cycles cycles = channel.bus().until(end);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += cycles[i];
  }
  return sum;
}

}  // namespace quadrille::models
