#include "tests/pipeline/begun_stream.h"

#include <algorithm>

#include "pipeline/frame_contents.h"
#include "traces/attachment_texels.h"

namespace quadrille::pipeline::test {
namespace {

/// With the last row first.
void put(traces::Image& image, const traces::FrameContents::Part& from) {
  image.texels.resize(traces::texel_bytes(image));
  const std::span<const std::byte> place = traces::part_texels(image, from.part.level, from.part.layer);
  const auto rows = static_cast<std::ptrdiff_t>(traces::level_height(image, from.part.level));
  const auto row = static_cast<std::ptrdiff_t>(place.size()) / rows;
  const auto to = image.texels.begin() + (place.data() - image.texels.data());
  for (std::ptrdiff_t y = 0; y < rows; ++y)
    std::copy_n(from.texels.begin() + y * row, row, to + (rows - 1 - y) * row);
}

}  // namespace

traces::CommandStream begun_stream(const traces::CommandStream& stream, bool clears_depths) {
  traces::CommandStream begun = stream;
  for (const traces::FrameContents::Part& part : contents_after(stream, {}).parts)
    put(begun.images[part.part.image], part);
  const auto load = [&](traces::AttachmentUse& use) {
    if (use.image != traces::kNone && traces::begins_with_texels(begun.images[use.image]))
      use.load = traces::LoadOp::kLoad;
  };
  for (traces::Command& command : begun.commands) {
    auto* const pass = std::get_if<traces::BeginPass>(&command);
    if (pass == nullptr) continue;
    for (traces::ColorAttachmentUse& color : pass->colors) load(color);
    if (!clears_depths) load(pass->depth);
  }
  traces::validate(begun);
  return begun;
}

}  // namespace quadrille::pipeline::test
