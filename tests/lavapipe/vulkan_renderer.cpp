/// The renderer's public face: device, one frame per call, and timing.
#include "tests/lavapipe/vulkan_renderer.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include "models/base/error.h"
#include "tests/lavapipe/vulkan_device.h"
#include "tests/lavapipe/vulkan_enums.h"
#include "tests/lavapipe/vulkan_frame.h"

namespace quadrille::lavapipe {

struct VulkanRenderer::State {
  explicit State(bool validate) : device({.validate = validate}) {}
  VulkanDevice device;
};

VulkanRenderer::VulkanRenderer(bool validate) : state_(std::make_unique<State>(validate)) {}
VulkanRenderer::~VulkanRenderer() = default;

const DeviceInfo& VulkanRenderer::info() const { return state_->device.info(); }
bool VulkanRenderer::samples(traces::Format format) const {
  return state_->device.samples(vk_format(format));
}
const std::vector<std::string>& VulkanRenderer::validation_messages() const {
  return state_->device.messages();
}

Rendered VulkanRenderer::render(const traces::CommandStream& stream) {
  const VulkanFrame frame(state_->device, stream);
  frame.submit();
  return frame.read_back();
}

FrameTimes VulkanRenderer::time_frames(const traces::CommandStream& stream, int frames) {
  QUADRILLE_CHECK(frames > 0, "time_frames asked for {} frames", frames);
  const VulkanFrame frame(state_->device, stream);
  frame.submit();
  std::vector<double> wall_ms, cpu_ms;
  for (int i = 0; i < frames; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t cpu_begin = std::clock();
    frame.submit();
    cpu_ms.push_back(1e3 * static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC);
    wall_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(wall_ms.begin(), wall_ms.end());
  std::sort(cpu_ms.begin(), cpu_ms.end());
  const std::size_t middle = wall_ms.size() / 2;
  return {.median_ms = wall_ms[middle],
          .min_ms = wall_ms.front(),
          .median_cpu_ms = cpu_ms[middle],
          .frames = frames};
}

}  // namespace quadrille::lavapipe
