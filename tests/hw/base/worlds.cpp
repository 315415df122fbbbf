#include "tests/hw/base/worlds.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <random>

namespace quadrille::hw::world {

SyntheticUnit::SyntheticUnit(sc_core::sc_module_name name, const UnitSpec& spec, const Clock& clock,
                             const std::vector<LinkRole>& input_roles)
    : Unit(name, is_chooser(spec.role) && !spec.declared_fixed ? Kind::kChooser : Kind::kFixedOrder, clock), spec_(spec) {
  for (int i = 0; i < spec.inputs; ++i) { inputs_.add(*this, fmt::format("in{}", i), input_roles[static_cast<std::size_t>(i)]); }
  for (int i = 0; i < spec.outputs; ++i) outputs_.add(*this, fmt::format("out{}", i), LinkRole::kFlow);
}

namespace {

class Source final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;
  Wake next() const override { return sent_ == spec_.count ? Wake(kNever) : own().output(*outputs_[0]); }
  void act(Tick now) override {
    const auto number = static_cast<std::uint32_t>(sent_++);
    const std::uint32_t id = mix(spec_.seed, number);
    outputs_[0]->push(now, {id, 0});
    note(now, '>', 0, id);
    use(now, cost(spec_, number));
  }

 private:
  int sent_ = 0;
};

class Sink final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;
  Wake next() const override { return own().input(*inputs_[0]); }
  void act(Tick now) override {
    const std::uint32_t id = inputs_[0]->pop(now).id;
    note(now, '<', 0, id);
    use(now, cost(spec_, taken_++));
  }

 private:
  std::uint32_t taken_ = 0;
};

class Stage final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;
  Wake next() const override { return own().input(*inputs_[0]).output(*outputs_[0]); }
  void act(Tick now) override {
    const Token token = inputs_[0]->pop(now);
    outputs_[0]->push(now, {token.id, token.hops + 1});
    note(now, 'x', 0, token.id);
    use(now, cost(spec_, token.id));
  }
};

class Serial final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;
  Wake next() const override { return holds_ ? own().output(*outputs_[0]) : own().input(*inputs_[0]); }
  void act(Tick now) override {
    if (holds_) {
      outputs_[0]->push(now, token_);
      note(now, '>', 0, token_.id);
      use(now, cost(spec_, token_.id));
    } else {
      token_ = inputs_[0]->pop(now);
      note(now, '<', 0, token_.id);
      use(now, service(spec_, token_.id));
    }
    holds_ = !holds_;
  }

 private:
  Token token_;
  bool holds_ = false;
};

class Fork final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;
  Wake next() const override {
    Wake wake = own().input(*inputs_[0]);
    for (const auto& out : outputs_) wake.output(*out);
    return wake;
  }
  void act(Tick now) override {
    const Token token = inputs_[0]->pop(now);
    for (auto& out : outputs_) out->push(now, token);
    note(now, 'x', 0, token.id);
    use(now, cost(spec_, token.id));
  }
};

/// Route and recycle: the front token names the output.
class Router final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;
  Wake next() const override {
    Wake wake = own().input(*inputs_[0]);
    return inputs_[0]->ready() == kNever ? wake : wake.output(*outputs_[target(inputs_[0]->front())]);
  }
  void act(Tick now) override {
    const Token token = inputs_[0]->pop(now);
    const std::size_t port = target(token);
    outputs_[port]->push(now, {token.id, token.hops + 1});
    note(now, 'x', static_cast<int>(port), token.id);
    use(now, cost(spec_, token.id));
  }

 private:
  [[nodiscard]] std::size_t target(const Token& token) const {
    if (spec_.role == Role::kRoute) return mix(token.id, 5) % outputs_.size();
    return token.hops < 12 && mix(token.id, token.hops) % 3 == 0 ? 1 : 0;
  }
};

class Join final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;
  Wake next() const override {
    Wake wake = own();
    for (const auto& in : inputs_) wake.input(*in);
    return wake.output(*outputs_[0]);
  }
  void act(Tick now) override {
    std::uint32_t id = 0;
    for (auto& in : inputs_) id = mix(id, in->pop(now).id);
    outputs_[0]->push(now, {id, 0});
    note(now, 'x', 0, id);
    use(now, cost(spec_, id));
  }
};

