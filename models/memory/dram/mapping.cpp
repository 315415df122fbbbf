#include "models/memory/dram/mapping.h"

#include "models/base/error.h"
#include "models/memory/device_memory.h"

#include <bit>

namespace quadrille::models {

namespace {
/// Another permutation of 0..count-1 for each key: exclusive or where the count allows it, else a rotation.
std::uint32_t permuted(std::uint32_t value, std::uint32_t key, std::uint32_t count) {
  return std::has_single_bit(count) ? value ^ (key & (count - 1)) : (value + key) % count;
}
}  // namespace

std::uint32_t DramMapping::digit(std::uint64_t& number, std::uint32_t count) {
  if (std::has_single_bit(count)) {
    const auto low = static_cast<std::uint32_t>(number & (count - 1));
    number >>= std::countr_zero(count);
    return low;
  }
  const auto low = static_cast<std::uint32_t>(number % count);
  number /= count;
  return low;
}

DramMapping::DramMapping(const DramTiming& t, bool hash)
    : pseudo_channels_(static_cast<std::uint32_t>(t.pseudo_channels)),
      groups_(static_cast<std::uint32_t>(t.bank_groups)),
      group_banks_(static_cast<std::uint32_t>(t.group_banks())),
      ranks_(static_cast<std::uint32_t>(t.ranks)),
      rows_(static_cast<std::uint32_t>(t.rows)),
      row_lines_(static_cast<std::uint32_t>(t.row_bytes) / kLineBytes),
      hash_(hash) {
  QUADRILLE_CHECK(row_lines_ > 0 && group_banks_ > 0, "row of {} bytes, {} banks in {} groups", t.row_bytes,
                  t.banks, t.bank_groups);
}

DramPlace DramMapping::place(std::uint64_t line) const {
  const Digits digits = split(line);
  DramPlace at;
  at.pseudo_channel = digits.pseudo_channel;
  at.column = digits.column;
  std::uint32_t group = digits.group, bank = digits.bank;
  const auto row = static_cast<std::uint32_t>(digits.row % rows_);
  if (hash_) {
    // Both digits of the bank take their own part of the row's number, folded so that far rows count too.
    const std::uint32_t key = row ^ row >> 5 ^ row >> 10;
    bank = permuted(bank, key, group_banks_);
    group = permuted(group, key >> (std::bit_width(group_banks_) - 1), groups_);
    at.pseudo_channel = permuted(at.pseudo_channel, row ^ row >> 3 ^ row >> 7, pseudo_channels_);
  }
  at.bank = (digits.rank * groups_ + group) * group_banks_ + bank;
  at.row = static_cast<std::int32_t>(row);
  return at;
}

}  // namespace quadrille::models
