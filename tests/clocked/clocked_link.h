/// A FIFO of the clocked simulator: a delay line of tokens forward and of free slots back.
#pragma once

#include "tests/hw/base/world_spec.h"

#include <deque>

namespace quadrille::clocked {

/// Something on its way to one end: it is noticed on the receiver's next edge, unless it left on one, and
/// arrives after `edges_left` further edges.
struct Travelling {
  bool noticed = false;
  int edges_left = 0;
  void receiver_edge() {
    if (!noticed) noticed = true;
    else if (edges_left > 0) --edges_left;
  }
};

class ClockedLink {
 public:
  ClockedLink(const hw::world::WireSpec& wire, bool crosses)
      : wire_(wire), penalty_(crosses ? 2 : 0), free_(wire.depth) {}

  /// Called before any unit ticks, once for each edge of the respective end.
  void consumer_edge() {
    for (auto& [travel, token] : tokens_) travel.receiver_edge();
  }
  void producer_edge() {
    pushed_this_edge_ = 0;
    for (Travelling& t : returning_) t.receiver_edge();
    while (!returning_.empty() && returning_.front().noticed && returning_.front().edges_left == 0) {
      returning_.pop_front();
      ++free_;
    }
  }

  [[nodiscard]] bool can_push() const { return free_ > 0 && pushed_this_edge_ < wire_.width; }
  [[nodiscard]] bool can_pop() const {
    return !tokens_.empty() && tokens_.front().first.noticed && tokens_.front().first.edges_left == 0;
  }
  [[nodiscard]] const hw::world::Token& front() const { return tokens_.front().second; }
  /// `together`: the other end's clock has an edge at this moment, too.
  void push(const hw::world::Token& token, bool together) {
    --free_;
    ++pushed_this_edge_;
    tokens_.push_back({{together, wire_.latency + penalty_}, token});
  }
  hw::world::Token pop(bool together) {
    const hw::world::Token token = front();
    tokens_.pop_front();
    returning_.push_back({together, wire_.credit + penalty_});
    return token;
  }
  [[nodiscard]] int tokens() const { return static_cast<int>(tokens_.size()); }

 private:
  hw::world::WireSpec wire_;
  int penalty_;
  int free_;
  int pushed_this_edge_ = 0;
  std::deque<std::pair<Travelling, hw::world::Token>> tokens_;
  std::deque<Travelling> returning_;
};

}  // namespace quadrille::clocked
