#include "hw/memory/memory_channel.h"

#include "hw/base/leg_log.h"
#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include "models/memory/device_memory.h"

#include <algorithm>

namespace quadrille::hw {

models::DramControllerParams MemoryChannel::Params::controller() const {
  models::DramControllerParams p;
  p.timing = {.pseudo_channels = pseudo_channels,
              .ranks = ranks,
              .bank_groups = bank_groups,
              .banks = banks,
              .rows = rows,
              .row_bytes = row_bytes,
              .burst_bytes = burst_bytes,
              .t_burst = t_burst,
              .t_rcd = t_rcd,
              .t_rcd_wr = t_rcd_wr,
              .t_rp = t_rp,
              .t_ras = t_ras,
              .t_rc = t_rc,
              .t_cas = t_cas,
              .t_cwl = t_cwl,
              .t_ccd_s = t_ccd_s,
              .t_ccd_l = t_ccd_l,
              .t_rrd_s = t_rrd_s,
              .t_rrd_l = t_rrd_l,
              .t_faw = t_faw,
              .t_wr = t_wr,
              .t_wtr_s = t_wtr_s,
              .t_wtr_l = t_wtr_l,
              .t_rtp = t_rtp,
              .t_rtw = t_rtw,
              .t_rtrs = t_rtrs,
              .refresh = refresh,
              .t_refi = t_refi,
              .t_rfc = t_rfc,
              .t_rfc_pb = t_rfc_pb,
              .t_rrefd = t_rrefd,
              .refresh_postpone = refresh_postpone,
              .separate_buses = separate_buses,
              .shared_commands = shared_commands,
              .act_slots = act_slots,
              .column_slots = column_slots};
  p.mapping = &mapping.value();
  p.hash = bank_hash;
  p.scheduler = &scheduler.value();
  p.in_order_ahead = in_order_ahead;
  p.age_cap = age_cap;
  p.write_drain = &write_drain.value();
  p.write_high = std::max(1, write_queue * write_high / 100);
  p.write_low = write_queue * write_low / 100;
  p.page = &page.value();
  p.page_idle = page_idle;
  p.reads = queue_depth;
  p.writes = write_queue;
  return p;
}

double MemoryChannel::Params::bytes_per_clk() const {
  return static_cast<double>(burst_bytes) * pseudo_channels / std::max<int>(t_burst, t_ccd_s);
}

Histogram& MemoryChannel::Stats::latency(MemoryClient client) {
  switch (client) {
    case MemoryClient::kVertexFetch: return latency_vertex_fetch;
    case MemoryClient::kTexture: return latency_texture;
    case MemoryClient::kStorage: return latency_storage;
    case MemoryClient::kDepth: return latency_depth;
    case MemoryClient::kColor: return latency_color;
    case MemoryClient::kScanOut: return latency_scan_out;
    case MemoryClient::kWriteBack: return latency_write_back;
  }
  return latency_write_back;
}

Counter& MemoryChannel::Stats::bytes(MemoryClient client) {
  switch (client) {
    case MemoryClient::kVertexFetch: return read_bytes_vertex_fetch;
    case MemoryClient::kTexture: return read_bytes_texture;
    case MemoryClient::kStorage: return read_bytes_storage;
    case MemoryClient::kDepth: return read_bytes_depth;
    case MemoryClient::kColor: return read_bytes_color;
    case MemoryClient::kScanOut: return read_bytes_scan_out;
    case MemoryClient::kWriteBack: return write_bytes;
  }
  return write_bytes;
}

MemoryChannel::MemoryChannel(sc_core::sc_module_name name, const UnitContext& context, const Params& params)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      interleave_(static_cast<std::uint32_t>(context.machine.channels)),
      stats_(std::make_unique<Stats>()),
      controller_(params.controller()) {
  add_rate(
      "bus", [this] { return bus_cycles(models::BusUse::kRead) + bus_cycles(models::BusUse::kWrite); },
      "data bus");
  add_loss(
      "rows",
      [this] {
        return bus_cycles(models::BusUse::kActivation) + bus_cycles(models::BusUse::kTurnaround) +
               bus_cycles(models::BusUse::kSpacing) + bus_cycles(models::BusUse::kRefresh);
      },
      "data bus");
  add_places("queue_depth", [this] { return !controller_.room(false); });
  add_places("write_queue", [this] { return !controller_.room(true); });
}

MemoryChannel::~MemoryChannel() = default;

const StatGroup* MemoryChannel::stats() const { return stats_.get(); }

const Counter& MemoryChannel::bytes_of(MemoryClient client) const { return stats_->bytes(client); }

std::string MemoryChannel::state_text() const {
  return fmt::format("{} reads and {} writes in the queue, {} answers", controller_.held(false),
                     controller_.held(true), answers_.size());
}

Wake MemoryChannel::take_wake() const {
  if (request_in.ready() == kNever) return Wake().input(request_in);
  const bool write = request_in.front().kind == MemoryRequest::Kind::kWrite;
  return controller_.room(write) ? Wake().input(request_in) : Wake::never(request_in);
}

Wake MemoryChannel::command_wake() const {
  const std::int64_t cycle = controller_.next();
  return cycle == models::DramController::kNever ? Wake::never(request_in) : Wake(clock().edge(cycle));
}

Wake MemoryChannel::next() const {
  Wake wake = Wake::sooner(command_wake(), take_wake());
  if (!answers_.empty()) wake = Wake::sooner(wake, Wake(answers_.front().at).output(response_out));
  return wake;
}

void MemoryChannel::act(Tick now) {
  const std::int64_t cycle = clock().edges_before(now);
  while (request_in.ready_at(now) && controller_.room(request_in.front().kind == MemoryRequest::Kind::kWrite))
    take(now, cycle);
  if (controller_.next() <= cycle) {
    note_occupancy(cycle);
    done_.clear();
    controller_.step(cycle, done_);
    for (const models::DramDone& done : done_) finish(done);
    occupy(now, 1);
  }
  while (!answers_.empty() && answers_.front().at <= now && response_out.room_at(now)) send(now);
}

void MemoryChannel::send(Tick now) {
  const Answer& answer = answers_.front();
  if (LegLog* log = leg_log(); log != nullptr) [[unlikely]]
    log->end(
        {answer.leg_take, 0, answer.at, now, after(0, params_.t_cas), response_out.number(), false, true});
  response_out.push(now, answer.token);
  answers_.pop_front();
}

double MemoryChannel::bus_cycles(models::BusUse use) const {
  const std::int64_t cycles =
      bus_at_end_ ? (*bus_at_end_)[static_cast<std::size_t>(use)] : controller_.charged(use);
  return static_cast<double>(cycles) / params_.pseudo_channels;
}

void MemoryChannel::note_occupancy(std::int64_t cycle) {
  const auto held = static_cast<std::uint64_t>(controller_.held(false) + controller_.held(true));
  stats_->queue_occupancy += held * static_cast<std::uint64_t>(cycle - occupancy_noted_);
  occupancy_noted_ = cycle;
}

void MemoryChannel::take(Tick now, std::int64_t cycle) {
  const Tick arrived = request_in.ready();
  const MemoryRequest request = request_in.pop(now);
  stats_->working_for(request.draw);
  const bool write = request.kind == MemoryRequest::Kind::kWrite;
  const std::uint64_t bytes = models::sector_bytes(request.sectors);
  note_occupancy(cycle);
  ++(write ? stats_->writes : stats_->reads);
  if (!write) stats_->read_bytes += bytes;
  if (texture_lines_ && !write && request.client == MemoryClient::kTexture) [[unlikely]]
    (*texture_lines_)[request.line] += bytes;
  stats_->bytes(write ? MemoryClient::kWriteBack : request.client) += bytes;
  if (free_ids_.empty()) {
    free_ids_.push_back(static_cast<std::uint32_t>(held_.size()));
    held_.emplace_back();
  }
  const std::uint32_t id = free_ids_.back();
  free_ids_.pop_back();
  held_[id] = {{request.line, request.tag, request.sectors},
               request.client,
               noted(leg_log(), {arrived, now, request_in.number(), true, request.draw})};
  controller_.take({interleave_.index_of(request.line), request.sectors, write, id}, cycle);
}

void MemoryChannel::finish(const models::DramDone& done) {
  switch (done.row) {
    case models::DramRowOutcome::kHit: ++stats_->row_hits; break;
    case models::DramRowOutcome::kMiss: ++stats_->row_misses; break;
    case models::DramRowOutcome::kConflict: ++stats_->row_conflicts; break;
  }
  const Held& held = held_[done.id];
  stats_->latency(held.client).note(static_cast<std::uint64_t>(done.done - done.arrived));
  free_ids_.push_back(done.id);
  if (done.write) return;
  answers_.push_back({clock().edge(done.done), held.answer, held.leg_take});
  // Pseudo-channels finish in any order: keep the answers in order of time.
  for (std::size_t i = answers_.size() - 1; i > 0 && answers_[i - 1].at > answers_[i].at; --i)
    std::swap(answers_[i - 1], answers_[i]);
}

void MemoryChannel::finish_stats(Tick end) {
  const std::int64_t cycles = clock().edges_before(end);
  note_occupancy(std::max(cycles, occupancy_noted_));
  const models::DramCommandCounts& counts = controller_.counts();
  stats_->activates += counts.activates;
  stats_->precharges += counts.precharges;
  stats_->read_bursts += counts.reads;
  stats_->write_bursts += counts.writes;
  stats_->refreshes += counts.refreshes;
  // Shares of all pseudo-channels in whole cycles of the channel: what a division leaves over goes on to the
  // next use, so that they still add up.
  const models::BusAccount::Cycles sums = controller_.bus_cycles(cycles);
  bus_at_end_ = sums;
  const std::array<Counter*, models::kBusUses> counters{
      &stats_->bus_read,       &stats_->bus_write,   &stats_->bus_refresh, &stats_->bus_turnaround,
      &stats_->bus_activation, &stats_->bus_spacing, &stats_->bus_idle};
  const std::int64_t buses = params_.pseudo_channels;
  std::int64_t sum = 0, given = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sum += sums[i];
    *counters[i] += static_cast<std::uint64_t>(sum / buses - given);
    given = sum / buses;
  }
  stats_->bus_busy += stats_->bus_read.value() + stats_->bus_write.value();
}

