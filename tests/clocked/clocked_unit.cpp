#include "tests/clocked/clocked_unit.h"

namespace quadrille::clocked {

using namespace hw::world;

ClockedUnit::ClockedUnit(const UnitSpec& spec)
    : in(static_cast<std::size_t>(spec.inputs)),
      out(static_cast<std::size_t>(spec.outputs)),
      spec_(spec),
      places_(static_cast<std::size_t>(spec.slots)) {}

void ClockedUnit::tick(std::int64_t now) {
  now_ = now;
  if (spec_.role == Role::kMemory) {
    for (Place& p : places_) p.cycles_left -= p.phase == Place::Phase::kWait ? 1 : 0;
  }
  if (busy_edges_ > 0) {
    --busy_edges_;
    return;
  }
  for (int n = 1; n <= spec_.rate; ++n) {
    const int cycles = try_one();
    if (cycles == 0) return;
    if (n == spec_.rate) busy_edges_ = cycles - 1;
  }
}

int ClockedUnit::try_one() {
  switch (spec_.role) {
    case Role::kSource:
    case Role::kSink: return generate_or_eat();
    case Role::kStage:
    case Role::kFork:
    case Role::kRoute:
    case Role::kRecycle:
    case Role::kJoin: return move_one();
    case Role::kSerial:
    case Role::kExpand:
    case Role::kPack: return hold_one();
    case Role::kArbiter:
    case Role::kPriority: return merge();
    case Role::kSpread: return spread();
    case Role::kCore: return core();
    case Role::kMemory: return memory();
  }
  return 0;
}

int ClockedUnit::done(char what, std::size_t port, std::uint32_t id, int cycles) {
  events.push_back({now_, what, static_cast<std::uint8_t>(port), id});
  return cycles;
}

int ClockedUnit::generate_or_eat() {
  if (spec_.role == Role::kSink) {
    if (!ready(0)) return 0;
    return done('<', 0, pop(0).id, cost(spec_, number_++));
  }
  if (number_ >= static_cast<std::uint32_t>(spec_.count) || !room(0)) return 0;
  const std::uint32_t id = mix(spec_.seed, number_);
  push(0, {id, 0});
  return done('>', 0, id, cost(spec_, number_++));
}

int ClockedUnit::move_one() {
  for (std::size_t i = 0; i < in.size(); ++i)
    if (!ready(i)) return 0;
  std::size_t first = 0, last = out.size();
  const Token front = in[0].link->front();
  if (spec_.role == Role::kRoute) first = mix(front.id, 5) % out.size();
  if (spec_.role == Role::kRecycle) first = front.hops < 12 && mix(front.id, front.hops) % 3 == 0 ? 1 : 0;
  if (spec_.role != Role::kFork) last = first + 1;
  for (std::size_t o = first; o < last; ++o)
    if (!room(o)) return 0;
  Token token = front;
  if (spec_.role == Role::kJoin) {
    token = {};
    for (std::size_t i = 0; i < in.size(); ++i) token.id = mix(token.id, pop(i).id);
  } else {
    pop(0);
    if (spec_.role != Role::kFork) ++token.hops;
  }
  for (std::size_t o = first; o < last; ++o) push(o, token);
  return done('x', first, token.id, cost(spec_, token.id));
}

int ClockedUnit::hold_one() {
  const bool take = spec_.role == Role::kPack ? held_count_ < spec_.count : held_count_ == 0;
  if (take ? !ready(0) : !room(0)) return 0;
  if (take) {
    const Token token = pop(0);
    if (spec_.role == Role::kPack) {
      held_.id = mix(held_.id, token.id);
      ++held_count_;
      return done('<', 0, token.id, cost(spec_, held_.id));
    }
    held_ = token;
    held_count_ = spec_.role == Role::kSerial
                      ? 1
                      : 1 + static_cast<int>(mix(token.id, 9) % static_cast<std::uint32_t>(spec_.count));
    return done('<', 0, token.id,
                spec_.role == Role::kSerial ? service(spec_, token.id) : cost(spec_, token.id));
  }
  Token token = held_;
  if (spec_.role == Role::kPack) {
    held_count_ = 0;
    token.hops = 0;
  } else {
    --held_count_;
    if (spec_.role == Role::kExpand) token = {mix(held_.id, static_cast<std::uint32_t>(held_count_)), 0};
  }
  push(0, token);
  return done('>', 0, token.id, cost(spec_, held_.id));
}

int ClockedUnit::merge() {
  if (!room(0)) return 0;
  for (std::size_t n = 0; n < in.size(); ++n) {
    const std::size_t i = spec_.role == Role::kArbiter ? (turn_ + n) % in.size() : n;
    if (!ready(i)) continue;
    turn_ = (i + 1) % in.size();
    Token token = pop(i);
    ++token.hops;
    push(0, token);
    return done('x', i, token.id, cost(spec_, token.id));
  }
  return 0;
}

int ClockedUnit::spread() {
  if (!ready(0)) return 0;
  for (std::size_t n = 0; n < out.size(); ++n) {
    const std::size_t o = (turn_ + n) % out.size();
    if (!room(o)) continue;
    turn_ = (o + 1) % out.size();
    const Token token = pop(0);
    push(o, token);
    return done('x', o, token.id, cost(spec_, token.id));
  }
  return 0;
}

ClockedUnit::Place* ClockedUnit::find(Place::Phase phase) {
  for (Place& p : places_)
    if (p.phase == phase) return &p;
  return nullptr;
}

int ClockedUnit::core() {
  using Phase = Place::Phase;
  if (ready(1)) {
    const Token reply = pop(1);
    Place& p = places_[reply.hops];
    p.phase = --p.requests_left > 0 ? Phase::kAsk : Phase::kReady;
    return done('y', 1, reply.id, cost(spec_, reply.id));
  }
  if (Place* p = find(Phase::kReady); p != nullptr && room(0)) {
    p->phase = Phase::kEmpty;
    push(0, p->token);
    return done('e', 0, p->token.id, cost(spec_, p->token.id));
  }
  if (Place* p = find(Phase::kAsk); p != nullptr && room(1)) {
    p->phase = Phase::kWait;
    const std::uint32_t id = mix(p->token.id, static_cast<std::uint32_t>(p->requests_left));
    push(1, {id, static_cast<std::uint32_t>(p - places_.data())});
    return done('r', 1, id, cost(spec_, id));
  }
  if (Place* p = find(Phase::kEmpty); p != nullptr && ready(0)) {
    p->phase = Phase::kAsk;
    p->requests_left = spec_.count;
    p->token = pop(0);
    return done('a', 0, p->token.id, cost(spec_, p->token.id));
  }
  return 0;
}

int ClockedUnit::memory() {
  using Phase = Place::Phase;
  Place* longest = nullptr;  // done for the longest time, of those whose output has room
  for (Place& p : places_) {
    if (p.phase != Phase::kWait || p.cycles_left > 0 || !room(p.port)) continue;
    const bool before = longest == nullptr || p.cycles_left < longest->cycles_left ||
                        (p.cycles_left == longest->cycles_left && p.order < longest->order);
    if (before) longest = &p;
  }
  if (longest != nullptr) {
    longest->phase = Phase::kEmpty;
    push(longest->port, longest->token);
    return done('y', longest->port, longest->token.id, cost(spec_, longest->token.id));
  }
  Place* place = find(Phase::kEmpty);
  if (place == nullptr) return 0;
  for (std::size_t n = 0; n < in.size(); ++n) {
    const std::size_t i = (turn_ + n) % in.size();
    if (!ready(i)) continue;
    turn_ = (i + 1) % in.size();
    const Token token = pop(i);
    *place = {Phase::kWait, service(spec_, token.id), 0, accepted_++, i, token};
    return done('a', i, token.id, cost(spec_, token.id));
  }
  return 0;
}

}  // namespace quadrille::clocked
