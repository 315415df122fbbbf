/// The only way units meet: bounded FIFOs with a depth, a width and a latency each way, and the ports that
/// bind to them.
///
/// A token pushed at tick t is visible to the consumer `latency` consumer cycles later; a slot freed at t is
/// usable by the producer `credit_latency` producer cycles later. Entries carry their ready tick and slots
/// their release tick, so either end may be simulated ahead of the other and still see what it would have
/// seen at its own time. Full rate needs depth >= width * (latency + credit_latency); a shallower FIFO is
/// legal and slower.
#pragma once

#include "hw/base/clock.h"

#include <functional>
#include <memory>
#include <string>
#include <systemc>
#include <vector>

namespace quadrille::hw {

class Unit;

/// What a link owns. Cycles are of the receiving side's clock: the consumer's for `latency`, the producer's
/// for `credit_latency`.
struct LinkSpec {
  int depth = 4;           ///< tokens
  int width = 1;           ///< tokens a producer cycle
  int latency = 1;         ///< cycles, at least 1
  int credit_latency = 1;  ///< cycles, at least 1
};

/// Does a token of this link carry work of a draw onward, or only answer the unit's own request? Decides what
/// "idle" means (Unit).
enum class LinkRole : std::uint8_t { kFlow, kReply };

/// Timing half of a FIFO: who may push and pop when. Knows nothing of the payload.
///
/// Each slot has one time stamp: when its token becomes visible while it holds one, when it may be filled
/// again while it holds none. `ready_` and `room_` keep what either end asks for, so that asking is one load;
/// a peer is marked only when its answer changes (empty to not empty, full to not full).
class FifoBase : public sc_core::sc_interface, public sc_core::sc_object {
 public:
  FifoBase(const char* name, const LinkSpec& spec, std::size_t token_bytes);

  // Producer's side.
  /// Earliest tick at which the next push may happen; kNever while every slot holds a token that was not
  /// popped.
  [[nodiscard]] Tick room() const { return room_; }
  /// Slots that the producer may fill at `now` (ignores the width). For choosers, inside `act`: no mark
  /// follows when it changes.
  [[nodiscard]] int free_slots(Tick now) const;

  // Consumer's side.
  /// Tick at which the oldest token is visible; kNever while there is none.
  [[nodiscard]] Tick ready() const { return ready_; }
  [[nodiscard]] bool ready_at(Tick now) const { return ready_ <= now; }

  /// As given, with the crossing's cost added to the latencies once elaborated.
  [[nodiscard]] const LinkSpec& spec() const { return spec_; }
  [[nodiscard]] int occupancy() const { return count_; }
  [[nodiscard]] std::uint64_t pushes() const { return pushes_; }
  [[nodiscard]] std::uint64_t pops() const { return pushes_ - static_cast<std::uint64_t>(count_); }
  [[nodiscard]] Tick last_push() const { return last_push_; }
  [[nodiscard]] Tick last_pop() const { return last_pop_; }
  /// Sums of the ticks at which tokens were pushed and popped, modulo 2^64. With the numbers of both they say
  /// how many tokens the link held, summed over the time: a token is held from its push to its pop. The sums
  /// are always kept, since to add costs less than to ask whether somebody wants it.
  [[nodiscard]] std::uint64_t push_ticks() const { return push_ticks_; }
  [[nodiscard]] std::uint64_t pop_ticks() const { return pop_ticks_; }
  /// Tokens held, summed over the ticks from 0 to `t`, which is not before the latest push or pop.
  [[nodiscard]] std::uint64_t held_until(Tick t) const {
    return pop_ticks_ - push_ticks_ + static_cast<std::uint64_t>(count_) * static_cast<std::uint64_t>(t);
  }
  [[nodiscard]] Unit* producer() const { return producer_; }
  [[nodiscard]] Unit* consumer() const { return consumer_; }
  [[nodiscard]] std::string path() const { return sc_core::sc_object::name(); }
  /// Smallest time between a push and its visibility, and between a pop and its credit: the look-ahead this
  /// link gives.
  [[nodiscard]] Tick forward_lookahead() const { return forward_; }
  [[nodiscard]] Tick credit_lookahead() const { return credit_; }
  /// The link joins two clock domains and pays for synchronisers each way.
  [[nodiscard]] bool crosses_clocks() const;
  /// A steady flow of `width` tokens a cycle fits: depth >= width * (latency + credit latency), with both
  /// ends on one clock.
  [[nodiscard]] bool full_rate() const {
    return spec_.depth >= spec_.width * (spec_.latency + spec_.credit_latency);
  }
  void bind_producer(Unit& unit);
  void bind_consumer(Unit& unit);
  /// Sets bit `bit` of `word` whenever a token arrives while none is held.
  void mark_arrivals(std::uint64_t& word, int bit) {
    arrival_word_ = &word;
    arrival_mask_ = std::uint64_t{1} << bit;
  }
  /// Precomputes latencies and marks once both ends are known.
  void elaborate();

