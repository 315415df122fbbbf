/// A capture of one frame of 16x16 pixels, made here: a triangle over the lower left half, in the colour that
/// a texture of one texel has.
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "tests/traces/capture/capture_writer.h"
#include "traces/command_stream.h"

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
  kQueue,
  kBlocks,
  kBlockMemory,
  kSecondSetLayout,
  kSecondSet
};

struct SmallCapture {
  Packing packing = Packing::kPlain;
  bool negative_one_to_one = false;     ///< with depths of -1 .. 1, as OpenGL has
  const char* entry = "main";           ///< of both shaders
  const char* extra_command = nullptr;  ///< a command without a meaning here, by name, within the pass
  bool sampler_counts_texels = false;
  /// The texture is element 0 of an array of two, with samplers of the layout, and element 1 is never
  /// written; three blocks of two sets are bound with dynamic offsets of 0, 256 and 512 bytes, and the blue
  /// of the triangle is that of the third.
  bool arrays = false;
  /// Nothing holds the texture but the bytes of its memory, which is mapped.
  bool texture_in_memory = false;
  bool lavapipe = true;  ///< is the device
  bool loads = false;    ///< the pass begins with what was there
  /// Of a second frame and so on: a triangle in the lower right quarter, on top of what was there.
  int frames = 1;
  /// A later frame's pass clears this part instead, and renders to nothing else.
  nlohmann::json later_area{};
  /// commands within the pass behind the draw, with their parameters
  std::vector<std::pair<const char*, nlohmann::json>> behind{};
  /// commands before the pass, with their parameters
  std::vector<std::pair<const char*, nlohmann::json>> before{};
  /// makes more objects, before the commands
  std::function<void(CaptureWriter&)> objects{};
};
/// A module and a call that makes it, with entry point "main".
void add_shader(CaptureWriter& file, std::uint64_t handle, const char* source, traces::ShaderStage stage,
                const char* entry = "main");
[[nodiscard]] std::vector<std::byte> small_capture(const SmallCapture& wish = {});
inline constexpr std::uint8_t kTexel[4] = {200, 100, 50, 255};
inline constexpr std::array<float, 3> kBlueOfBlocks{0, 0.25f, 1};

}  // namespace quadrille::capture
