/// Draws streams on an opened device and keeps what it says of them.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "tests/lavapipe/measured_points.h"
#include "tests/lavapipe/measurement.h"
#include "tests/lavapipe/vulkan_device.h"

namespace quadrille::lavapipe {

struct MeasureOptions {
  bool times = true, statistics = true;
  int repeats = 21;                                ///< of a stream whose time is taken, after `kWarmUps`
  std::chrono::steady_clock::time_point enough{};  ///< from then on each stream is timed once
  std::string pictures{};                          ///< folder that receives what each point drew; empty: none
};

/// Frames before the first that is timed: a device raises its clock under load.
inline constexpr int kWarmUps = 5;

/// Throws `UserError` when the device cannot do what the options ask, naming the flag that does without.
void require_features(const DeviceInfo& device, const MeasureOptions& options);

/// One stream, its passes summed. The device can do what the options ask.
[[nodiscard]] MeasuredPoint measure(const VulkanDevice& device, const traces::CommandStream& stream,
                                    const MeasureOptions& options);

/// All points of the experiments, in order; `progress` is told of each before it is drawn.
[[nodiscard]] Measurement measure_all(const VulkanDevice& device,
                                      const std::vector<MeasuredExperiment>& experiments,
                                      const MeasureOptions& options,
                                      const std::function<void(const std::string&)>& progress);

}  // namespace quadrille::lavapipe
