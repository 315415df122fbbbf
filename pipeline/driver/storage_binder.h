/// Storage buffers of a frame: which ranges its programs access, which buffers they write, and whether those
/// are read in other ways, which would need what the frame has not computed yet.
#pragma once

#include "hw/frame/frame.h"
#include "pipeline/driver/device_resources.h"
#include "traces/command_stream.h"

#include <map>
#include <string>
#include <vector>

namespace quadrille::pipeline {

/// A buffer that programs of the frame write.
struct WrittenBuffer {
  traces::Index buffer = traces::kNone;
  std::uint64_t address = 0, bytes = 0;
};

class StorageBinder {
 public:
  StorageBinder(const traces::CommandStream& stream, DeviceResources& resources)
      : stream_(stream), resources_(resources), written_by_(stream.buffers.size()) {}

  /// Fills the state's buffers; `sets` holds what is bound by number of set. Throws `UserError` for one that
  /// is not bound.
  void bind(hw::ProgramState& state, const std::map<std::uint32_t, traces::Index>& sets);
  /// A draw reads the buffer as something else.
  void note_read(traces::Index buffer, const char* use) { reads_.emplace(buffer, use); }
  /// After all draws: names what programs write to `storage` and in the draws' views. Throws `UserError` for
  /// a written buffer that is also read in another way.
  [[nodiscard]] std::vector<WrittenBuffer> finish(hw::Frame& frame, models::StorageMemory& storage);

 private:
  const traces::StorageBinding& bound(const models::Program& program, const models::BufferBinding& use,
                                      const std::map<std::uint32_t, traces::Index>& sets) const;

  const traces::CommandStream& stream_;
  DeviceResources& resources_;
  std::vector<std::string> written_by_;  ///< by buffer: a program that writes it; empty: none
  std::map<traces::Index, const char*> reads_;
};

}  // namespace quadrille::pipeline
