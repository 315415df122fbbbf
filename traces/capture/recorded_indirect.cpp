/// Draws whose arguments lie in a buffer: they are read from what the import knows of it. [VK1.3
/// #drawing-indirect]
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "models/base/error.h"
#include "traces/capture/frame_recorder.h"

namespace quadrille::capture {
namespace {

constexpr std::uint32_t kMostDraws = 65536;  // of a call [G: far beyond what any frame draws at once]

}  // namespace

bool FrameRecorder::draw_indirect(const Call& call, const BoundState& bound) {
  const Value& p = call.parameters;
  const bool indexed = call.name.starts_with("CmdDrawIndexedIndirect");
  if (!indexed && !call.name.starts_with("CmdDrawIndirect")) return false;
  std::uint32_t draws = 0;
  if (call.name.ends_with("Count"))
    draws = std::min(p["maxDrawCount"].u32(),
                     arguments(p["countBuffer"].u64(), p["countBufferOffset"].u64(), sizeof draws)[0]);
  else draws = p["drawCount"].u32();
  if (draws > kMostDraws) throw user_error("of {} draws; at most {} are possible", draws, kMostDraws);
  if (draws == 0) return true;
  const std::uint64_t bytes = (indexed ? 5 : 4) * sizeof(std::uint32_t), stride = p["stride"].u32();
  if (draws > 1 && (stride < bytes || stride % sizeof(std::uint32_t) != 0))
    throw user_error("whose arguments, of {} bytes, follow each other by {}", bytes, stride);
  const std::vector<std::uint32_t> all =
      arguments(p["buffer"].u64(), p["offset"].u64(), (draws - 1) * stride + bytes);
  for (std::size_t i = 0; i < draws; ++i) {
    const std::span<const std::uint32_t> one = std::span(all).subspan(i * stride / sizeof(std::uint32_t));
    DrawRange range{indexed, one[0], one[2], 0, one[1], indexed ? one[4] : one[3]};
    if (indexed) range.vertex_offset = std::bit_cast<std::int32_t>(one[3]);
    if (range.count > 0 && range.instances > 0) draw_one(bound, range);
  }
  return true;
}

std::vector<std::uint32_t> FrameRecorder::arguments(Handle buffer, std::uint64_t offset,
                                                    std::uint64_t bytes) const {
  if (device_.read_back.contains(buffer)) throw user_error("buffer {} holds what a pass drew", buffer);
  const BufferObject& whole = object(device_.buffers, buffer, "buffer");
  if (offset > whole.size || bytes > whole.size - offset)
    throw user_error("whose arguments are bytes {}+{} of a buffer of {}", offset, bytes, whole.size);
  const MemoryRange range{whole.memory, whole.offset + offset, whole.offset + offset + bytes};
  for (const MemoryRange& written : written_)
    if (written.memory == range.memory && written.begin < range.end && range.begin < written.end)
      throw user_error("whose arguments a shader of the frame may have written");
  const std::vector<std::byte> known = device_.contents({bytes, whole.memory, range.begin});
  std::vector<std::uint32_t> words(bytes / sizeof(std::uint32_t));
  std::memcpy(words.data(), known.data(), words.size() * sizeof(std::uint32_t));
  return words;
}

void FrameRecorder::note_written(const BoundDescriptor& bound) {
  const auto found = device_.buffers.find(bound.is.buffer);
  if (found == device_.buffers.end()) return;
  const BufferObject& buffer = found->second;
  const std::uint64_t begin = std::min(bound.is.offset + bound.dynamic_offset, buffer.size);
  const std::uint64_t size = std::min(bound.is.range, buffer.size - begin);  // VK_WHOLE_SIZE is greater
  written_.insert({buffer.memory, buffer.offset + begin, buffer.offset + begin + size});
}

}  // namespace quadrille::capture