 protected:
  void note_push(Tick now) {
    if (room_ > now) [[unlikely]]
      refuse_push(now);
    const Tick visible = forward_step_ != 0 ? now + forward_step_ : crossed_push(now);
    stamps()[tail_] = visible;
    if (count_ == 0) {
      ready_ = visible;
      *consumer_word_ |= std::uint64_t{1} << consumer_bit_;
      *arrival_word_ |= arrival_mask_;
    }
    tail_ = wrap(tail_);
    ++count_;
    ++pushes_;
    push_ticks_ += static_cast<std::uint64_t>(now);
    burst_ = last_push_ == now ? burst_ + 1 : 1;
    last_push_ = now;
    if (burst_ == width_) width_free_ = producer_period_ != 0 ? now + producer_period_ : crossed_cycle(now);
    room_ = count_ == depth_ ? kNever : later(stamps()[tail_], width_free_);
  }
  void note_pop(Tick now) {
    if (ready_ > now) [[unlikely]]
      refuse_pop(now);
    const Tick released = credit_step_ != 0 ? now + credit_step_ : crossed_pop(now);
    stamps()[head_] = released;
    if (count_ == depth_) {
      room_ = later(released, width_free_);
      *producer_word_ |= std::uint64_t{1} << producer_bit_;
    }
    head_ = wrap(head_);
    --count_;
    last_pop_ = now;
    pop_ticks_ += static_cast<std::uint64_t>(now);
    ready_ = count_ == 0 ? kNever : stamps()[head_];
  }
  [[nodiscard]] std::size_t head() const { return head_; }
  [[nodiscard]] std::size_t tail() const { return tail_; }
  /// Where the tokens lie: behind the stamps, aligned for any of them.
  [[nodiscard]] std::byte* tokens() const { return storage_.get() + stamp_bytes(depth_); }

 private:
  [[nodiscard]] std::uint32_t wrap(std::uint32_t i) const {
    return i + 1 == static_cast<std::uint32_t>(depth_) ? 0 : i + 1;
  }
  [[nodiscard]] Tick* stamps() const { return reinterpret_cast<Tick*>(storage_.get()); }
  [[nodiscard]] static Tick later(Tick a, Tick b) { return a > b ? a : b; }
  [[nodiscard]] static std::size_t stamp_bytes(int depth) {
    return (static_cast<std::size_t>(depth) * sizeof(Tick) + 15) / 16 * 16;
  }
  [[nodiscard]] Tick crossed_push(Tick now) const;
  [[nodiscard]] Tick crossed_pop(Tick now) const;
  [[nodiscard]] Tick crossed_cycle(Tick now) const;
  [[noreturn]] void refuse_push(Tick now) const;
  [[noreturn]] void refuse_pop(Tick now) const;

  // What most pushes, pops and questions touch: two cache lines, then the stamps and tokens.
  alignas(64) Tick ready_ = kNever;
  Tick room_ = 0;
  std::unique_ptr<std::byte[]> storage_;  ///< `depth` stamps, then `depth` tokens
  std::uint32_t head_ = 0, tail_ = 0;
  int count_ = 0, depth_ = 0;
  /// the latencies in ticks, where both ends share a clock with equal cycles; else 0
  Tick forward_step_ = 0, credit_step_ = 0;
  int width_ = 1;
  int burst_ = 0;  ///< pushes at tick `last_push_`
  Tick last_push_ = -1, last_pop_ = 0;
  Tick width_free_ = 0;       ///< the width allows no push before this tick
  Tick producer_period_ = 0;  ///< 0 when the producer's cycles differ in length
  std::uint64_t pushes_ = 0, push_ticks_ = 0, pop_ticks_ = 0;
  std::uint64_t* consumer_word_ = nullptr;  ///< of the driver's marks
  std::uint64_t* producer_word_ = nullptr;
  std::uint8_t consumer_bit_ = 0, producer_bit_ = 0;
  std::uint64_t unwatched_ = 0;
  std::uint64_t* arrival_word_ = &unwatched_;  ///< of the consumer's own marks (FifoInGroup)
  std::uint64_t arrival_mask_ = 0;

 protected:
  bool faulty_ = false;  ///< a test changes tokens as they are pushed

 private:
  LinkSpec spec_;
  Tick forward_ = 0, credit_ = 0;
  Unit* producer_ = nullptr;
  Unit* consumer_ = nullptr;
};

/// A FIFO of tokens. Tokens are trivially copyable and small; bulk travels as a handle into a store.
template <class T>
class Fifo final : public FifoBase {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= 64 && alignof(T) <= 16,
                "tokens are trivially copyable and at most 64 bytes");

