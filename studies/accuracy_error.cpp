#include "studies/accuracy_error.h"

#include <cmath>
#include <limits>

#include "models/base/error.h"
#include "models/reference/compare.h"

namespace quadrille::studies {

double relative_percent(double exact, double other) {
  if (exact == other) return 0;
  if (exact == 0) return std::numeric_limits<double>::infinity();
  return 100.0 * (other - exact) / exact;
}

CostError cost_error(const MachineCost& exact, const MachineCost& other) {
  QUADRILLE_CHECK(exact.units.size() == other.units.size() && exact.clients.size() == other.clients.size(),
                  "figures of two machines");
  CostError error;
  error.cycles_percent =
      relative_percent(static_cast<double>(exact.cycles), static_cast<double>(other.cycles));
  double sum = 0;
  for (std::size_t i = 0; i < exact.units.size(); ++i) {
    QUADRILLE_CHECK(exact.units[i].path == other.units[i].path, "{} is not {}", exact.units[i].path,
                    other.units[i].path);
    const double points = std::abs(other.units[i].percent - exact.units[i].percent);
    sum += points;
    if (points <= error.busy_max_points) continue;
    error.busy_max_points = points;
    error.worst_unit = exact.units[i].path;
  }
  if (!exact.units.empty()) error.busy_mean_points = sum / static_cast<double>(exact.units.size());
  error.memory_percent =
      relative_percent(static_cast<double>(exact.memory_bytes), static_cast<double>(other.memory_bytes));
  for (std::size_t i = 0; i < exact.clients.size(); ++i) {
    const double percent = std::abs(relative_percent(static_cast<double>(exact.clients[i].bytes),
                                                     static_cast<double>(other.clients[i].bytes)));
    if (percent <= error.client_max_percent) continue;
    error.client_max_percent = percent;
    error.worst_client = exact.clients[i].name;
  }
  return error;
}

ImageError image_error(std::span<const std::uint32_t> image, std::span<const std::uint32_t> ideal,
                       std::span<const std::uint8_t> left_out) {
  const auto pixels = static_cast<std::uint32_t>(image.size());
  const auto d = models::reference::compare_images({pixels, 1, image}, {pixels, 1, ideal}, left_out, false);
  ImageError error;
  error.pixels = d.pixels;
  double squares = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t step = 0; step < 256; ++step)
      squares += static_cast<double>(step * step) * static_cast<double>(d.histogram[c][step]);
  }
  error.rmse = d.pixels > 0 ? std::sqrt(squares / (3.0 * static_cast<double>(d.pixels))) : 0;
  error.psnr_db = d.psnr_db;
  error.within_1_percent = 100 * d.fraction_within(1);
  error.within_2_percent = 100 * d.fraction_within(2);
  error.max = d.max_lsb;
  return error;
}

}  // namespace quadrille::studies
