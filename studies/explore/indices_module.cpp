/// The module's Sobol indices: OpenTURNS fits a polynomial chaos to a table, whose coefficients are them.
#include "studies/explore/design_module.h"
#include "studies/explore/guarded_call.h"

#include <openturns/OT.hxx>

#include <algorithm>
#include <cmath>

namespace {

/// Polynomials of the unit cube, as many as the rows can tell apart.
OT::FixedStrategy basis(std::size_t dimensions, std::size_t rows) {
  OT::OrthogonalProductPolynomialFactory::PolynomialFamilyCollection legendre(dimensions, OT::LegendreFactory());
  const OT::LinearEnumerateFunction order(dimensions);
  constexpr std::size_t kHighestDegree = 14;
  std::size_t degree = 1;
  while (degree < kHighestDegree && order.getStrataCumulatedCardinal(degree + 1) <= rows) ++degree;
  return {OT::OrthogonalProductPolynomialFactory(legendre, order), order.getStrataCumulatedCardinal(degree)};
}

}  // namespace

extern "C" {

[[gnu::visibility("default")]] bool quadrille_indices(std::size_t rows, std::size_t dimensions, const double* places,
                                                      const double* values, double* first, double* total,
                                                      double* pairs, double* left_over, QuadrilleMessage* message) {
  return quadrille::guarded_call(message, [&] {
    OT::Log::Show(OT::Log::NONE);
    OT::Sample x(rows, dimensions), y(rows, 1);
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t i = 0; i < dimensions; ++i) x(row, i) = places[row * dimensions + i];
      y(row, 0) = values[row];
    }
    const OT::ComposedDistribution cube(
        OT::ComposedDistribution::DistributionCollection(dimensions, OT::Uniform(0, 1)));
    const OT::LeastSquaresStrategy fit(
        x, y, OT::LeastSquaresMetaModelSelectionFactory(OT::LARS(), OT::CorrectedLeaveOneOut()));
    OT::FunctionalChaosAlgorithm algorithm(x, y, cube, basis(dimensions, rows), fit);
    algorithm.run();
    const OT::FunctionalChaosResult result = algorithm.getResult();
    *left_over = result.getRelativeErrors()[0];
    const OT::FunctionalChaosSobolIndices indices(result);
    for (std::size_t i = 0; i < dimensions; ++i) {
      first[i] = indices.getSobolIndex(i);
      total[i] = indices.getSobolTotalIndex(i);
      for (std::size_t j = 0; j < dimensions; ++j) {
        OT::Indices both(2);
        both[0] = std::min(i, j);
        both[1] = std::max(i, j);
        pairs[i * dimensions + j] = i == j ? first[i] : indices.getSobolIndex(both);
      }
    }
  });
}
}