class Expand final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;
  Wake next() const override { return left_ == 0 ? own().input(*inputs_[0]) : own().output(*outputs_[0]); }
  void act(Tick now) override {
    if (left_ == 0) {
      token_ = inputs_[0]->pop(now);
      left_ = 1 + mix(token_.id, 9) % static_cast<std::uint32_t>(spec_.count);
      note(now, '<', 0, token_.id);
    } else {
      --left_;
      outputs_[0]->push(now, {mix(token_.id, left_), 0});
      note(now, '>', 0, mix(token_.id, left_));
    }
    use(now, cost(spec_, token_.id));
  }

 private:
  Token token_;
  std::uint32_t left_ = 0;
};

class Pack final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;
  Wake next() const override { return held_ < spec_.count ? own().input(*inputs_[0]) : own().output(*outputs_[0]); }
  void act(Tick now) override {
    if (held_ < spec_.count) {
      const std::uint32_t id = inputs_[0]->pop(now).id;
      id_ = mix(id_, id);
      ++held_;
      note(now, '<', 0, id);
    } else {
      held_ = 0;
      outputs_[0]->push(now, {id_, 0});
      note(now, '>', 0, id_);
    }
    use(now, cost(spec_, id_));
  }

 private:
  std::uint32_t id_ = 0;
  int held_ = 0;
};

/// The input whose token is visible first; the lowest on a tie.
const FifoIn<Token>& earliest(const Ports<FifoIn<Token>>& inputs) {
  const FifoIn<Token>* first = &*inputs[0];
  Tick ready = first->ready();
  for (const auto& in : inputs) {
    const Tick t = in->ready();
    const bool sooner = t < ready;
    ready = sooner ? t : ready;
    first = sooner ? &*in : first;
  }
  return *first;
}

/// Arbiter and priority: an input that is ready; round robin or the lowest first.
class Merge final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;
  Wake next() const override { return own().input(earliest(inputs_)).output(*outputs_[0]); }
  void act(Tick now) override {
    std::size_t i = spec_.role == Role::kArbiter ? turn_ : 0;
    while (!inputs_[i]->ready_at(now)) i = i + 1 == inputs_.size() ? 0 : i + 1;
    turn_ = i + 1 == inputs_.size() ? 0 : i + 1;
    const Token token = inputs_[i]->pop(now);
    outputs_[0]->push(now, {token.id, token.hops + 1});
    note(now, 'x', static_cast<int>(i), token.id);
    use(now, cost(spec_, token.id));
  }

 private:
  std::size_t turn_ = 0;
};

class Spread final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;
  Wake next() const override {
    Wake wake = own().input(*inputs_[0]).output(*outputs_[0]);
    for (std::size_t i = 1; i < outputs_.size(); ++i) wake = Wake::sooner(wake, own().input(*inputs_[0]).output(*outputs_[i]));
    return wake;
  }
  void act(Tick now) override {
    std::size_t i = turn_;
    while (!outputs_[i]->room_at(now)) i = i + 1 == outputs_.size() ? 0 : i + 1;
    turn_ = i + 1 == outputs_.size() ? 0 : i + 1;
    const Token token = inputs_[0]->pop(now);
    outputs_[i]->push(now, token);
    note(now, 'x', static_cast<int>(i), token.id);
    use(now, cost(spec_, token.id));
  }

 private:
  std::size_t turn_ = 0;
};

class Core final : public SyntheticUnit {
 public:
  Core(sc_core::sc_module_name name, const UnitSpec& spec, const Clock& clock, const std::vector<LinkRole>& roles)
      : SyntheticUnit(name, spec, clock, roles),
        contexts_(static_cast<std::size_t>(spec.slots)),
        free_((std::uint64_t{1} << spec.slots) - 1) {}

