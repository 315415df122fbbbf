#include "hw/base/fifo.h"

#include "hw/base/unit.h"

#include <bit>

namespace quadrille::hw {

namespace {
/// Cycles a token needs to cross between two clock domains, on top of the link's latency: a two-flop
/// synchroniser. [P: Ginosar 2011, two-flop synchronizer]
constexpr int kCrossingCycles = 2;
}  // namespace

FifoBase::FifoBase(const char* name, const LinkSpec& spec, std::size_t token_bytes)
    : sc_core::sc_object(name), depth_(spec.depth), width_(spec.width), spec_(spec) {
  QUADRILLE_CHECK(spec.depth >= 1 && spec.width >= 1 && spec.latency >= 1 && spec.credit_latency >= 1,
                  "link {}: depth {}, width {}, latency {}, credit latency {}", name, spec.depth, spec.width,
                  spec.latency, spec.credit_latency);
  storage_ = std::make_unique<std::byte[]>(stamp_bytes(depth_) +
                                           static_cast<std::size_t>(depth_) *
                                               token_bytes);  // zeroes: every slot is free from tick 0 on
}

void FifoBase::bind_producer(Unit& unit) {
  QUADRILLE_CHECK(producer_ == nullptr, "link {} has two producers", path());
  producer_ = &unit;
}

void FifoBase::bind_consumer(Unit& unit) {
  QUADRILLE_CHECK(consumer_ == nullptr, "link {} has two consumers", path());
  consumer_ = &unit;
}

bool FifoBase::crosses_clocks() const { return !producer_->clock().same_domain(consumer_->clock()); }

void FifoBase::elaborate() {
  QUADRILLE_CHECK(producer_ != nullptr && consumer_ != nullptr, "link {} lacks a producer or a consumer",
                  path());
  if (crosses_clocks()) {
    spec_.latency += kCrossingCycles;
    spec_.credit_latency += kCrossingCycles;
  }
  const Clock& from = producer_->clock();
  const Clock& to = consumer_->clock();
  producer_period_ = from.uniform() ? from.period() : 0;
  // n cycles from any edge on take at least edge(n): floor(a + b) >= floor(a) + floor(b).
  forward_ = to.edge(spec_.latency);
  credit_ = from.edge(spec_.credit_latency);
  // also where one of them is a faster clock of the domain: nothing waits for an edge there
  if (!crosses_clocks() && from.uniform() && to.uniform()) {
    forward_step_ = forward_;
    credit_step_ = credit_;
  }
  consumer_word_ = consumer_->touched_word();
  producer_word_ = producer_->touched_word();
  consumer_bit_ = static_cast<std::uint8_t>(std::countr_zero(consumer_->touched_bit()));
  producer_bit_ = static_cast<std::uint8_t>(std::countr_zero(producer_->touched_bit()));
}

Tick FifoBase::crossed_push(Tick now) const {
  QUADRILLE_CHECK(consumer_word_ != nullptr, "push into {} before the driver runs", path());
  const Clock& to = consumer_->clock();
  return to.edge(to.edges_before(now) + spec_.latency);
}

Tick FifoBase::crossed_pop(Tick now) const {
  QUADRILLE_CHECK(producer_word_ != nullptr, "pop from {} before the driver runs", path());
  const Clock& from = producer_->clock();
  return from.edge(from.edges_before(now) + spec_.credit_latency);
}

Tick FifoBase::crossed_cycle(Tick now) const { return producer_->clock().after(now, 1); }

int FifoBase::free_slots(Tick now) const {
  if (credit_step_ != 0 && last_pop_ + credit_step_ <= now) return depth_ - count_;
  int n = 0;
  for (std::uint32_t i = tail_; n < depth_ - count_ && stamps()[i] <= now; i = wrap(i)) ++n;
  return n;
}

void FifoBase::refuse_push(Tick now) const {
  QUADRILLE_CHECK(false, "push into {} at {} fs without room", path(), now);
  std::abort();
}
void FifoBase::refuse_pop(Tick now) const {
  QUADRILLE_CHECK(false, "pop from {} at {} fs without a token", path(), now);
  std::abort();
}

PortBase::PortBase(Unit& owner, const char* name, Direction direction, LinkRole role, int stream)
    : owner_(owner),
      name_(name),
      direction_(direction),
      role_(role),
      stream_(stream),
      number_(static_cast<std::uint32_t>(owner.ports().size())) {
  owner.add_port(*this);
}

std::int64_t PortBase::waited() const { return owner_.to_cycles(waited_); }

}  // namespace quadrille::hw
