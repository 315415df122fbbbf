/// The queries of a command stream as Vulkan's, and what they come to.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <vector>

#include "tests/lavapipe/vulkan_device.h"
#include "traces/command_stream.h"

namespace quadrille::lavapipe {

class StreamQueries {
 public:
  /// `device` and `stream` must outlive it.
  StreamQueries(const VulkanDevice& device, const traces::CommandStream& stream);

  // Recorded into the frame; `reset` outside of rendering.
  void reset(VkCommandBuffer commands) const;
  void begin(VkCommandBuffer commands, const traces::BeginQuery& c);
  void end(VkCommandBuffer commands, const traces::EndQuery& c) const;

  /// Of the last submission, which has ended: the values of each query in the order in which they begin;
  /// statistics in the order of their bits.
  [[nodiscard]] std::vector<std::vector<std::uint64_t>> results() const;

 private:
  const VulkanDevice& device_;
  const traces::CommandStream& stream_;
  Cleanup cleanup_;
  std::vector<VkQueryPool> pools_;
  std::vector<traces::BeginQuery> begun_;
};

}  // namespace quadrille::lavapipe
