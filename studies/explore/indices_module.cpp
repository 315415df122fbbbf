/// The module's Sobol indices: OpenTURNS fits a polynomial chaos to a table, whose coefficients are them.
///
/// The polynomials of a dimension are orthogonal over its values: all numbers of 0..1, or the places of its
/// levels, each as likely. So a table of all combinations of levels gives the indices of these levels, and
/// not of what might lie between them.
#include "studies/explore/design_module.h"

#include <openturns/OT.hxx>
#include <openturns/TBB.hxx>

#include <algorithm>
#include <vector>

#include "studies/explore/guarded_call.h"

namespace {

constexpr std::size_t kHighestDegree = 14, kMostTerms = 500;
constexpr double kBar = 1e-4;  // of the part of a level

/// How a dimension is spread: evenly over -1..1, as Legendre's polynomials have it, or over the middles of
/// so many parts of 0..1. OpenTURNS 1.20 cannot make polynomials of single values, so each of these is a bar
/// that is too narrow to matter.
OT::Distribution spread(std::size_t levels) {
  if (levels == 0) return OT::Uniform(-1, 1);
  const double part = 1 / static_cast<double>(levels), bar = part * kBar;
  OT::Point widths(2 * levels - 1, part - bar), heights(2 * levels - 1, 0);
  for (std::size_t i = 0; i < levels; ++i) {
    widths[2 * i] = bar;
    heights[2 * i] = 1;
  }
  return OT::Histogram((part - bar) / 2, widths, heights);
}

OT::OrthogonalUniVariatePolynomialFamily polynomials_of(const OT::Distribution& spread, std::size_t levels) {
  if (levels == 0) return OT::LegendreFactory();
  const auto& bars = dynamic_cast<const OT::Histogram&>(*spread.getImplementation());
  return OT::HistogramPolynomialFactory(bars.getFirst(), bars.getWidth(), bars.getHeight());
}

/// How many polynomials there are, in whole steps of their degree, but not more than `most`.
std::size_t whole_degrees(const OT::EnumerateFunction& order, std::size_t all, std::size_t most) {
  std::size_t whole = 1, degree = 0;
  for (std::size_t i = 1; i < all; ++i) {
    const OT::Indices powers = order(i);
    std::size_t sum = 0;
    for (std::size_t k = 0; k < powers.getSize(); ++k) sum += powers[k];
    if (sum > degree) {
      if (sum > kHighestDegree) return i;
      whole = i;
      degree = sum;
    }
    if (i >= most) return whole;
  }
  return std::min(all, most);
}

struct Basis {
  OT::OrthogonalProductPolynomialFactory polynomials;
  std::size_t terms;
};

/// As many polynomials as so many rows can tell apart.
Basis basis_of(const std::vector<std::size_t>& levels, std::size_t rows) {
  const std::size_t width = levels.size();
  OT::OrthogonalProductPolynomialFactory::PolynomialFamilyCollection families(width);
  OT::Indices highest(width);
  std::size_t all = 1;
  for (std::size_t i = 0; i < width; ++i) {
    families[i] = polynomials_of(spread(levels[i]), levels[i]);
    highest[i] = levels[i] == 0 ? kHighestDegree : std::min(levels[i] - 1, kHighestDegree);
    all = std::min(all * (highest[i] + 1), kMostTerms + 1);
  }
  OT::HyperbolicAnisotropicEnumerateFunction order(width, 1.0);  // by degree
  order.setUpperBound(highest);
  return {OT::OrthogonalProductPolynomialFactory(families, order),
          whole_degrees(order, all, std::min(rows, kMostTerms))};
}

/// The polynomial chaos that fits a table best. OpenTURNS's own algorithm would first map the places to the
/// spread of the polynomials, which they have already, and loses those of bars on the way.
OT::FunctionalChaosResult fitted(const OT::Sample& x, const OT::Sample& y, const Basis& basis) {
  OT::Collection<OT::Function> terms(basis.terms);
  OT::Indices numbers(basis.terms);
  numbers.fill();
  for (std::size_t i = 0; i < basis.terms; ++i) terms[i] = basis.polynomials.build(i);
  const OT::LeastSquaresMetaModelSelectionFactory factory{OT::LARS(), OT::CorrectedLeaveOneOut()};
  OT::Pointer<OT::ApproximationAlgorithmImplementation> fit(
      factory.build(x, y, OT::Point(x.getSize(), 1), terms, numbers));
  fit->run();
  const OT::Point found = fit->getCoefficients();
  OT::Sample coefficients(basis.terms, 1);
  for (std::size_t i = 0; i < basis.terms; ++i) coefficients(i, 0) = found[i];
  // Both share what they stand for: nothing is cut off.
  const OT::Function same = OT::IdentityFunction(x.getDimension());  // NOLINT(cppcoreguidelines-slicing)
  return {x,
          y,
          basis.polynomials.getMeasure(),
          same,
          same,
          same,
          basis.polynomials,
          numbers,
          coefficients,
          terms,
          OT::Point(1, fit->getResidual()),
          OT::Point(1, fit->getRelativeError())};
}

}  // namespace

extern "C" {

[[gnu::visibility("default")]] bool quadrille_indices(std::size_t rows, std::size_t dimensions,
                                                      const std::size_t* levels, const double* places,
                                                      const double* values, QuadrilleIndices* out,
                                                      QuadrilleMessage* message) {
  return quadrille::guarded_call(message, [&] {
    OT::Log::Show(OT::Log::NONE);
    OT::TBB::Disable();
    OT::Sample x(rows, dimensions), y(rows, 1);
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t i = 0; i < dimensions; ++i) {
        const double place = places[row * dimensions + i];
        x(row, i) = levels[i] == 0 ? 2 * place - 1 : place;
      }
      y(row, 0) = values[row];
    }
    const OT::FunctionalChaosResult result = fitted(x, y, basis_of({levels, levels + dimensions}, rows));
    // OpenTURNS 1.20 divides this error by the rows once too often: of noise it would say 1 / rows.
    out->left_over = result.getRelativeErrors()[0] * static_cast<double>(rows);
    const OT::FunctionalChaosSobolIndices indices(result);
    for (std::size_t i = 0; i < dimensions; ++i) {
      out->first[i] = indices.getSobolIndex(i);
      out->total[i] = indices.getSobolTotalIndex(i);
      for (std::size_t j = 0; j < dimensions; ++j) {
        OT::Indices both(2);
        both[0] = std::min(i, j);
        both[1] = std::max(i, j);
        out->pairs[i * dimensions + j] = i == j ? out->first[i] : indices.getSobolIndex(both);
      }
    }
  });
}
}
