#include "pipeline/report/flow_log.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <string_view>

namespace quadrille::pipeline {

namespace {

using Row = hw::Resources::Row;

/// What a client did, or what the memory did for one: read, then written.
struct Bytes {
  std::string_view client;
  bool memory = false;
  const hw::Counter* read = nullptr;
  const hw::Counter* written = nullptr;
};

std::uint64_t value_of(const hw::Counter* counter) { return counter == nullptr ? 0 : counter->value(); }

/// A unit's ends of the links of a class.
struct Ends {
  std::string_view key;
  bool input = false;
  std::vector<const hw::FifoBase*> links;
};

std::uint64_t tokens_at(const Ends& ends) {
  std::uint64_t sum = 0;
  for (const hw::FifoBase* link : ends.links) sum += ends.input ? link->pops() : link->pushes();
  return sum;
}
std::uint64_t ticks_at(const Ends& ends) {
  std::uint64_t sum = 0;
  for (const hw::FifoBase* link : ends.links) sum += ends.input ? link->pop_ticks() : link->push_ticks();
  return sum;
}

using KeyOfLink = std::map<const hw::FifoBase*, std::string_view>;

/// By unit: the bytes that it counts.
std::map<const hw::Unit*, std::vector<Bytes>> counted_bytes(const Machine& machine) {
  std::map<const hw::Unit*, std::vector<Bytes>> all;
  visit_client_kinds([&]<class Unit>(Needed) {
    for (Unit* unit : machine.all<Unit>()) {
      const hw::MemoryPortStats& counted = unit->memory_port().stats();
      all[unit] = {{name_of(Unit::kMemoryClient), false, &counted.read_bytes, &counted.write_bytes}};
    }
  });
  for (const hw::MemoryChannel* channel : machine.all<hw::MemoryChannel>()) {
    for (std::size_t i = 0; i < hw::kMemoryClients; ++i) {
      const auto client = static_cast<hw::MemoryClient>(i);
      const hw::Counter* counter = &channel->bytes_of(client);
      const bool writes = client == hw::MemoryClient::kWriteBack;
      all[channel].push_back({name_of(client), true, writes ? nullptr : counter, writes ? counter : nullptr});
    }
  }
  return all;
}

}  // namespace

/// A unit and what it is asked for: first its bytes, then tokens and ticks of its ends of links.
class FlowLog::Watched {
 public:
  Watched(hw::Unit& unit, std::vector<Bytes> bytes, std::shared_ptr<const KeyOfLink> keys)
      : unit_(unit), bytes_(std::move(bytes)), keys_(std::move(keys)) {
    unit_.keep_rows([this] { return row(); });
  }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

  [[nodiscard]] Row row() {
    if (ends_.empty()) find_ends();
    Row row;
    row.reserve(2 * (bytes_.size() + ends_.size()));
    for (const Bytes& b : bytes_) {
      row.push_back(value_of(b.read));
      row.push_back(value_of(b.written));
    }
    for (const Ends& ends : ends_) {
      row.push_back(tokens_at(ends));
      row.push_back(ticks_at(ends));
    }
    return row;
  }
  /// By slice: what the numbers had come to at its end.
  [[nodiscard]] std::vector<Row> rows(std::size_t slices) {
    const std::vector<Row>& kept = unit_.resources().rows();
    QUADRILLE_CHECK(slices == 0 || kept.size() + 1 >= slices, "{} has {} of {} slices", unit_.name(),
                    kept.size(), slices);
    std::vector<Row> rows(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(slices - 1));
    rows.push_back(row());
    return rows;
  }
  void add_to(FlowFigures& flow);

 private:
  /// Links know their ends only once the run has begun.
  void find_ends() {
    for (const hw::PortBase* port : unit_.ports()) {
      const bool input = port->direction() == hw::PortBase::Direction::kIn;
      const std::string_view key = keys_->at(&port->fifo());
      ends_of(key, input).links.push_back(&port->fifo());
    }
  }
  Ends& ends_of(std::string_view key, bool input) {
    for (Ends& ends : ends_)
      if (ends.key == key && ends.input == input) return ends;
    ends_.push_back({key, input, {}});
    return ends_.back();
  }

