/// The requests that a controller holds for one pseudo-channel: by age, and by bank and age, reads and writes
/// apart. A request is taken out from anywhere.
#pragma once

#include "models/memory/dram/mapping.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille::models {

struct DramEntry {
  DramPlace at;
  std::uint64_t seq = 0;     ///< order of arrival
  std::int64_t arrived = 0;  ///< cycle
  std::uint32_t id = 0;      ///< the caller's name for the request
  std::uint32_t bursts = 0;  ///< a bit for each burst of the line that is still to be moved
  bool write = false;
  bool opened = false;        ///< a row was opened for it
  bool closed_other = false;  ///< another row was closed for it
  bool started = false;       ///< a burst was moved
};

class DramQueue {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  explicit DramQueue(std::size_t banks) : banks_(banks) {}

  std::uint32_t add(const DramEntry& entry);
  void remove(std::uint32_t index);
  [[nodiscard]] DramEntry& operator[](std::uint32_t i) { return nodes_[i].entry; }
  [[nodiscard]] const DramEntry& operator[](std::uint32_t i) const { return nodes_[i].entry; }

  [[nodiscard]] std::uint32_t oldest(bool write) const { return age_[write].first; }
  /// The next younger one of the same kind.
  [[nodiscard]] std::uint32_t younger(std::uint32_t i) const { return nodes_[i].next; }
  /// Over both kinds.
  [[nodiscard]] std::uint32_t oldest() const;
  [[nodiscard]] std::uint32_t oldest(std::uint32_t bank, bool write) const {
    return banks_[bank].list[write].first;
  }
  /// The oldest request of the bank for `row`.
  [[nodiscard]] std::uint32_t oldest_of_row(std::uint32_t bank, bool write, std::int32_t row) const;
  /// Does a younger request of the same kind want the row of `entry`?
  [[nodiscard]] bool another_of_row(std::uint32_t entry) const;
  [[nodiscard]] int count(bool write) const { return count_[write]; }
  [[nodiscard]] bool empty() const { return count_[0] + count_[1] == 0; }
  [[nodiscard]] int bank_count(std::uint32_t bank) const { return banks_[bank].count; }
  /// Banks with requests of a kind, in no order of meaning.
  [[nodiscard]] const std::vector<std::uint32_t>& active_banks(bool write) const { return active_[write]; }

 private:
  struct List {
    std::uint32_t first = kNone, last = kNone;
  };
  struct Node {
    DramEntry entry;
    std::uint32_t next = kNone, prev = kNone;            ///< by age
    std::uint32_t bank_next = kNone, bank_prev = kNone;  ///< of the bank
  };
  struct Bank {
    std::array<List, 2> list;
    int count = 0;
    std::array<std::uint32_t, 2> place{kNone, kNone};  ///< in active_
  };
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> free_;
  std::array<List, 2> age_;
  std::array<int, 2> count_{};
  std::vector<Bank> banks_;
  std::array<std::vector<std::uint32_t>, 2> active_;
};

}  // namespace quadrille::models
