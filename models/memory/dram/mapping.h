/// Which pseudo-channel, rank, bank and row hold a line of a channel: in which order the digits of the line's
/// number name them, one file a policy (mapping_*.cpp).
///
/// With `hash`, bank and group are exchanged by the row's number, so that surfaces at a distance of whole
/// rows meet in different banks. [P: Zhang, Zhu, Zhang, A permutation-based page interleaving scheme, MICRO
/// 2000]
#pragma once

#include "models/base/policy.h"
#include "models/memory/dram/timing.h"

#include <cstdint>

namespace quadrille::models {

struct DramPlace {
  std::uint32_t pseudo_channel = 0;
  /// over all ranks of the pseudo-channel: (rank * groups + group) * banks of a group + bank
  std::uint32_t bank = 0;
  std::int32_t row = 0;
  std::uint32_t column = 0;  ///< first line of the row = 0, in lines of 128 bytes
};

class DramMapping {
 public:
  /// A row holds at least a line.
  DramMapping(const DramTiming& timing, bool hash);
  virtual ~DramMapping() = default;
  /// Lines beyond the device's capacity begin again at its first row.
  [[nodiscard]] DramPlace place(std::uint64_t line) const;

 protected:
  /// Where a line lies, part by part; `bank` is that of its group.
  struct Digits {
    std::uint32_t pseudo_channel = 0, column = 0, group = 0, bank = 0, rank = 0;
    std::uint64_t row = 0;  ///< what is left of the line's number
  };
  [[nodiscard]] virtual Digits split(std::uint64_t line) const = 0;
  /// Takes the lowest digit of base `count` off `number`.
  static std::uint32_t digit(std::uint64_t& number, std::uint32_t count);

  std::uint32_t pseudo_channels_, groups_, group_banks_, ranks_, rows_, row_lines_;

 private:
  bool hash_;
};

using DramMappingPolicy = Policy<DramMapping, const DramTiming&, bool>;
/// What `memory.mapping` chooses from.
[[nodiscard]] PolicyList<DramMappingPolicy>& dram_mappings();
extern const DramMappingPolicy kGroupMapping, kRowMapping;

}  // namespace quadrille::models
