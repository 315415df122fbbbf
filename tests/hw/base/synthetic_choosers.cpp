/// The synthetic units that choose: by which input is ready first, or by where there is room.
#include "tests/hw/base/synthetic_unit.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw::world {
namespace {

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
    for (std::size_t i = 1; i < outputs_.size(); ++i)
      wake = Wake::sooner(wake, own().input(*inputs_[0]).output(*outputs_[i]));
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
  Core(sc_core::sc_module_name name, const UnitSpec& spec, const Clock& clock,
       const std::vector<LinkRole>& roles)
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
  std::string state_text() const override {
    return fmt::format("{} of {} contexts", spec_.slots - std::popcount(free_), spec_.slots);
  }

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
    Wake wake = slots_.size() < static_cast<std::size_t>(spec_.slots) ? own().input(earliest(inputs_))
                                                                      : Wake::never(*inputs_[0]);
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
  std::string state_text() const override {
    return fmt::format("{} of {} slots", slots_.size(), spec_.slots);
  }

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

}  // namespace

std::unique_ptr<SyntheticUnit> make_chooser(const UnitSpec& s, const Clock& clock,
                                            const std::vector<LinkRole>& roles) {
  const char* name = s.name.c_str();
  switch (s.role) {
    case Role::kArbiter:
    case Role::kPriority: return std::make_unique<Merge>(name, s, clock, roles);
    case Role::kSpread: return std::make_unique<Spread>(name, s, clock, roles);
    case Role::kCore: return std::make_unique<Core>(name, s, clock, roles);
    case Role::kMemory: return std::make_unique<Memory>(name, s, clock, roles);
    case Role::kSource:
    case Role::kStage:
    case Role::kSerial:
    case Role::kFork:
    case Role::kRoute:
    case Role::kRecycle:
    case Role::kJoin:
    case Role::kExpand:
    case Role::kPack:
    case Role::kSink: break;
  }
  return nullptr;
}

}  // namespace quadrille::hw::world
