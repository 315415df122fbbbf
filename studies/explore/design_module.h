/// What the module of designs offers: OpenTURNS and pagmo behind plain functions.
///
/// They bring dozens of libraries and start threads, so they live in a module of their own, which is loaded
/// in a process that ends when it has answered (studies/explore/designs_library.h).
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

/// A message, if something failed. Every function returns false then.
struct QuadrilleMessage {
  char text[400];
};

/// `out[row * dimensions + i]`: so many places in 0..1 of each dimension. `kind`: "random", "latin_hypercube"
/// or "sobol". Same seed, same places.
using QuadrilleDesign = bool(const char* kind, std::size_t dimensions, std::size_t points, std::uint64_t seed,
                             double* out, QuadrilleMessage* message);

/// What a round of a search knows. Less of every objective is better.
struct QuadrilleSearch {
  std::size_t dimensions, objectives, known, wanted;
  const std::size_t* levels;  ///< by dimension; 0: every number
  const double* places;       ///< of what is known, row by row, in 0..1
  const double* values;       ///< of its objectives, row by row
  const double* most;         ///< by objective: what it may come to; infinite: anything
  std::uint64_t seed;
  /// Whether there is a machine at a place; sets the objectives that are known without a frame.
  bool (*judge)(void* owner, const double* place, double* values);
  void* owner;
};
/// Up to `wanted` places to draw next, row by row. None, when no guess is better than what is known.
using QuadrilleSearchRound = bool(const QuadrilleSearch* asked, double* out, std::size_t* found,
                                  QuadrilleMessage* message);

/// Which rows no other row dominates: none is less in one objective and not more in any. 1: it is one.
using QuadrilleFront = bool(std::size_t rows, std::size_t objectives, const double* values,
                            std::uint8_t* on_front, QuadrilleMessage* message);
/// The volume between the rows and a reference that is worse than all of them.
using QuadrilleHypervolume = bool(std::size_t rows, std::size_t objectives, const double* values,
                                  const double* reference, double* out, QuadrilleMessage* message);

/// Parts of a variance; the arrays are given.
struct QuadrilleIndices {
  double *first, *total;  ///< by dimension: alone, and with all others
  double* pairs;          ///< `pairs[i * dimensions + j]`: of two together, without what each does alone
  double left_over;       ///< the part that the fit does not explain of rows that it was not given
};
/// Sobol indices of a table. `levels`: by dimension; 0: every number.
using QuadrilleIndicesOf = bool(std::size_t rows, std::size_t dimensions, const std::size_t* levels,
                                const double* places, const double* values, QuadrilleIndices* out,
                                QuadrilleMessage* message);
}
