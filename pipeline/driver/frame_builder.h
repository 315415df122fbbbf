/// The driver: turns a command stream into what the machine executes. Allocates device memory, uploads and
/// tiles, compiles shaders, resolves state by draw.
///
/// Only what some draw reads is uploaded and compiled in; what was left out is listed with the reason. A
/// texture's texels come when something samples them.
#pragma once

#include "hw/frame/frame.h"
#include "pipeline/compiler/compile.h"
#include "pipeline/driver/frame_target.h"
#include "pipeline/driver/query_ranges.h"
#include "pipeline/driver/sampled_image.h"
#include "pipeline/driver/storage_binder.h"
#include "pipeline/driver/texture_fills.h"
#include "traces/command_stream.h"

#include <deque>
#include <string>
#include <vector>

namespace quadrille::pipeline {

/// Something this frame does not need and that was therefore not built or computed.
struct LeftOut {
  std::string what, why, saved;
};

/// A frame with the memory and programs it refers to. Not movable: the frame points into it.
struct DeviceFrame {
  explicit DeviceFrame(std::uint64_t memory_limit) : memory(memory_limit), fills(memory), storage(memory) {}
  DeviceFrame(const DeviceFrame&) = delete;
  DeviceFrame& operator=(const DeviceFrame&) = delete;
  models::DeviceMemory memory;
  TextureFills fills;
  models::StorageMemory storage;
  std::vector<WrittenBuffer> written_buffers;  ///< in order of the stream's buffers
  std::deque<CompiledPipeline> programs;
  hw::Frame frame;
  std::vector<QueryRange> queries;  ///< in the order in which they begin
  std::vector<LeftOut> left_out;
  std::vector<SampledImage> sampled;  ///< that programs of draws may sample (`hw::TextureState::texture`)
  /// the target of the last pass has a depth attachment, whether it is tested or not
  bool shown_has_depth = false;
  std::uint64_t buffer_bytes = 0, texture_bytes = 0, surface_bytes = 0;
  [[nodiscard]] bool reads_textures() const;
  /// Some draw's program has a storage buffer.
  [[nodiscard]] bool uses_storage() const;
  /// Names of programs whose outputs depend on the order of warps, each once.
  [[nodiscard]] std::vector<std::string> order_dependent() const;
  /// A pass of it has depths: some draw tests them, or a later pass reads them.
  [[nodiscard]] bool keeps_depth() const;
  [[nodiscard]] bool blends() const;
};

/// Fills `out` from a validated stream. With `leave_out` false what no draw reads is uploaded too, behind all
/// else, so that no address depends on it, and all texels come now. Programs are compiled, and
/// textures laid out, for `target`.
/// The stream must live as long as `out` is run. Throws `UserError` for a shader that does not compile, a
/// stage interface that does not match, or memory that does not fit.
void build_frame(const traces::CommandStream& stream, const models::Precision& precision, DeviceFrame& out,
                 bool leave_out = true, const FrameTarget& target = {});

}  // namespace quadrille::pipeline
