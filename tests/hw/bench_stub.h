/// A bench for one unit: a scripted stub on each of its ports, one clock of 1 GHz, and times in cycles.
///
/// What a stub pushes at cycle c the unit sees at c + 1, and what the unit pushes at c a sink pops at c + 1
/// (unless told to wait), so that "not at n - 1, but at n" is one number in a sink's `text()`. A bench is a
/// `Specimen`: the contract harness runs it too, with all links one token deep among other things.
#pragma once

#include "hw/base/dispatcher.h"
#include "hw/frame/unit_context.h"
#include "hw/memory/memory_port.h"
#include "tests/hw/contract.h"

#include <fmt/format.h>

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace quadrille::hw::bench {

inline constexpr Tick kCycle = 1'000'000;  ///< fs at 1 GHz

/// A token and the cycle before which it is not pushed.
template <class T>
struct Timed {
  std::int64_t cycle = 0;
  T token{};
};

/// When a sink pops: not before cycle `from`, and one token every `period` cycles.
struct Pace {
  std::int64_t from = 0, period = 1;
};

class StubUnit : public Unit {
 public:
  using Unit::Unit;
  /// Order of tokens without their times, for the digest.
  [[nodiscard]] virtual std::string keys() const { return {}; }
  [[nodiscard]] virtual bool finished() const { return true; }
};

/// Pushes a script, in order, as soon as there is room.
template <class T>
class StubSource final : public StubUnit {
 public:
  StubSource(sc_core::sc_module_name name, const Clock& clock, std::vector<Timed<T>> script)
      : StubUnit(name, Kind::kFixedOrder, clock), script_(std::move(script)) {}
  FifoOut<T> out{*this, "out"};
  Wake next() const override {
    return sent_ == script_.size() ? Wake(kNever) : Wake(script_[sent_].cycle * kCycle).output(out);
  }
  void act(Tick now) override { out.push(now, script_[sent_++].token); }
  bool finished() const override { return sent_ == script_.size(); }

 private:
  std::vector<Timed<T>> script_;
  std::size_t sent_ = 0;
};

/// Pops at its pace and records when it popped what.
template <class T>
class StubSink final : public StubUnit {
 public:
  using Key = std::function<std::uint64_t(const T&)>;
  StubSink(sc_core::sc_module_name name, const Clock& clock, Pace pace, Key key)
      : StubUnit(name, Kind::kFixedOrder, clock), pace_(pace), key_(std::move(key)) {
    free_ = pace.from * kCycle;
  }
  FifoIn<T> in{*this, "in"};
  Wake next() const override { return Wake(free_).input(in); }
  void act(Tick now) override {
    got.push_back({now / kCycle, in.pop(now)});
    free_ = now + pace_.period * kCycle;
    occupy(now, pace_.period);
  }
  /// "cycle:key" of each token.
  [[nodiscard]] std::string text() const {
    std::string all;
    for (const Timed<T>& t : got)
      all += fmt::format("{}{}:{}", all.empty() ? "" : " ", t.cycle, key_(t.token));
    return all;
  }
  std::string keys() const override {
    std::string all;
    for (const Timed<T>& t : got) all += fmt::format(" {}", key_(t.token));
    return all;
  }
  std::vector<Timed<T>> got;

 private:
  Pace pace_;
  Key key_;
  Tick free_ = 0;
};

/// Names a kind of requests: r, w, p (a write in part), a (atomic) or f (fence).
[[nodiscard]] constexpr char letter_of(MemoryRequest::Kind kind) { return "rwpaf"[static_cast<int>(kind)]; }

/// One slice of a memory: takes a request a cycle and pushes the answer of a read, atomic request or fence
/// `latency` cycles after it took it in, in order.
class StubMemory final : public StubUnit {
 public:
  StubMemory(sc_core::sc_module_name name, const Clock& clock, int latency)
      : StubUnit(name, Kind::kChooser, clock), latency_(latency) {}
  FifoIn<MemoryRequest> in{*this, "in"};
  FifoOut<MemoryResponse> out{*this, "out", LinkRole::kReply};
  Wake next() const override {
    const Wake take = Wake(free_).input(in);
    return waiting_.empty() ? take : Wake::sooner(take, Wake(waiting_.front().cycle * kCycle).output(out));
  }
  void act(Tick now) override {
    if (!waiting_.empty() && waiting_.front().cycle * kCycle <= now && out.room_at(now)) {
      out.push(now, waiting_.front().token);
      waiting_.pop_front();
    }
    if (free_ > now || !in.ready_at(now)) return;
    const MemoryRequest request = in.pop(now);
    got.push_back({now / kCycle, request});
    if (request.kind != MemoryRequest::Kind::kWrite && request.kind != MemoryRequest::Kind::kWritePart)
      waiting_.push_back({now / kCycle + latency_, {request.line, request.tag, request.sectors}});
    free_ = after(now, 1);
  }
  /// "cycle:kind line/sectors" of each request.
  [[nodiscard]] std::string text() const {
    std::string all;
    for (const Timed<MemoryRequest>& t : got) {
      all += fmt::format("{}{}:{}{}/{:x}", all.empty() ? "" : " ", t.cycle, letter_of(t.token.kind),
                         t.token.line, t.token.sectors);
    }
    return all;
  }
  /// Requests of one kind.
  [[nodiscard]] int count(MemoryRequest::Kind kind) const {
    int n = 0;
    for (const Timed<MemoryRequest>& t : got) n += static_cast<int>(t.token.kind == kind);
    return n;
  }
  bool finished() const override { return waiting_.empty(); }
  std::vector<Timed<MemoryRequest>> got;

 private:
  int latency_;
  std::deque<Timed<MemoryResponse>> waiting_;
  Tick free_ = 0;
};

/// Owns the stubs and links around a unit. Derive from it, with the unit and its stores as members, and call
/// `add` and the wiring in the constructor.
class Bench : public contract::Specimen {
 public:
  Bench(Driver& driver, const contract::Variation& variation) : driver_(driver), variation_(variation) {}

  void add(Unit& unit) { driver_.add(unit); }
  template <class T>
  StubSource<T>& feed(FifoIn<T>& port, std::vector<Timed<T>> script, LinkSpec spec = kWide) {
    auto stub = std::make_unique<StubSource<T>>(name("source").c_str(), clock, std::move(script));
    connect<T>(stub->out, port, spec);
    return keep(std::move(stub));
  }
  template <class T>
  StubSink<T>& drain(FifoOut<T>& port, typename StubSink<T>::Key key, Pace pace = {}, LinkSpec spec = kWide) {
    auto stub = std::make_unique<StubSink<T>>(name("sink").c_str(), clock, pace, std::move(key));
    connect<T>(port, stub->in, spec);
    return keep(std::move(stub));
  }
  /// Answers a memory port of one slice.
  StubMemory& serve(MemoryPort& port, int latency) {
    return serve(*port.request_out[0], port.response_in[0], latency);
  }
  StubMemory& serve(FifoOut<MemoryRequest>& requests, FifoIn<MemoryResponse>& answers, int latency) {
    auto stub = std::make_unique<StubMemory>(name("memory").c_str(), clock, latency);
    connect<MemoryRequest>(requests, stub->in, kWide);
    connect<MemoryResponse>(stub->out, answers, kWide);
    return keep(std::move(stub));
  }
  template <class T, class Out, class In>
  Fifo<T>& connect(Out& out, In& in, const LinkSpec& spec) {
    auto link = std::make_unique<Fifo<T>>(name("link").c_str(), variation_.link(spec));
    out.bind(*link);
    in.bind(*link);
    Fifo<T>& kept = *link;
    links_.push_back(std::move(link));
    return kept;
  }

  [[nodiscard]] std::uint64_t digest() const override {
    std::string all;
    for (const auto& stub : stubs_) all += stub->keys() + ';';
    return std::hash<std::string>{}(all);
  }
  /// Every script was played, and nothing is left in a link.
  [[nodiscard]] bool finished() const override {
    for (const auto& stub : stubs_) {
      if (!stub->finished()) return false;
    }
    for (const auto& link : links_) {
      if (link->occupancy() > 0) return false;
    }
    return true;
  }

  /// What the machine would tell the unit: one of each neighbour unless `machine` says more.
  [[nodiscard]] UnitContext context(MachineCounts machine = {}, int number = 0) {
    return {clock, frame, device, machine, number};
  }
  const Clock clock{1'000'000'000};
  Frame frame;
  models::DeviceMemory device;

 private:
  static constexpr LinkSpec kWide{.depth = 64, .width = 8};
  [[nodiscard]] std::string name(const char* what) { return fmt::format("{}_{}", what, names_++); }
  template <class S>
  S& keep(std::unique_ptr<S> stub) {
    S& kept = *stub;
    driver_.add(kept);
    stubs_.push_back(std::move(stub));
    return kept;
  }

  Driver& driver_;
  contract::Variation variation_;
  std::vector<std::unique_ptr<StubUnit>> stubs_;
  std::vector<std::unique_ptr<FifoBase>> links_;
  int names_ = 0;
};

/// The cache of any unit that has one: its lines, ways and misses under way.
template <class Params>
void set_cache(Params& params, int lines, int ways, int misses) {
  params.cache_lines.set(lines);
  params.cache_ways.set(ways);
  params.cache_misses.set(misses);
}

/// A counter of a unit by name.
[[nodiscard]] inline std::uint64_t counter(const Unit& unit, std::string_view name) {
  for (const Counter* c : unit.stats()->counters()) {
    if (c->name() == name) return c->value();
  }
  throw std::runtime_error(fmt::format("no counter {}", name));
}

/// Builds a bench in a process of its own, runs it until nothing can act, and returns what `read` says of it.
template <class B, class Read>
std::string run(const typename B::Setup& setup, Read read) {
  return contract::in_child([&] {
    Dispatcher driver("driver");
    B bench(driver, contract::Variation{}, setup);
    driver.run({});
    return std::string(read(bench));
  });
}

/// The contract harness over a bench: no violation is an empty text. `same_order` is false where a shallow
/// link may change the order of tokens.
template <class B>
std::string contract_text(const typename B::Setup& setup, bool same_order = true) {
  const contract::Builder build = [&](Driver& driver,
                                      const contract::Variation& v) -> std::unique_ptr<contract::Specimen> {
    return std::make_unique<B>(driver, v, setup);
  };
  std::string all;
  for (const std::string& line : contract::violations(
           build, {.shuffles = 2, .creations = 0, .digest_at_depth_one = same_order, .timeout_s = 20}))
    all += line + '\n';
  return all;
}

}  // namespace quadrille::hw::bench
