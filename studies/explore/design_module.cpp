/// The module of designs: a thin layer over OpenTURNS. No exception leaves it.
#include "studies/explore/design_module.h"

#include <openturns/OT.hxx>

#include <stdexcept>
#include <string>

#include "studies/explore/guarded_call.h"

namespace {

OT::ComposedDistribution unit_cube(std::size_t dimensions) {
  return OT::ComposedDistribution(
      OT::ComposedDistribution::DistributionCollection(dimensions, OT::Uniform(0, 1)));
}

OT::Sample places(const std::string& kind, std::size_t dimensions, std::size_t points) {
  const OT::ComposedDistribution cube = unit_cube(dimensions);
  if (kind == "random") return OT::MonteCarloExperiment(cube, points).generate();
  if (kind == "latin_hypercube") return OT::LHSExperiment(cube, points).generate();
  if (kind != "sobol") throw std::invalid_argument("no design is called " + kind);
  OT::LowDiscrepancyExperiment sobol(OT::SobolSequence(), cube, points);
  sobol.setRandomize(true);  // all places moved alike, by the seed
  return sobol.generate();
}

}  // namespace

extern "C" {

[[gnu::visibility("default")]] bool quadrille_design(const char* kind, std::size_t dimensions,
                                                     std::size_t points, std::uint64_t seed, double* out,
                                                     QuadrilleMessage* message) {
  return quadrille::guarded_call(message, [&] {
    OT::RandomGenerator::SetSeed(seed);
    const OT::Sample sample = places(kind, dimensions, points);
    for (std::size_t row = 0; row < points; ++row)
      for (std::size_t i = 0; i < dimensions; ++i) out[row * dimensions + i] = sample(row, i);
  });
}
}
