/// The synthetic units whose next action depends on their own state and tokens alone.
#include "tests/hw/base/synthetic_unit.h"

namespace quadrille::hw::world {
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
  Wake next() const override {
    return held_ < spec_.count ? own().input(*inputs_[0]) : own().output(*outputs_[0]);
  }
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

}  // namespace

std::unique_ptr<SyntheticUnit> make_fixed_order(const UnitSpec& s, const Clock& clock,
                                                const std::vector<LinkRole>& roles) {
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
    case Role::kSink: return std::make_unique<Sink>(name, s, clock, roles);
    case Role::kArbiter:
    case Role::kPriority:
    case Role::kSpread:
    case Role::kCore:
    case Role::kMemory: break;
  }
  return nullptr;
}

}  // namespace quadrille::hw::world
