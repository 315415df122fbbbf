/// Copies between buffers and images. What no pass has drawn to is copied here and now, as the program's
/// memory; what a pass has drawn is copied by a draw.
#include <vulkan/vulkan_core.h>

#include "models/base/error.h"
#include "traces/capture/frame_recorder.h"

namespace quadrille::capture {

bool FrameRecorder::copy(const Call& call) {
  const Value& p = call.parameters;
  if (call.name == "CmdCopyBuffer") {
    for (std::size_t i = 0; i < p["pRegions"].size(); ++i)
      device_.copy_buffer(p["srcBuffer"].u64(), p["dstBuffer"].u64(), p["pRegions"].at(i));
  } else if (call.name == "CmdUpdateBuffer") {
    device_.write_buffer(p["dstBuffer"].u64(), p["dstOffset"].u64(), p["pData"].bytes());
  } else if (call.name == "CmdFillBuffer") {
    device_.fill_buffer(p);
  } else if (call.name == "CmdCopyBufferToImage") {
    if (tables_.stored(p["dstImage"].u64())) throw user_error("to an image that a pass has drawn to");
    for (std::size_t i = 0; i < p["pRegions"].size(); ++i)
      device_.copy_to_image(p["srcBuffer"].u64(), p["dstImage"].u64(), p["pRegions"].at(i));
  } else if (call.name == "CmdCopyImageToBuffer") {
    // The program reads it back, behind the frame; only a draw that used it would have to know.
    device_.read_back.insert(p["dstBuffer"].u64());
  } else if (call.name == "CmdCopyImage") {
    copy_images(p);
  } else {
    return false;
  }
  return true;
}

void FrameRecorder::copy_images(const Value& call) {
  const Handle source = call["srcImage"].u64(), target = call["dstImage"].u64();
  const bool drawn = tables_.stored(source) || tables_.stored(target);
  for (std::size_t i = 0; i < call["pRegions"].size(); ++i) {
    const Value& region = call["pRegions"].at(i);
    if (!drawn) {
      device_.copy_image(source, target, region);
      continue;
    }
    const Value &from = region["srcSubresource"], &to = region["dstSubresource"], &extent = region["extent"];
    if (in_pass_) throw user_error("within a pass");
    if (from["aspectMask"].u32() != VK_IMAGE_ASPECT_COLOR_BIT || to["layerCount"].u32() != 1 ||
        extent["depth"].u32() != 1)
      throw user_error("of depths, or of several layers, that a pass has drawn");
    if (object(device_.images, source, "image").format != object(device_.images, target, "image").format)
      throw user_error("between formats, of what a pass has drawn");
    DrawnCopy copy;
    copy.source = {source, from["mipLevel"].u32(), from["baseArrayLayer"].u32()};
    copy.target = {target, to["mipLevel"].u32(), to["baseArrayLayer"].u32()};
    copy.to = {region["dstOffset"]["x"].i32(), region["dstOffset"]["y"].i32(), extent["width"].u32(),
               extent["height"].u32()};
    copy.from = {static_cast<float>(region["srcOffset"]["x"].i32()),
                 static_cast<float>(region["srcOffset"]["y"].i32()), static_cast<float>(copy.to.width),
                 static_cast<float>(copy.to.height)};
    draw_copy(copy, "copy");
  }
}

}  // namespace quadrille::capture
