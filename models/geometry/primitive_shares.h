/// How geometry front ends share the primitives of draws: each takes a range of primitives that follow each
/// other, and then it is the turn of the next one. All of them know the draws, so none has to be told.
///
/// A range is as long as the machine says, or ends with its instance. The last one ends with its draw. A draw
/// whose primitives cannot be told by number (it restarts) is one range, as are all draws of a machine with
/// one front end.
#pragma once

#include <cstdint>

namespace quadrille::models {

class PrimitiveShares {
 public:
  /// Of front end `number` of `front_ends`; ranges of at most `length` primitives.
  PrimitiveShares(std::uint32_t number, std::uint32_t front_ends, std::uint32_t length)
      : number_(number), front_ends_(front_ends), length_(length) {}

  /// Begins a draw of so many instances with so many primitives each; `numbered` if it does not restart.
  void start_draw(std::uint32_t instances, std::uint32_t primitives, bool numbered) {
    cut_ = numbered && front_ends_ > 1;
    of_instance_ = cut_ ? primitives / length_ + (primitives % length_ != 0 ? 1 : 0) : 1;
    count_ = std::uint64_t{instances} * of_instance_;
    const std::uint32_t wait = (number_ + front_ends_ - turn_) % front_ends_;
    next_ = cut_ || wait == 0 ? wait : count_;
    const std::uint64_t turns = cut_ && count_ > 0 ? count_ : 1;
    last_ = static_cast<std::uint32_t>((turn_ + turns - 1) % front_ends_);
    turn_ = (last_ + 1) % front_ends_;
  }
  /// It is this front end's turn, so it sends the marks between draws.
  [[nodiscard]] bool has_turn() const { return turn_ == number_; }
  /// It has the last range of the draw, so it sends the draw's end.
  [[nodiscard]] bool ends_draw() const { return last_ == number_; }

  /// The draw has no more ranges for this front end.
  [[nodiscard]] bool done() const { return next_ >= count_; }
  // Of its range:
  [[nodiscard]] std::uint32_t instance() const { return static_cast<std::uint32_t>(next_ / of_instance_); }
  /// Its first primitive, and the one behind its last; there may be fewer in the instance.
  [[nodiscard]] std::uint32_t first() const {
    return cut_ ? static_cast<std::uint32_t>(next_ % of_instance_) * length_ : 0;
  }
  [[nodiscard]] std::uint32_t end() const {
    return cut_ && length_ <= ~std::uint32_t{0} - first() ? first() + length_ : ~std::uint32_t{0};
  }
  /// The next front end goes on with the draw.
  [[nodiscard]] bool hands_on() const { return cut_ && next_ + 1 < count_; }
  /// To this front end's next range.
  void advance() { next_ += cut_ ? front_ends_ : 1; }

 private:
  std::uint32_t number_, front_ends_, length_;
  std::uint32_t turn_ = 0;  ///< whose the next range after this draw is
  std::uint32_t last_ = 0;  ///< whose the last range of the draw is
  bool cut_ = false;
  std::uint32_t of_instance_ = 1;       ///< ranges
  std::uint64_t next_ = 0, count_ = 0;  ///< ranges of the draw
};

}  // namespace quadrille::models
