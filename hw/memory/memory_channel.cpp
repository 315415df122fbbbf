#include "hw/memory/memory_channel.h"

#include "hw/memory/memory_port.h"
#include "models/memory/device_memory.h"

#include <bit>

namespace quadrille::hw {

namespace {
models::DramParams dram_params(const MemoryChannel::Params& p) {
  models::DramParams d;
  d.banks = p.banks;
  d.row_bytes = p.row_bytes;
  d.t_rcd = p.t_rcd;
  d.t_rp = p.t_rp;
  d.t_cas = p.t_cas;
  d.t_burst = p.t_burst;
  return d;
}
}  // namespace

MemoryChannel::MemoryChannel(sc_core::sc_module_name name, const Params& params, const Clock& clock, int channels)
    : Unit(name, Kind::kChooser, clock), params_(params), channels_(static_cast<std::uint32_t>(channels)), dram_(dram_params(params)) {}

std::string MemoryChannel::state_text() const { return fmt::format("{} accesses under way", under_way_.size()); }

Wake MemoryChannel::take_wake() const {
  if (under_way_.size() >= static_cast<std::size_t>(params_.queue_depth.value())) return Wake::never(response_out);
  return Wake(free_).input(request_in);
}

Wake MemoryChannel::finish_wake() const {
  if (under_way_.empty()) return Wake::never(request_in);
  Wake wake(under_way_.front().done);
  return under_way_.front().write ? wake : wake.output(response_out);
}

Wake MemoryChannel::next() const { return Wake::sooner(finish_wake(), take_wake()); }

void MemoryChannel::act(Tick now) {
  if (finish_wake().at() <= now) {
    if (!under_way_.front().write) response_out.push(now, under_way_.front().answer);
    under_way_.pop_front();
  }
  if (take_wake().at() <= now) take(now);
}

void MemoryChannel::take(Tick now) {
  const MemoryRequest request = request_in.pop(now);
  const bool write = request.kind == MemoryRequest::Kind::kWrite;
  const auto bytes = static_cast<std::uint32_t>(models::kSectorBytes * static_cast<unsigned>(std::popcount(request.sectors)));
  const std::uint64_t address = std::uint64_t{line_within_slice(request.line, channels_)} * models::kLineBytes;
  const std::int64_t cycle = clock().edges_before(now);
  const models::DramAccess access = dram_.access(address, bytes, write, cycle);
  ++(write ? stats_.writes : stats_.reads);
  (write ? stats_.write_bytes : stats_.read_bytes) += bytes;
  if (access.row_hit) ++stats_.row_hits;
  if (access.row_conflict) ++stats_.row_conflicts;
  stats_.bus_busy += static_cast<std::uint64_t>(access.done - access.start);
  const Tick done = clock().edge(access.done + (write ? 0 : params_.path_clk.value()));
  under_way_.push_back(
      {under_way_.empty() ? done : std::max(done, under_way_.back().done), {request.line, request.tag, request.sectors}, write});
  free_ = after(now, 1);
  occupy(now, access.done - access.start);
}

}  // namespace quadrille::hw
