#include "studies/statistics.h"

#include <algorithm>

#include "models/base/error.h"

namespace quadrille::studies {

double quantile(std::vector<double> sample, double fraction) {
  QUADRILLE_CHECK(!sample.empty() && fraction >= 0 && fraction <= 1, "quantile {} of {} values", fraction,
                  sample.size());
  std::ranges::sort(sample);
  const double position = fraction * static_cast<double>(sample.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sample.size() - 1);
  return sample[below] + (position - static_cast<double>(below)) * (sample[above] - sample[below]);
}

Spread spread_of(const std::vector<double>& sample) {
  return {quantile(sample, 0.5), quantile(sample, 0.25), quantile(sample, 0.75), quantile(sample, 0),
          quantile(sample, 1)};
}

std::vector<std::size_t> round_order(std::size_t count, std::size_t round, std::size_t rounds) {
  std::vector<std::size_t> order(count);
  const std::size_t first = rounds >= count ? round % std::max<std::size_t>(1, count)
                                            : round * count / std::max<std::size_t>(1, rounds);
  for (std::size_t i = 0; i < count; ++i) order[i] = (first + i) % count;
  return order;
}

}  // namespace quadrille::studies
