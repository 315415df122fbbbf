/// A capture of one frame of 16x16 pixels, made here: a triangle over the lower left half, in the colour that
/// a texture of one texel has.
#pragma once

#include <nlohmann/json.hpp>

#include <utility>
#include <vector>

#include "tests/traces/capture/capture_writer.h"

namespace quadrille::capture {

/// Handles, each with a number of its own.
enum : std::uint64_t {
  kDevice = 1,
  kSwapchain,
  kShown,
  kShownView,
  kMemory,
  kVertices,
  kTexture,
  kTextureView,
  kSampler,
  kSetLayout,
  kLayout,
  kSet,
  kVertexModule,
  kFragmentModule,
  kPipeline,
  kCommands,
  kQueue
};

struct SmallCapture {
  Packing packing = Packing::kPlain;
  bool negative_one_to_one = false;     ///< with depths of -1 .. 1, as OpenGL has
  const char* entry = "main";           ///< of both shaders
  const char* extra_command = nullptr;  ///< a command without a meaning here, by name, within the pass
  bool sampler_counts_texels = false;
  bool loads = false;  ///< the pass begins with what was there
  /// Of a second frame and so on: a triangle in the upper right quarter, on top of what was there.
  int frames = 1;
  /// commands before the pass, with their parameters
  std::vector<std::pair<const char*, nlohmann::json>> before{};
};
[[nodiscard]] std::vector<std::byte> small_capture(const SmallCapture& wish = {});
inline constexpr std::uint8_t kTexel[4] = {200, 100, 50, 255};

}  // namespace quadrille::capture
