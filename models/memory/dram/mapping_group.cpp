/// By bank group. From the least significant part of the line's number upward: pseudo-channel, bank group,
/// line of the row, bank of the group, rank, row.
#include "models/memory/dram/mapping.h"

namespace quadrille::models {

namespace {

class GroupMapping final : public DramMapping {
 public:
  using DramMapping::DramMapping;

 protected:
  [[nodiscard]] Digits split(std::uint64_t line) const override {
    Digits at;
    at.pseudo_channel = digit(line, pseudo_channels_);
    at.group = digit(line, groups_);
    at.column = digit(line, row_lines_);
    at.bank = digit(line, group_banks_);
    at.rank = digit(line, ranks_);
    at.row = line;
    return at;
  }
};

}  // namespace

constinit const DramMappingPolicy kGroupMapping{
    "group",
    "neighbouring lines lie in different bank groups, whose bursts may follow each other more closely",
    [](const DramTiming& timing, bool hash) -> std::unique_ptr<DramMapping> {
      return std::make_unique<GroupMapping>(timing, hash);
    }};

}  // namespace quadrille::models
