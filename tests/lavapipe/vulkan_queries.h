/// What a device says of the passes it drew: how long each took, and how much work its stages did.
///
/// Vulkan leaves room in what a stage counts [VK1.3 #queries-pipestats]: docs/hardware.md says what each
/// driver makes of it.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <vector>

#include "tests/lavapipe/vulkan_device.h"

namespace quadrille::lavapipe {

/// Sums over the passes of a frame.
struct PassStatistics {
  std::uint64_t input_vertices = 0;        ///< input assembly
  std::uint64_t input_primitives = 0;      ///< input assembly
  std::uint64_t vertex_invocations = 0;    ///< of the vertex shader
  std::uint64_t clipping_invocations = 0;  ///< primitives that reached clipping
  std::uint64_t clipping_primitives = 0;   ///< primitives that clipping gave out
  std::uint64_t fragment_invocations = 0;  ///< of the fragment shader
  /// samples that passed the depth test, by a precise occlusion query
  std::uint64_t samples_passed = 0;

  bool operator==(const PassStatistics&) const = default;
};

/// Query pools for the passes of one frame. The device must be able to do what is asked.
class PassQueries {
 public:
  enum class What : std::uint8_t {
    kTimes,      ///< timestamps before and after each pass
    kStatistics  ///< counting, which can slow a device down and is therefore not asked together with times
  };
  /// `device` must outlive the queries.
  PassQueries(const VulkanDevice& device, What what, std::uint32_t passes);

  // Recorded into the frame: `reset` before all passes, the others around each pass, outside of its
  // rendering.
  void reset(VkCommandBuffer commands) const;
  void begin(VkCommandBuffer commands, std::uint32_t pass) const;
  void end(VkCommandBuffer commands, std::uint32_t pass) const;

  // Of the last submission, which has ended.
  /// Nanoseconds, summed over the passes.
  [[nodiscard]] double time_ns() const;
  [[nodiscard]] PassStatistics statistics() const;

 private:
  [[nodiscard]] VkQueryPool create_pool(VkQueryType type, std::uint32_t count,
                                        VkQueryPipelineStatisticFlags counted);
  [[nodiscard]] std::vector<std::uint64_t> results(VkQueryPool pool, std::uint32_t queries,
                                                   std::uint32_t values) const;

  const VulkanDevice& device_;
  What what_;
  std::uint32_t passes_;
  Cleanup cleanup_;
  VkQueryPool times_ = VK_NULL_HANDLE, statistics_ = VK_NULL_HANDLE, samples_ = VK_NULL_HANDLE;
};

}  // namespace quadrille::lavapipe
