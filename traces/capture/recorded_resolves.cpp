/// Resolves outside of a pass: a pass of their own that loads the samples, draws nothing, and resolves them
/// at its end.
#include <vulkan/vulkan_core.h>

#include <algorithm>

#include "models/base/error.h"
#include "traces/capture/frame_recorder.h"

namespace quadrille::capture {
namespace {

/// Does the area at that offset hold the whole level?
bool is_whole(const ImageObject& image, const Value& part, const Value& offset, const Value& extent) {
  const std::uint32_t level = part["mipLevel"].u32();
  if (level >= image.levels) throw user_error("level {} of an image that has {}", level, image.levels);
  return offset["x"].i32() == 0 && offset["y"].i32() == 0 &&
         extent["width"].u32() == std::max(1u, image.width >> level) &&
         extent["height"].u32() == std::max(1u, image.height >> level);
}

}  // namespace

void FrameRecorder::resolve(const Value& call) {
  if (in_pass_) throw user_error("within a pass");
  const Handle source = call["srcImage"].u64(), target = call["dstImage"].u64();
  const ImageObject &from = object(device_.images, source, "image"),
                    &to = object(device_.images, target, "image");
  if (from.samples == 1 || to.samples != 1)
    throw user_error("of {} samples a pixel to {}", from.samples, to.samples);
  if (from.format != to.format) throw user_error("between formats");
  for (std::size_t i = 0; i < call["pRegions"].size(); ++i) {
    const Value& region = call["pRegions"].at(i);
    const Value &part = region["srcSubresource"], &to_part = region["dstSubresource"];
    if (are_depths(part, to_part)) throw user_error("of depths");
    if (!is_whole(from, part, region["srcOffset"], region["extent"]) ||
        !is_whole(to, to_part, region["dstOffset"], region["extent"]))
      throw user_error("of a part of an image");
    const std::uint32_t layers = to_part["layerCount"].u32();
    if (layers > std::min(from.layers, to.layers)) throw user_error("of {} layers", layers);
    for (std::uint32_t k = 0; k < layers; ++k)
      resolve_layer({source, part["mipLevel"].u32(), part["baseArrayLayer"].u32() + k},
                    {target, to_part["mipLevel"].u32(), to_part["baseArrayLayer"].u32() + k});
  }
}

void FrameRecorder::resolve_layer(const StoredPart& source, const StoredPart& target) {
  const traces::Index resolved = attachment_of(target, false);
  begin_blit(source, false);
  auto& begin = std::get<traces::BeginPass>(tables_.stream.commands[begin_at_]);
  traces::ColorAttachmentUse& use = begin.colors[0];
  if (use.load == traces::LoadOp::kDontCare) pass_lacks_.insert(use.image);
  use.resolve = resolved;
  use.resolve_level = target.level;
  use.resolve_layer = target.layer;
  pass_stores_.push_back(target);
  last_shown_ = target.image;
  end_pass();
}

}  // namespace quadrille::capture
