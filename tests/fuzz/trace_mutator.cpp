/// A trace is compressed and checked: changes are made to decoded chunks, and the file around them is made to
/// hold again.
#include <cstring>

#include "tests/fuzz/dice.h"
#include "tests/fuzz/trace_chunks.h"

namespace quadrille::fuzz {
namespace {

constexpr std::array<std::uint32_t, 8> kNumbers{0,           1,           2,           16384,
                                                0x3f800000u, 0x7f800000u, 0x7fffffffu, 0xffffffffu};

/// A number anywhere becomes one that means something: a count, a limit, one, infinity.
void set_number(Buffer& payload, Dice& dice) {
  if (payload.size() < 4) return;
  const std::uint32_t value =
      dice.one_in(3) ? static_cast<std::uint32_t>(dice.below(64)) : dice.pick(kNumbers);
  std::memcpy(payload.data() + dice.below(payload.size() - 3), &value, sizeof(value));
}

}  // namespace

Buffer mutate_trace(Bytes bytes, const RawMutation& raw, unsigned seed) {
  Dice dice(seed);
  auto chunks = take_trace_apart(bytes);
  if (!chunks || chunks->empty() || dice.one_in(32)) return mutate_raw(bytes, raw, seed);
  for (std::size_t n = 1 + dice.below(3); n > 0; --n) {
    Buffer& payload = (*chunks)[dice.below(chunks->size())].payload;
    if (dice.one_in(2)) {
      set_number(payload, dice);
    } else {
      payload = mutate_raw(payload, raw, seed);
    }
  }
  return put_trace_together(*chunks);
}

}  // namespace quadrille::fuzz