  Wake next() const override {
    Wake wake = own().input(*inputs_[1]);
    wake = Wake::sooner(wake, own_if(emit_).output(*outputs_[0]));
    wake = Wake::sooner(wake, own_if(ask_).output(*outputs_[1]));
    return Wake::sooner(wake, own_if(free_).input(*inputs_[0]));
  }
  void act(Tick now) override {
    if (inputs_[1]->ready_at(now)) take_reply(now);
    else if (emit_ != 0 && outputs_[0]->room_at(now)) emit(now);
    else if (ask_ != 0 && outputs_[1]->room_at(now)) ask(now);
    else accept(now);
  }
  std::string state_text() const override { return fmt::format("{} of {} contexts", spec_.slots - std::popcount(free_), spec_.slots); }

 private:
  struct Context {
    int left = 0;
    std::uint32_t id = 0, hops = 0;
  };
  [[nodiscard]] Wake own_if(std::uint64_t set) const { return Wake(set != 0 ? own().at() : kNever); }
  /// Takes the lowest context out of a set.
  std::uint32_t take(std::uint64_t& set) {
    const int i = std::countr_zero(set);
    set &= set - 1;
    return static_cast<std::uint32_t>(i);
  }
  void take_reply(Tick now) {
    const Token reply = inputs_[1]->pop(now);
    (--contexts_[reply.hops].left > 0 ? ask_ : emit_) |= std::uint64_t{1} << reply.hops;
    note(now, 'y', 1, reply.id);
    use(now, cost(spec_, reply.id));
  }
  void emit(Tick now) {
    const std::uint32_t i = take(emit_);
    free_ |= std::uint64_t{1} << i;
    const Context& c = contexts_[i];
    outputs_[0]->push(now, {c.id, c.hops});
    note(now, 'e', 0, c.id);
    use(now, cost(spec_, c.id));
  }
  void ask(Tick now) {
    const std::uint32_t i = take(ask_);
    const std::uint32_t id = mix(contexts_[i].id, static_cast<std::uint32_t>(contexts_[i].left));
    outputs_[1]->push(now, {id, i});
    note(now, 'r', 1, id);
    use(now, cost(spec_, id));
  }
  void accept(Tick now) {
    const std::uint32_t i = take(free_);
    ask_ |= std::uint64_t{1} << i;
    const Token token = inputs_[0]->pop(now);
    contexts_[i] = {spec_.count, token.id, token.hops};
    note(now, 'a', 0, token.id);
    use(now, cost(spec_, token.id));
  }

  std::vector<Context> contexts_;
  std::uint64_t free_, ask_ = 0, emit_ = 0;  ///< sets of contexts; the others wait for a reply
};

class Memory final : public SyntheticUnit {
 public:
  using SyntheticUnit::SyntheticUnit;

  Wake next() const override {
    Wake wake = slots_.size() < static_cast<std::size_t>(spec_.slots) ? own().input(earliest(inputs_)) : Wake::never(*inputs_[0]);
    for (const Slot& s : slots_) {
      if (s.done >= wake.at()) break;
      const Wake reply = Wake(std::max(own().at(), s.done)).output(*outputs_[s.port]);
      if (reply.at() < wake.at()) wake = reply;
    }
    return wake;
  }
  void act(Tick now) override {
    for (auto s = slots_.begin(); s != slots_.end() && s->done <= now; ++s) {
      if (outputs_[s->port]->room_at(now)) return reply(now, s);
    }
    accept(now);
  }
  std::string state_text() const override { return fmt::format("{} of {} slots", slots_.size(), spec_.slots); }

 private:
  struct Slot {
    Tick done = kNever;
    std::size_t port = 0;
    Token token;
  };
  void reply(Tick now, std::vector<Slot>::iterator s) {
    const Slot slot = *s;
    slots_.erase(s);
    outputs_[slot.port]->push(now, slot.token);
    note(now, 'y', static_cast<int>(slot.port), slot.token.id);
    use(now, cost(spec_, slot.token.id));
  }
  void accept(Tick now) {
    std::size_t i = turn_;
    while (!inputs_[i]->ready_at(now)) i = i + 1 == inputs_.size() ? 0 : i + 1;
    turn_ = i + 1 == inputs_.size() ? 0 : i + 1;
    const Token token = inputs_[i]->pop(now);
    const Slot slot{after(now, service(spec_, token.id)), i, token};
    auto behind = slots_.end();
    while (behind != slots_.begin() && std::prev(behind)->done > slot.done) --behind;
    slots_.insert(behind, slot);
    note(now, 'a', static_cast<int>(i), token.id);
    use(now, cost(spec_, token.id));
  }

