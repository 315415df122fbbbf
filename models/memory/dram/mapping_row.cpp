/// By row. From the least significant part of the line's number upward: pseudo-channel, line of the row, bank
/// group, bank of the group, rank, row.
#include "models/memory/dram/mapping.h"

namespace quadrille::models {

namespace {

class RowMapping final : public DramMapping {
 public:
  using DramMapping::DramMapping;

 protected:
  [[nodiscard]] Digits split(std::uint64_t line) const override {
    Digits at;
    at.pseudo_channel = digit(line, pseudo_channels_);
    at.column = digit(line, row_lines_);
    at.group = digit(line, groups_);
    at.bank = digit(line, group_banks_);
    at.rank = digit(line, ranks_);
    at.row = line;
    return at;
  }
};

}  // namespace

constinit const DramMappingPolicy kRowMapping{
    "row", "a row is filled before the next is opened: more hits to open rows",
    [](const DramTiming& timing, bool hash) -> std::unique_ptr<DramMapping> {
      return std::make_unique<RowMapping>(timing, hash);
    }};

}  // namespace quadrille::models
