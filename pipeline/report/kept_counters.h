/// What is kept of a run because somebody asks for it, beside what is always kept where draws and squares of
/// the screen are (detail.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::pipeline {

/// A counter of a kind of unit.
struct AskedCounter {
  std::string kind, counter;
};

/// Sums over the units of the kind; of a kind that the frame needs none of they are 0.
struct CountersByDraw {
  std::vector<AskedCounter> asked;
  std::vector<std::vector<std::uint64_t>> draws;  ///< by draw in API order, then by counter
  std::vector<std::uint64_t> outside;             ///< what belongs to no draw
  std::uint64_t total = 0;                        ///< of all counters, as the units have counted
};

/// The same of one counter by squares of the screen.
struct CounterBySquare {
  std::string key;  ///< what the figures call it
  AskedCounter asked;
  std::vector<std::uint64_t> squares;  ///< as `TileFigures` has them
  std::uint64_t outside = 0;           ///< what has no place on the screen
  std::uint64_t total = 0;
};

/// Rows of registers that a warp of a draw's programs takes.
struct DrawRegisters {
  int vertex = 0, fragment = 0;
};

struct KeptCounters {
  CountersByDraw by_draw;
  std::vector<CounterBySquare> by_square;
  std::vector<DrawRegisters> registers;  ///< by draw
};

}  // namespace quadrille::pipeline
