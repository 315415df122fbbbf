/// SPIR-V keeps its instructions' lengths in their first words: changes are made to whole instructions, and
/// ids stay mostly below the bound.
#include <algorithm>
#include <array>
#include <cstring>

#include "tests/fuzz/dice.h"
#include "tests/fuzz/targets.h"

namespace quadrille::fuzz {
namespace {

constexpr std::size_t kHeaderWords = 5, kBoundWord = 3, kMaxWords = 1 << 14;
using Words = std::vector<std::uint32_t>;
constexpr std::array<std::uint32_t, 6> kExtremes{0, 1, 0x7fffffffu, 0x80000000u, 0xffffffffu, 65536};

/// Where the instructions begin, and the end.
std::vector<std::size_t> starts(const Words& words) {
  std::vector<std::size_t> result;
  std::size_t at = kHeaderWords;
  for (; at < words.size(); at += std::max(1u, words[at] >> 16)) result.push_back(at);
  result.push_back(words.size());
  return result;
}

void change_word(Words& words, Dice& dice) {
  std::uint32_t& word = words[kHeaderWords + dice.below(words.size() - kHeaderWords)];
  switch (dice.below(6)) {
    case 0: word ^= 1u << dice.below(32); break;
    case 1: word = static_cast<std::uint32_t>(dice.below(words[kBoundWord])); break;
    case 2: word = words[kHeaderWords + dice.below(words.size() - kHeaderWords)]; break;
    case 3: word += static_cast<std::uint32_t>(dice.below(3)) - 1; break;
    // another instruction of the same length
    case 4: word = (word & 0xffff0000u) | static_cast<std::uint32_t>(dice.below(400)); break;
    default: word = dice.pick(kExtremes); break;
  }
}

void move_instruction(Words& words, Dice& dice) {
  const std::vector<std::size_t> at = starts(words);
  if (at.size() < 3) return;
  const std::size_t from = dice.below(at.size() - 1), to = dice.below(at.size() - 1);
  const auto place = [&](std::size_t i) {
    return words.begin() + static_cast<std::ptrdiff_t>(std::min(at[i], words.size()));
  };
  const Words moved(place(from), place(from + 1));
  const std::size_t how = dice.below(3);  // remove, copy, or both
  if (how != 0) words.insert(place(to), moved.begin(), moved.end());
  const std::size_t shift = how != 0 && to <= from ? moved.size() : 0;
  if (how != 1) {
    const auto begin = words.begin() + static_cast<std::ptrdiff_t>(at[from] + shift);
    words.erase(begin, begin + static_cast<std::ptrdiff_t>(moved.size()));
  }
}

}  // namespace

Buffer mutate_spirv(Bytes bytes, const RawMutation& raw, unsigned seed) {
  Dice dice(seed);
  Words words(bytes.size() / 4);
  if (words.size() <= kHeaderWords || words.size() > kMaxWords || dice.one_in(32))
    return mutate_raw(bytes, raw, seed);
  std::memcpy(words.data(), bytes.data(), words.size() * 4);
  for (std::size_t n = 1 + dice.below(3); n > 0 && words.size() > kHeaderWords; --n) {
    if (dice.below(3) == 0) {
      move_instruction(words, dice);
    } else {
      change_word(words, dice);
    }
  }
  const auto out = std::as_bytes(std::span(words));
  return {out.begin(), out.end()};
}

}  // namespace quadrille::fuzz