  std::vector<Slot> slots_;  ///< by time done, then by time accepted
  std::size_t turn_ = 0;
};

std::vector<std::size_t> shuffled(std::size_t n, std::uint64_t seed) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937_64 random(seed);
  for (std::size_t i = n; seed != 0 && i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

}  // namespace

std::unique_ptr<SyntheticUnit> make_unit(const UnitSpec& s, const Clock& clock, const std::vector<LinkRole>& roles) {
  const char* name = s.name.c_str();
  switch (s.role) {
    case Role::kSource: return std::make_unique<Source>(name, s, clock, roles);
    case Role::kStage: return std::make_unique<Stage>(name, s, clock, roles);
    case Role::kSerial: return std::make_unique<Serial>(name, s, clock, roles);
    case Role::kFork: return std::make_unique<Fork>(name, s, clock, roles);
    case Role::kRoute:
    case Role::kRecycle: return std::make_unique<Router>(name, s, clock, roles);
    case Role::kJoin: return std::make_unique<Join>(name, s, clock, roles);
    case Role::kExpand: return std::make_unique<Expand>(name, s, clock, roles);
    case Role::kPack: return std::make_unique<Pack>(name, s, clock, roles);
    case Role::kArbiter:
    case Role::kPriority: return std::make_unique<Merge>(name, s, clock, roles);
    case Role::kSpread: return std::make_unique<Spread>(name, s, clock, roles);
    case Role::kCore: return std::make_unique<Core>(name, s, clock, roles);
    case Role::kMemory: return std::make_unique<Memory>(name, s, clock, roles);
    case Role::kSink: return std::make_unique<Sink>(name, s, clock, roles);
  }
  return nullptr;
}

World::World(const WorldSpec& spec, Driver& driver, const contract::Variation& variation, bool record)
    : trace_(spec.units.size()), units_(spec.units.size()), links_(spec.wires.size()) {
  for (const std::size_t i : shuffled(spec.units.size(), variation.creation_seed)) {
    const UnitSpec& u = spec.units[i];
    std::vector<LinkRole> roles(static_cast<std::size_t>(u.inputs), LinkRole::kFlow);
    for (const WireSpec& w : spec.wires) {
      if (w.reply && w.to.unit == static_cast<int>(i)) roles[static_cast<std::size_t>(w.to.port)] = LinkRole::kReply;
    }
    units_[i] = make_unit(u, Clock(spec.clocks_hz[static_cast<std::size_t>(u.clock)]), roles);
    if (record) units_[i]->record_into(trace_[i]);
  }
  for (const std::size_t i : shuffled(spec.wires.size(), variation.creation_seed)) {
    const WireSpec& w = spec.wires[i];
    SyntheticUnit& from = unit(w.from.unit);
    SyntheticUnit& to = unit(w.to.unit);
    const LinkSpec link = variation.link({.depth = w.depth, .width = w.width, .latency = w.latency, .credit_latency = w.credit});
    links_[i] = std::make_unique<Fifo<Token>>(fmt::format("link_{}_{}", from.basename(), w.from.port).c_str(), link);
    from.out(w.from.port).bind(*links_[i]);
    to.in(w.to.port).bind(*links_[i]);
  }
  for (const auto& u : units_) driver.add(*u);
}

std::uint64_t World::digest() const {
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&hash](std::uint64_t v) { hash = (hash ^ v) * 1099511628211u; };
  for (const auto& events : trace_) {
    add(events.size());
    for (const Event& e : events) {
      add(static_cast<std::uint64_t>(e.at));
      add(static_cast<std::uint64_t>(e.what) << 40 | static_cast<std::uint64_t>(e.port) << 32 | e.id);
    }
  }
  return hash;
}

}  // namespace quadrille::hw::world
