#include "studies/explore/design.h"

#include <fmt/format.h>

#include "studies/explore/designs_library.h"

namespace quadrille::studies::explore {

std::vector<double> design_places(const std::string& kind, std::size_t dimensions, std::size_t points,
                                  std::uint64_t seed) {
  return in_designs_library(fmt::format("design {}", kind), [&](QuadrilleMessage* message) {
    std::vector<double> places(dimensions * points);
    (void)of_designs_library<QuadrilleDesign>("quadrille_design")(kind.c_str(), dimensions, points, seed,
                                                                  places.data(), message);
    return places;
  });
}

Plan planned(const Sweep& sweep, const Space& space) {
  if (sweep.design == DesignKind::kGrid) return space.grid();
  const std::string kind(kDesignNames[static_cast<std::size_t>(sweep.design)]);
  return space.at(design_places(kind, sweep.dimensions.size(), sweep.points, sweep.seed));
}

}  // namespace quadrille::studies::explore