 public:
  Fifo(const char* name, const LinkSpec& spec) : FifoBase(name, spec, sizeof(T)) {}
  void push(Tick now, const T& token) {
    T& slot = slots()[tail()];
    slot = token;
    if (faulty_) [[unlikely]]
      fault_(slot);
    note_push(now);
  }
  /// A fault on the wire, for tests of the conservation laws: changes tokens as they are pushed.
  void inject_fault(std::function<void(T&)> fault) {
    fault_ = std::move(fault);
    faulty_ = true;
  }
  [[nodiscard]] const T& front() const { return slots()[head()]; }
  T pop(Tick now) {
    const T token = front();
    note_pop(now);
    return token;
  }

 private:
  [[nodiscard]] T* slots() const { return reinterpret_cast<T*>(tokens()); }
  std::function<void(T&)> fault_;
};

/// A port seen without its payload: what attribution, idleness and the deadlock report need.
class PortBase {
 public:
  enum class Direction : std::uint8_t { kIn, kOut };
  /// `stream` groups ports of a unit whose flows do not mix: an output's tokens come only from inputs of the
  /// same stream (0: from any).
  PortBase(Unit& owner, const char* name, Direction direction, LinkRole role, int stream);
  virtual ~PortBase() = default;
  PortBase(const PortBase&) = delete;
  PortBase& operator=(const PortBase&) = delete;
  [[nodiscard]] virtual FifoBase& fifo() const = 0;
  virtual void attach() = 0;
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] Direction direction() const { return direction_; }
  [[nodiscard]] LinkRole role() const { return role_; }
  [[nodiscard]] int stream() const { return stream_; }
  [[nodiscard]] Unit& owner() const { return owner_; }
  /// Its place among the ports of its owner.
  [[nodiscard]] std::uint32_t number() const { return number_; }
  /// Cycles the owner waited for this port: starved on an input, blocked on an output.
  [[nodiscard]] std::int64_t waited() const;
  /// The same as the owner counts it: ticks on a uniform clock, else cycles.
  [[nodiscard]] std::int64_t waited_span() const { return waited_; }
  void add_wait(std::int64_t span) const { waited_ += span; }

 protected:
  Unit& owner_;

 private:
  std::string name_;
  Direction direction_;
  LinkRole role_;
  int stream_;
  std::uint32_t number_;
  mutable std::int64_t waited_ = 0;
};

template <class T, PortBase::Direction kDirection>
class FifoPort : public sc_core::sc_port<Fifo<T>>, public PortBase {
 public:
  FifoPort(Unit& owner, const char* name, LinkRole role = LinkRole::kFlow, int stream = 0)
      : sc_core::sc_port<Fifo<T>>(name), PortBase(owner, name, kDirection, role, stream) {}
  [[nodiscard]] FifoBase& fifo() const override { return *channel_; }
  void attach() override {
    channel_ = dynamic_cast<Fifo<T>*>(this->get_interface());
    QUADRILLE_CHECK(channel_ != nullptr, "port {} is not bound", sc_core::sc_port<Fifo<T>>::name());
    if constexpr (kDirection == Direction::kIn) channel_->bind_consumer(owner_);
    else channel_->bind_producer(owner_);
  }

 protected:
  Fifo<T>* channel_ = nullptr;
};

/// Consumer's end.
template <class T>
class FifoIn final : public FifoPort<T, PortBase::Direction::kIn> {
 public:
  using FifoPort<T, PortBase::Direction::kIn>::FifoPort;
  void attach() override {
    FifoPort<T, PortBase::Direction::kIn>::attach();
    if (arrival_word_ != nullptr) this->channel_->mark_arrivals(*arrival_word_, arrival_bit_);
  }
  /// The link shall mark arrivals in bit `bit` of `word`, once it is attached.
  void mark_arrivals(std::uint64_t& word, int bit) {
    arrival_word_ = &word;
    arrival_bit_ = bit;
  }
  [[nodiscard]] Tick ready() const { return this->channel_->ready(); }
  [[nodiscard]] bool ready_at(Tick now) const { return this->channel_->ready_at(now); }
  [[nodiscard]] const T& front() const { return this->channel_->front(); }
  T pop(Tick now) { return this->channel_->pop(now); }

 private:
  std::uint64_t* arrival_word_ = nullptr;
  int arrival_bit_ = 0;
};

/// Producer's end.
template <class T>
class FifoOut final : public FifoPort<T, PortBase::Direction::kOut> {
 public:
  using FifoPort<T, PortBase::Direction::kOut>::FifoPort;
  [[nodiscard]] Tick room() const { return this->channel_->room(); }
  [[nodiscard]] bool room_at(Tick now) const { return this->channel_->room() <= now; }
  void push(Tick now, const T& token) { this->channel_->push(now, token); }
};

}  // namespace quadrille::hw
