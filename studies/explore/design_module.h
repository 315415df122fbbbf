/// What the module of designs offers: OpenTURNS and pagmo behind plain functions.
///
/// They bring dozens of libraries and start threads, so they live in a module of their own, which is loaded
/// in a process that ends when it has answered (studies/explore/design.h).
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

/// A message, if something failed.
struct QuadrilleMessage {
  char text[400];
};

/// `out[row * dimensions + i]`: so many places in 0..1 of each dimension. `kind`: "random", "latin_hypercube"
/// or "sobol". Same seed, same places. False: the message says why.
using QuadrilleDesign = bool(const char* kind, std::size_t dimensions, std::size_t points, std::uint64_t seed,
                             double* out, QuadrilleMessage* message);
}
