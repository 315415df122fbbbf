/// What many runs of one thing say together: order statistics, which a few slow runs on a shared host do not
/// move, and an order of runs that is fair to all.
#pragma once

#include <cstddef>
#include <vector>

namespace quadrille::studies {

/// Order statistics of a sample, in its unit. Quartiles lie between neighbours in proportion (type 7 of [P:
/// Hyndman and Fan 1996]).
struct Spread {
  double median = 0, lower_quartile = 0, upper_quartile = 0, least = 0, most = 0;
};

/// The value below which `fraction` (0..1) of the sample lies. The sample must not be empty.
[[nodiscard]] double quantile(std::vector<double> sample, double fraction);
[[nodiscard]] Spread spread_of(const std::vector<double>& sample);

/// In which order round `round` of `rounds` runs `count` settings: each once, from another place of the list
/// each time, so that what drifts on the host (clocks, heat, neighbours) meets every setting early, in the
/// middle and late.
[[nodiscard]] std::vector<std::size_t> round_order(std::size_t count, std::size_t round, std::size_t rounds);

}  // namespace quadrille::studies
