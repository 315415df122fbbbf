#include "hw/display/scan_out.h"

#include "hw/frame/laws.h"

namespace quadrille::hw {

ScanOut::ScanOut(sc_core::sc_module_name name, const UnitContext& context, const Params& params)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      device_(context.memory),
      port_(*this, stats_, context.machine.channels),
      encoded_(stats_) {
  add_initiation_rate("rate");
  add_memory_places("lines_in_flight", [this] { return in_flight_ >= params_.lines_in_flight; });
}

std::string ScanOut::state_text() const {
  return fmt::format("{} lines left, {} under way", end_line_ - next_line_, in_flight_);
}

Wake ScanOut::ask_wake() const {
  if (!scanning_) return Wake(free_).input(scan_in);
  if (next_line_ < end_line_)
    return in_flight_ < params_.lines_in_flight ? Wake(free_) : Wake::never(port_.response_in[0]);
  return in_flight_ == 0 ? Wake(free_).output(done_out) : Wake::never(port_.response_in[0]);
}

Wake ScanOut::next() const {
  Wake wake = Wake::sooner(ask_wake(), port_.receive_wake());
  if (!port_.queue_empty()) wake = Wake::sooner(wake, port_.send_wake());
  return wake;
}

void ScanOut::act(Tick now) {
  port_.receive(now, [&](const MemoryResponse&) { --in_flight_; });
  if (ask_wake().at() <= now) {
    if (!scanning_) {
      const models::SurfaceLayout& surface = frame_.pass(scan_in.pop(now).pass).picture().surface;
      next_line_ = static_cast<std::uint32_t>(surface.base / models::kLineBytes);
      sectors_ = surface.line_sectors();
      end_line_ = next_line_ + static_cast<std::uint32_t>(surface.bytes() / models::kLineBytes);
      scanning_ = true;
    } else if (next_line_ < end_line_) {
      read_next();
    } else {
      done_out.push(now, {});
      scanning_ = false;
    }
    free_ = after(now, 1);
    occupy(now, 1);
  }
  port_.send(now);
}

void ScanOut::read_next() {
  device_.check_readable(std::uint64_t{next_line_} * models::kLineBytes, models::kLineBytes,
                         models::DeviceMemory::kClean);
  if (device_.stored_lines().is_encoded(next_line_)) {
    const models::StoredLines::Place place = device_.stored_lines().place_of(next_line_);
    port_.read(place.line, place.sectors, 0);
    ++encoded_.lines;
    encoded_.bytes += models::sector_bytes(place.sectors);
  } else {
    port_.read(next_line_, sectors_, 0);
  }
  ++next_line_;
  ++in_flight_;
  ++stats_.lines;
}

void ScanOut::audit(Audit& audit) const {
  // An encoded line stands for all of its bytes.
  audit.left(laws::kScanOut, port_.stats().read_bytes.value() - encoded_.bytes.value() +
                                 encoded_.lines.value() * models::sector_bytes(sectors_));
  port_.audit(audit);
}

void ScanOut::details(Details& details) const { port_.details(details); }

std::vector<Facet> ScanOut::row() const { return {count("lines", stats_.lines)}; }

}  // namespace quadrille::hw
