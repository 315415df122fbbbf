/// Walks the primitives of a draw in order, index by index where a special index ends a strip or fan.
/// [VK1.3 #drawing-primitive-topologies, primitiveRestartEnable]
#pragma once

#include "models/geometry/assembly.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

/// The index that ends a strip or fan, of indices of so many bytes: all ones.
[[nodiscard]] constexpr std::uint32_t restart_index(std::uint32_t index_bytes) {
  return index_bytes >= 4 ? 0xffffffffu : (1u << 8 * index_bytes) - 1;
}

class PrimitiveWalk {
 public:
  /// To the first primitive of a draw (or of its next instance) with so many vertices or indices.
  void start(Topology topology, std::uint32_t count, bool restarts) {
    topology_ = topology;
    count_ = count;
    restarts_ = restarts;
    run_first_ = run_end_ = in_run_ = in_run_count_ = primitive_ = 0;
    begun_ = false;
  }
  /// Is there a primitive? Then `positions()` has the positions of its vertices within the draw.
  /// `ends_run(position)`: is the index there the special one? It is asked once for each position, and only
  /// of draws that restart; `passed(position)` is told of the special ones.
  template <class EndsRun, class Passed>
  [[nodiscard]] bool look(const EndsRun& ends_run, const Passed& passed) {
    while (in_run_ == in_run_count_) {
      if (begun_ && run_end_ >= count_) return false;
      if (begun_) passed(run_end_);
      next_run(ends_run);
    }
    return true;
  }
  [[nodiscard]] std::array<std::uint32_t, 3> positions() const {
    std::array<std::uint32_t, 3> at = primitive_vertices(topology_, in_run_);
    for (std::uint32_t& position : at) position += run_first_;
    return at;
  }
  /// Number of the primitive within the instance; a restart does not begin anew.
  [[nodiscard]] std::uint32_t primitive() const { return primitive_; }
  void advance() { skip_to(primitive_ + 1); }
  /// Goes on to a primitive of the run that was looked at.
  void skip_to(std::uint32_t primitive) {
    in_run_ += primitive - primitive_;
    primitive_ = primitive;
  }

 private:
  template <class EndsRun>
  void next_run(const EndsRun& ends_run) {
    run_first_ = begun_ ? run_end_ + 1 : 0;
    begun_ = true;
    run_end_ = restarts_ ? run_first_ : count_;
    while (run_end_ < count_ && !ends_run(run_end_)) ++run_end_;
    in_run_ = 0;
    in_run_count_ = run_first_ < run_end_ ? primitive_count(topology_, run_end_ - run_first_) : 0;
  }

  Topology topology_ = Topology::kTriangleList;
  std::uint32_t count_ = 0;
  bool restarts_ = false, begun_ = false;
  std::uint32_t run_first_ = 0, run_end_ = 0;  ///< positions between two special indices
  std::uint32_t in_run_ = 0, in_run_count_ = 0;
  std::uint32_t primitive_ = 0;
};

}  // namespace quadrille::models
