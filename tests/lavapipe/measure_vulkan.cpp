#include "tests/lavapipe/measure_vulkan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "models/base/error.h"
#include "tests/lavapipe/vulkan_frame.h"

namespace quadrille::lavapipe {
namespace {

std::uint32_t passes_of(const traces::CommandStream& stream) {
  return static_cast<std::uint32_t>(std::ranges::count_if(stream.commands, [](const auto& command) {
    return std::holds_alternative<traces::BeginPass>(command);
  }));
}

std::vector<double> times_of(const VulkanDevice& device, const traces::CommandStream& stream,
                             const MeasureOptions& options) {
  const PassQueries queries(device, PassQueries::What::kTimes, passes_of(stream));
  const VulkanFrame frame(device, stream, &queries);
  const auto enough = [&] { return std::chrono::steady_clock::now() >= options.enough; };
  for (int i = 0; i < kWarmUps && !(i > 0 && enough()); ++i) frame.submit();
  std::vector<double> times;
  do {
    frame.submit();
    times.push_back(queries.time_ns());
  } while (static_cast<int>(times.size()) < options.repeats && !enough());
  return times;
}

PassStatistics statistics_of(const VulkanDevice& device, const traces::CommandStream& stream) {
  const PassQueries queries(device, PassQueries::What::kStatistics, passes_of(stream));
  const VulkanFrame frame(device, stream, &queries);
  frame.submit();
  return queries.statistics();
}

/// A portable pixmap (P6), which needs no library: the machine that draws may have none.
void save_picture(const std::filesystem::path& path, const Rendered& picture) {
  std::ofstream file(path, std::ios::binary);
  file << fmt::format("P6\n{} {}\n255\n", picture.width, picture.height);
  for (const std::uint32_t rgba : picture.color) {
    for (const int shift : {0, 8, 16}) file.put(static_cast<char>(rgba >> shift));
  }
  if (!file.flush()) throw user_error("--pictures: {}: cannot be written", path.string());
}

}  // namespace

void require_features(const DeviceInfo& device, const MeasureOptions& options) {
  if (options.times && device.timestamp_bits == 0)
    throw user_error(
        "Vulkan: {} has no timestamps on its graphics queue; --no-times measures statistics alone",
        device.name);
  if (options.statistics && !device.pipeline_statistics)
    throw user_error(
        "Vulkan: {} has no pipeline statistics (pipelineStatisticsQuery); --no-statistics measures times "
        "alone",
        device.name);
  if (options.statistics && !device.precise_occlusion)
    throw user_error(
        "Vulkan: {} does not count samples (occlusionQueryPrecise); --no-statistics measures times alone",
        device.name);
}

MeasuredPoint measure(const VulkanDevice& device, const traces::CommandStream& stream,
                      const MeasureOptions& options) {
  MeasuredPoint point;
  if (options.statistics) point.statistics = statistics_of(device, stream);
  if (options.times) point.times = times_of(device, stream, options);
  return point;
}

Measurement measure_all(const VulkanDevice& device, const std::vector<MeasuredExperiment>& experiments,
                        const MeasureOptions& options,
                        const std::function<void(const std::string&)>& progress) {
  require_features(device.info(), options);
  Measurement measurement;
  measurement.device = device.info().name;
  measurement.driver = device.info().driver;
  measurement.vulkan = device.info();
  measurement.time_unit = "ns";
  for (const MeasuredExperiment& e : experiments) {
    measurement.curves.push_back({e.name, e.axis, {}});
    for (const Point& p : e.points) {
      progress(e.name + ", " + p.name);
      const traces::CommandStream stream = p.stream();
      MeasuredPoint point = measure(device, stream, options);
      if (!options.pictures.empty()) {
        const VulkanFrame frame(device, stream);
        frame.submit();
        save_picture(std::filesystem::path(options.pictures) / (file_name(e, p) + ".ppm"), frame.read_back());
      }
      point.name = p.name;
      point.x = p.x;
      measurement.curves.back().points.push_back(std::move(point));
    }
  }
  return measurement;
}

}  // namespace quadrille::lavapipe
