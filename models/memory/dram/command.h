/// What a memory controller sends to DRAM, one record a command: the trace that tests check against the
/// standards' rules.
#pragma once

#include <cstdint>

namespace quadrille::models {

enum class DramCommandKind : std::uint8_t {
  kActivate,
  kPrecharge,
  kRead,
  kWrite,
  kReadPrecharge,
  kWritePrecharge,
  kRefresh,
  kRefreshBank
};

/// One command to one pseudo-channel. What a kind does not use is 0.
struct DramCommand {
  std::int64_t cycle = 0;  ///< of the command clock
  DramCommandKind kind = DramCommandKind::kActivate;
  std::uint8_t pseudo_channel = 0;
  std::uint8_t rank = 0;
  std::uint16_t bank_group = 0;
  std::uint16_t bank = 0;  ///< within its group
  std::int32_t row = 0;
  std::int32_t column = 0;  ///< in bursts
};

}  // namespace quadrille::models
