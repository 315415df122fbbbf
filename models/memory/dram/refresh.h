/// When a rank must be refreshed: one REF each t_refi, of all banks or of one bank in turn (then each t_refi
/// / banks). A REF may be postponed while requests wait, up to `refresh_postpone` times (as many for each
/// bank); beyond that it comes before them. [Ramulator 2, AMD LPDDR5, DRAMSys; Cisco UCS for the
/// postponement]
#pragma once

#include "models/memory/dram/timing.h"

#include <cstdint>

namespace quadrille::models {

class DramRefreshClock {
 public:
  explicit DramRefreshClock(const DramTiming& timing);
  [[nodiscard]] bool on() const { return interval_ > 0; }
  [[nodiscard]] bool per_bank() const { return per_bank_; }
  /// It may not be postponed again: one more interval would be too long.
  [[nodiscard]] bool must(std::int64_t now) const { return now >= must_at_; }
  /// When `must` becomes true without another REF, and when the next one is due.
  [[nodiscard]] std::int64_t must_at() const { return must_at_; }
  [[nodiscard]] std::int64_t due_at() const { return due_at_; }
  /// Bank of the rank whose turn it is.
  [[nodiscard]] std::uint32_t bank() const { return bank_; }
  /// Cycles after which all banks had their turn; 0 where there is no refresh.
  [[nodiscard]] std::int64_t round() const { return per_bank_ ? interval_ * banks_ : interval_; }
  /// Those of so many rounds were sent.
  void send_rounds(std::int64_t rounds) {
    due_at_ += rounds * round();
    must_at_ += rounds * round();
  }
  void send() {
    due_at_ += interval_;
    must_at_ += interval_;
    bank_ = bank_ + 1 == banks_ ? 0 : bank_ + 1;
  }

 private:
  bool per_bank_;
  std::int64_t interval_;
  std::uint32_t banks_, bank_ = 0;
  std::int64_t due_at_, must_at_;
};

}  // namespace quadrille::models
