#include "pipeline/frame_contents.h"

#include <cstring>
#include <map>
#include <variant>

#include "pipeline/driver/frame_builder.h"
#include "pipeline/functional/functional.h"

namespace quadrille::pipeline {
namespace {

/// Where what a part holds lies, or the one value that all its pixels have.
using Held = std::variant<models::SurfaceLayout, models::PixelCode>;

/// Follows the passes of a frame, and keeps what the latest store left in each part.
class LastStores {
 public:
  explicit LastStores(const traces::CommandStream& stream) : stream_(stream) {}

  void add(const traces::BeginPass& begin, const hw::PassState& pass) {
    for (std::size_t i = 0; i < begin.colors.size(); ++i) {
      const traces::ColorAttachmentUse& color = begin.colors[i];
      note(color, pass.color[i].surface);
      if (color.resolve != traces::kNone) held_[color.resolve_part()] = pass.resolve[i].surface;
    }
    const traces::DepthAttachmentUse& depth = begin.depth;
    if (depth.image == traces::kNone) return;
    if (pass.has_depth) note(depth, pass.depth.surface);
    else if (depth.load != traces::LoadOp::kLoad) note(depth, cleared(depth, pass));  // no draw tested it
  }
  [[nodiscard]] const std::map<traces::ImagePart, Held>& held() const { return held_; }

 private:
  void note(const traces::AttachmentUse& use, const Held& held) {
    if (use.store == traces::StoreOp::kStore) held_[use.part()] = held;
    else held_.erase(use.part());
  }
  [[nodiscard]] models::PixelCode cleared(const traces::DepthAttachmentUse& use,
                                          const hw::PassState& pass) const {
    const bool clears = use.load == traces::LoadOp::kClear;
    return models::encode_depth(stream_.images[use.image].format, pass.clear_depth,
                                clears ? use.clear_stencil : std::uint8_t{0});
  }

  const traces::CommandStream& stream_;
  std::map<traces::ImagePart, Held> held_;
};

std::vector<std::byte> texels_of(const Held& held, const traces::Image& image, std::uint32_t level,
                                 const models::DeviceMemory& memory) {
  const std::size_t bytes = traces::format_bytes(image.format);
  std::vector<std::byte> texels(traces::level_bytes(image, level));
  const auto* const surface = std::get_if<models::SurfaceLayout>(&held);
  std::vector<models::PixelCode> codes;
  if (surface != nullptr) codes = models::detile_codes(memory, *surface);
  for (std::size_t i = 0; i < texels.size() / bytes; ++i) {
    const models::PixelCode& code = surface != nullptr ? codes[i] : std::get<models::PixelCode>(held);
    std::memcpy(texels.data() + bytes * i, code.word.data(), bytes);
  }
  return texels;
}

}  // namespace

traces::FrameContents contents_after(const traces::CommandStream& stream,
                                     const models::Precision& precision) {
  DeviceFrame frame(std::uint64_t{4} << 30);
  build_frame(stream, precision, frame);
  (void)render_functional(frame.frame, frame.memory);
  LastStores stores(stream);
  std::size_t pass = 0;
  for (const traces::Command& command : stream.commands)
    if (const auto* begin = std::get_if<traces::BeginPass>(&command))
      stores.add(*begin, frame.frame.passes[pass++]);
  traces::FrameContents contents;
  for (const auto& [part, held] : stores.held()) {
    const traces::Image& image = stream.images[part.image];
    if (image.samples == 1)
      contents.parts.push_back({part, texels_of(held, image, part.level, frame.memory)});
  }
  for (const WrittenBuffer& written : frame.written_buffers) {
    const std::span<const std::byte> data = frame.memory.read(written.address, written.bytes);
    contents.buffers.push_back({written.buffer, {data.begin(), data.end()}});
  }
  return contents;
}

}  // namespace quadrille::pipeline