  hw::Unit& unit_;
  std::vector<Bytes> bytes_;
  std::shared_ptr<const KeyOfLink> keys_;
  std::vector<Ends> ends_;
};

namespace {

template <class Curve>
Curve& curve_of(std::vector<Curve>& curves, std::string Curve::*name, std::string_view wanted) {
  const auto found = std::ranges::find(curves, wanted, name);
  QUADRILLE_CHECK(found != curves.end(), "no slices for {}", wanted);
  return *found;
}

void add_growth(std::vector<std::uint64_t>& curve, const std::vector<Row>& rows, std::size_t column) {
  std::uint64_t before = 0;
  for (std::size_t s = 0; s < rows.size(); ++s) {
    curve[s] += rows[s][column] - before;
    before = rows[s][column];
  }
}

/// A push at tick t adds the time from t to the slice's end, a pop takes it away. All of it is modulo 2^64,
/// and what comes out is not negative once both ends are added.
void add_held(const FlowFigures& flow, std::vector<std::uint64_t>& held, const std::vector<Row>& rows,
              std::size_t column, bool input) {
  std::uint64_t before = 0;
  for (std::size_t s = 0; s < rows.size(); ++s) {
    const auto end = static_cast<std::uint64_t>(static_cast<hw::Tick>(s) * flow.slice + flow.length_of(s));
    const std::uint64_t passed = rows[s][column] * end - rows[s][column + 1];
    held[s] += input ? before - passed : passed - before;
    before = passed;
  }
}

std::uint64_t sum(const std::vector<std::uint64_t>& slices) {
  return std::accumulate(slices.begin(), slices.end(), std::uint64_t{0});
}

}  // namespace

void FlowLog::Watched::add_to(FlowFigures& flow) {
  const std::vector<Row> of_slices = rows(flow.slices);
  std::size_t column = 0;
  for (const Bytes& b : bytes_) {
    ClientCurve& curve = curve_of(b.memory ? flow.memory : flow.asked, &ClientCurve::client, b.client);
    add_growth(curve.read, of_slices, column);
    add_growth(curve.written, of_slices, column + 1);
    column += 2;
  }
  for (const Ends& ends : ends_) {
    add_held(flow, curve_of(flow.links, &LinkCurve::key, ends.key).held, of_slices, column, ends.input);
    column += 2;
  }
}

FlowLog::FlowLog(const Machine& machine) : machine_(machine) {
  const auto keys = std::make_shared<KeyOfLink>();
  for (std::size_t i = 0; i < machine.links().size(); ++i)
    keys->emplace(machine.links()[i].get(), machine.link_keys()[i]);
  std::map<const hw::Unit*, std::vector<Bytes>> bytes = counted_bytes(machine);
  units_.reserve(machine.units().size());
  for (hw::Unit* unit : machine.units())
    units_.push_back(std::make_unique<Watched>(*unit, std::move(bytes[unit]), keys));
}

FlowLog::~FlowLog() = default;

namespace {

/// Slices are kept for what the totals tell as a whole, so that a slice that is lost is seen.
void add_checks(const FlowFigures& flow, Figures& figures) {
  std::uint64_t asked = 0, of_clients = 0, moved = 0, held = 0, of_links = 0;
  for (const ClientCurve& c : flow.asked) asked += sum(c.read) + sum(c.written);
  for (const ClientFigures& c : figures.bandwidth) of_clients += c.read_bytes + c.write_bytes;
  for (const ClientCurve& c : flow.memory) moved += sum(c.read) + sum(c.written);
  for (const LinkCurve& l : flow.links) held += sum(l.held);
  for (const LinkFigures& l : figures.links) of_links += l.held_ticks;
  figures.checks.push_back({"bytes of all slices = bytes asked of and written to the L2 cache",
                            "timeline.bandwidth", "bandwidth", asked, of_clients});
  figures.checks.push_back({"bytes of all slices = bytes that the memory channels moved", "timeline.memory",
                            "memory.read_bytes + memory.write_bytes", moved, memory_bytes(figures)});
  figures.checks.push_back({"tokens held in all slices = tokens that the links held", "timeline.links",
                            "links.held", held, of_links});
}

/// All of them, with nothing in them: so their order does not depend on that of the units.
FlowFigures empty_flow(const Machine& machine, const Figures& figures) {
  FlowFigures flow;
  flow.slice = machine.units().front()->resources().slice();
  flow.end = machine.quiet_end();
  flow.slices = static_cast<std::size_t>((machine.end() + flow.slice - 1) / flow.slice);
  const std::vector<std::uint64_t> nothing(flow.slices, 0);
  flow.asked.reserve(figures.bandwidth.size());
  for (const ClientFigures& c : figures.bandwidth) flow.asked.push_back({c.name, nothing, nothing});
  flow.memory.reserve(hw::kMemoryClients);
  for (std::size_t i = 0; i < hw::kMemoryClients; ++i)
    flow.memory.push_back({std::string(name_of(static_cast<hw::MemoryClient>(i))), nothing, nothing});
  for (const std::string& key : machine.link_keys())
    if (std::ranges::find(flow.links, key, &LinkCurve::key) == flow.links.end())
      flow.links.push_back({key, nothing});
  return flow;
}

}  // namespace

void FlowLog::collect(Figures& figures) const {
  FlowFigures flow = empty_flow(machine_, figures);
  if (flow.slices == 0) return;
  for (const auto& unit : units_) unit->add_to(flow);
  add_checks(flow, figures);
  figures.flow = std::move(flow);
}

}  // namespace quadrille::pipeline
