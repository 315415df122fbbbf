/// The outside ruler: executes a command stream with a headless Vulkan driver that this project had no hand
/// in.
///
/// The driver wanted is Mesa's software rasterizer *lavapipe* (its ICD is chosen when VK_ICD_FILENAMES is not
/// set), because it runs on any machine, is deterministic and publishes how it rounds. Every object of the
/// stream becomes the Vulkan object of the same name, every command the command of the same name, so a
/// difference between the two images is a difference between the two renderers.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::lavapipe {

/// What the driver says of itself.
struct DeviceInfo {
  std::string name{};               ///< for example "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string driver{};             ///< for example "llvmpipe: Mesa 22.3.6 (LLVM 15.0.6)"
  std::uint32_t subpixel_bits = 0;  ///< fractional bits of a snapped window coordinate
  std::uint32_t subtexel_bits = 0;  ///< fractional bits of a texel coordinate when filtering
  /// fractional bits of the level of detail when filtering between levels
  std::uint32_t mipmap_bits = 0;
  std::uint32_t max_push_constants = 0;  ///< bytes
  std::string type{};                    ///< "cpu", "discrete GPU", ...
  std::string api_version{};             ///< for example "1.3.230"
  bool pipeline_statistics = false;      ///< counts its stages' work (feature pipelineStatisticsQuery)
  bool precise_occlusion = false;        ///< counts samples exactly (feature occlusionQueryPrecise)
  bool line_modes = false;               ///< chooses how lines become pixels (VK_EXT_line_rasterization)
  bool own_borders = false;              ///< borders of any colour (VK_EXT_custom_border_color)
  std::uint32_t timestamp_bits = 0;      ///< valid bits of a timestamp of the queue used; 0: it has none
  double timestamp_ns = 0;               ///< nanoseconds a tick
};

/// The attachments of the last pass, rows top to bottom, and what programs may have written.
struct Rendered {
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::vector<std::uint32_t> color;     ///< RGBA8 as stored (sRGB targets: encoded), red in the low byte
  std::vector<float> depth;             ///< empty when the target has none
  /// What the buffers that a descriptor set holds as storage held at the end, by index in the stream.
  std::map<traces::Index, std::vector<std::byte>> buffers{};
  /// What each colour attachment holds, or what it is resolved to, by its number, as stored.
  std::vector<std::vector<models::PixelCode>> targets{};
  /// Values of the stream's queries, in the order in which they begin (tests/lavapipe/stream_queries.h).
  std::vector<std::vector<std::uint64_t>> queries{};
};

/// Time of one submission of the whole stream, uploads and read-back excluded.
struct FrameTimes {
  double median_ms = 0, min_ms = 0;  ///< wall time
  /// processor time of the whole process: what the frame costs on one thread of a machine that is busy
  /// otherwise
  double median_cpu_ms = 0;
  int frames = 0;
};

class VulkanRenderer {
 public:
  /// Opens the driver, preferring a CPU device. With `validate` the Khronos validation layer is loaded and
  /// its messages are kept. Throws `UserError` when there is no loader, no device or no Vulkan 1.3 with what
  /// the stream needs.
  explicit VulkanRenderer(bool validate = false);
  ~VulkanRenderer();
  VulkanRenderer(const VulkanRenderer&) = delete;
  VulkanRenderer& operator=(const VulkanRenderer&) = delete;

  [[nodiscard]] const DeviceInfo& info() const;
  /// Can shaders sample images of this format?
  [[nodiscard]] bool samples(traces::Format format) const;

  /// Executes a stream that `traces::validate` accepts and reads the attachments of its last pass back.
  /// Throws `UserError` for what the device cannot do (push constants beyond its limit) and for Vulkan's own
  /// failures.
  [[nodiscard]] Rendered render(const traces::CommandStream& stream);

  /// Submits the stream `frames` times after one that warms the driver's shader caches, and reports times.
  [[nodiscard]] FrameTimes time_frames(const traces::CommandStream& stream, int frames);

  [[nodiscard]] const std::vector<std::string>& validation_messages() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace quadrille::lavapipe
