/// Objects and commands that native Vulkan programs have beside those of a small capture: images of any
/// format, pipelines with or without a fragment shader, and passes.
#pragma once

#include <vulkan/vulkan_core.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/traces/capture/small_capture.h"
#include "traces/capture/import.h"
#include "traces/frame_contents.h"

namespace quadrille::capture {

using Commands = std::vector<std::pair<const char*, nlohmann::json>>;

/// Handles behind those of the small capture.
enum : std::uint64_t {
  kImageA = 100,
  kImageB,
  kViewA,
  kViewB,
  kOwnPipeline,
  kOwnVertex,
  kOwnFragment,
  kArguments,
  kArgumentMemory
};

struct NativeImage {
  std::uint64_t image = 0, view = 0;  ///< handles; view 0: none is made
  VkFormat format = VK_FORMAT_D32_SFLOAT;
  int samples = 1;
  VkImageType type = VK_IMAGE_TYPE_2D;
  int width = 16, height = 16, depth = 1;
};
void add_image(CaptureWriter& file, const NativeImage& wish);

struct NativePipeline {
  const char* vertex = nullptr;
  const char* fragment = nullptr;  ///< null: there is none
  int colors = 0, samples = 1;
  bool depth = false;  ///< is tested and written
};
/// `kOwnPipeline`, which takes the small capture's vertices.
void add_pipeline(CaptureWriter& file, const NativePipeline& wish);
/// A buffer of so many bytes that are zeros.
void add_arguments(CaptureWriter& file, std::uint64_t bytes);

/// An attachment that is cleared to bits; view 0: it is left out.
[[nodiscard]] nlohmann::json attachment(std::uint64_t view, const std::vector<std::uint32_t>& clear);
/// Everything of a pass but its draws: they stand between. `depth`: null for none.
[[nodiscard]] Commands pass(const nlohmann::json& colors, const nlohmann::json& depth, const Commands& draws);
/// Draws the triangle of the small capture with `kOwnPipeline`.
[[nodiscard]] Commands triangle();
[[nodiscard]] nlohmann::json subresource(int aspects, int layers = 1);
[[nodiscard]] nlohmann::json extent(int width, int height = 16, int depth = 1);
[[nodiscard]] Commands together(std::initializer_list<Commands> parts);

[[nodiscard]] Import import_small(const SmallCapture& wish);
/// What is said of a capture that is refused; nothing of one that is not.
[[nodiscard]] std::string refusal(const SmallCapture& wish);
/// What the frame leaves in the image of that name. Throws if it leaves nothing.
[[nodiscard]] std::vector<std::byte> left_in(const Import& import, std::uint64_t image);

}  // namespace quadrille::capture
