#include "hw/base/charge_log.h"

#include "hw/base/counter.h"
#include "models/base/error.h"

#include <algorithm>

namespace quadrille::hw {

namespace {

/// Seven bits a byte, the low ones first; the high bit says that more follow.
std::uint64_t take(const std::uint8_t*& at) {
  std::uint64_t number = 0;
  for (unsigned shift = 0;; shift += 7) {
    const std::uint8_t byte = *at++;
    number |= static_cast<std::uint64_t>(byte & 0x7fu) << shift;
    if (byte < 0x80) return number;
  }
}

}  // namespace

void ChargeLog::put(std::uint64_t number) {
  for (; number >= 0x80; number >>= 7) bytes_.push_back(static_cast<std::uint8_t>(number | 0x80u));
  bytes_.push_back(static_cast<std::uint8_t>(number));
}

// First what, and whether the draw is another one; then that draw; then the length, in cycles if it is whole
// cycles, else in ticks.
void ChargeLog::pack(const Interval& interval) {
  if (packed_++ % kBlock == 0) blocks_.push_back({bytes_.size(), interval.from, packed_draw_});
  const bool other = interval.draw != packed_draw_;
  put(std::uint64_t{interval.what} << 1 | static_cast<std::uint64_t>(other));
  if (other) put(interval.draw.index());
  packed_draw_ = interval.draw;
  const Tick length = interval.to - interval.from;
  const bool whole = length % period_ == 0;
  put(static_cast<std::uint64_t>(whole ? length / period_ : length) << 1 |
      static_cast<std::uint64_t>(!whole));
}

void ChargeLog::note(Tick to, std::uint32_t what) {
  const WorkLog* log = stats_ == nullptr ? nullptr : stats_->log();
  const DrawId draw = log == nullptr ? kNoDraw : log->now().draw;
  if (what != open_.what || draw != open_.draw) {
    if (open_.to > open_.from) pack(open_);
    open_ = {open_.to, open_.to, what, draw};
  }
  open_.to = to;
}

void ChargeLog::finish() {
  if (open_.to > open_.from) pack(open_);
  open_.from = open_.to;
}

void ChargeLog::Reader::unpack(std::size_t block) {
  const Block& first = log_.blocks_[block];
  const std::size_t count = std::min(kBlock, log_.packed_ - block * kBlock);
  const std::uint8_t* at = log_.bytes_.data() + first.offset;
  Interval last{first.from, first.from, kBusy, first.draw};
  block_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t head = take(at);
    if ((head & 1) != 0) last.draw = DrawId(static_cast<std::uint32_t>(take(at)));
    const std::uint64_t length = take(at);
    last.what = static_cast<std::uint32_t>(head >> 1);
    last.from = last.to;
    last.to += static_cast<Tick>(length >> 1) * ((length & 1) != 0 ? 1 : log_.period_);
    block_.push_back(last);
  }
}

const ChargeLog::Interval& ChargeLog::Reader::at(Tick t) {
  QUADRILLE_CHECK(t > 0 && t <= log_.end(), "tick {} of a log up to {}", t, log_.end());
  if (block_.empty() || t <= block_.front().from || t > block_.back().to) {
    const auto behind =
        std::ranges::lower_bound(log_.blocks_, t, {}, [](const Block& block) { return block.from; });
    unpack(static_cast<std::size_t>(behind - log_.blocks_.begin()) - 1);
  }
  return *std::ranges::lower_bound(block_, t, {}, [](const Interval& i) { return i.to; });
}

}  // namespace quadrille::hw