void MemoryChannel::audit(Audit& audit) const {
  const Stats& s = *stats_;
  audit.right(laws::kFills, s.read_bytes.value());
  audit.right(laws::kWriteBacks, s.write_bytes.value());
  audit.both(laws::kRows, s.row_hits.value() + s.row_misses.value() + s.row_conflicts.value(),
             s.reads.value() + s.writes.value());
  audit.both(laws::kDataBus,
             s.bus_read.value() + s.bus_write.value() + s.bus_refresh.value() + s.bus_turnaround.value() +
                 s.bus_activation.value() + s.bus_spacing.value() + s.bus_idle.value(),
             static_cast<std::uint64_t>(total_cycles()));
}

void MemoryChannel::details(Details& details) const {
  details.by_draw(DrawCount::kMemoryBytes, stats_->read_bytes);
  details.by_draw(DrawCount::kMemoryBytes, stats_->write_bytes);
  details.by_draw(DrawCount::kMemoryReadBytes, stats_->read_bytes);
  details.shared_by_draws(nullptr);
  details.work({&stats_->read_bytes, &stats_->write_bytes}, params_.bytes_per_clk());
}

std::vector<Facet> MemoryChannel::row() const {
  const Stats& s = *stats_;
  return {count("accesses", s.reads.value() + s.writes.value()),
          share("row hit", s.row_hits, s.reads.value() + s.writes.value()),
          share("data bus held", s.bus_busy, total_cycles()),
          share("refresh", s.bus_refresh, total_cycles()),
          share("turn-around", s.bus_turnaround, total_cycles()),
          share("activation", s.bus_activation, total_cycles()),
          share("spacing", s.bus_spacing, total_cycles()),
          mean("in queue", s.queue_occupancy, total_cycles())};
}

}  // namespace quadrille::hw
