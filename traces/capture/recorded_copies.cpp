/// Copies between buffers and images. What no pass has drawn to is copied here and now, as the program's
/// memory; what a pass has drawn is copied by a draw.
#include <vulkan/vulkan_core.h>

#include <utility>

#include "models/base/error.h"
#include "traces/capture/frame_recorder.h"

namespace quadrille::capture {
namespace {

/// The name of a call without the 2 at its end, and where its parameters are: of one with a 2, behind a
/// pointer.
std::pair<std::string_view, const Value*> plain(const Call& call) {
  if (!call.name.ends_with('2')) return {call.name, &call.parameters};
  const std::string_view name = call.name.substr(0, call.name.size() - 1);
  const std::string info = fmt::format("p{}Info", name.substr(std::string_view("Cmd").size()));
  return {name, call.parameters.has(info) ? &call.parameters[info] : &call.parameters};
}

}  // namespace

bool FrameRecorder::copy(const Call& call) {
  const auto [name, info] = plain(call);
  const Value& p = *info;
  if (name == "CmdCopyBuffer") {
    for (std::size_t i = 0; i < p["pRegions"].size(); ++i)
      device_.copy_buffer(p["srcBuffer"].u64(), p["dstBuffer"].u64(), p["pRegions"].at(i));
  } else if (name == "CmdUpdateBuffer") {
    device_.write_buffer(p["dstBuffer"].u64(), p["dstOffset"].u64(), p["pData"].bytes());
  } else if (name == "CmdFillBuffer") {
    device_.fill_buffer(p);
  } else if (name == "CmdCopyBufferToImage") {
    if (tables_.stored(p["dstImage"].u64())) throw user_error("to an image that a pass has drawn to");
    for (std::size_t i = 0; i < p["pRegions"].size(); ++i)
      device_.copy_to_image(p["srcBuffer"].u64(), p["dstImage"].u64(), p["pRegions"].at(i));
  } else if (name == "CmdCopyImageToBuffer") {
    // The program reads it back, behind the frame; only a draw that used it would have to know.
    device_.read_back.insert(p["dstBuffer"].u64());
  } else {
    return copy_pixels(name, p);
  }
  return true;
}

bool FrameRecorder::copy_pixels(std::string_view name, const Value& info) {
  if (name == "CmdCopyImage") copy_images(info);
  else if (name == "CmdBlitImage") blit(info);
  else if (name == "CmdResolveImage") resolve(info);
  else return false;
  return true;
}

void FrameRecorder::copy_images(const Value& call) {
  const Handle source = call["srcImage"].u64(), target = call["dstImage"].u64();
  const bool drawn = tables_.stored(source) || tables_.stored(target);
  for (std::size_t i = 0; i < call["pRegions"].size(); ++i) {
    const Value& region = call["pRegions"].at(i);
    if (drawn) copy_drawn(source, target, region);
    else device_.copy_image(source, target, region);
  }
}

void FrameRecorder::copy_drawn(Handle source, Handle target, const Value& region) {
  const Value &from = region["srcSubresource"], &to = region["dstSubresource"], &extent = region["extent"];
  if (in_pass_) throw user_error("within a pass");
  if (extent["depth"].u32() != 1) throw user_error("of a volume, to or from what a pass has drawn");
  if (object(device_.images, source, "image").format != object(device_.images, target, "image").format)
    throw user_error("between formats, of what a pass has drawn");
  DrawnCopy copy;
  copy.depths = are_depths(from, to);
  copy.source = {source, from["mipLevel"].u32(), from["baseArrayLayer"].u32()};
  copy.target = {target, to["mipLevel"].u32(), to["baseArrayLayer"].u32()};
  copy.to = {region["dstOffset"]["x"].i32(), region["dstOffset"]["y"].i32(), extent["width"].u32(),
             extent["height"].u32()};
  copy.from = {static_cast<float>(region["srcOffset"]["x"].i32()),
               static_cast<float>(region["srcOffset"]["y"].i32()), static_cast<float>(copy.to.width),
               static_cast<float>(copy.to.height)};
  draw_layers(copy, to["layerCount"].u32(), "copy");
}

bool are_depths(const Value& from, const Value& to) {
  const std::uint32_t aspects = from["aspectMask"].u32() | to["aspectMask"].u32();
  if ((aspects & VK_IMAGE_ASPECT_STENCIL_BIT) != 0) throw user_error("of stencil values");
  if (aspects != VK_IMAGE_ASPECT_COLOR_BIT && aspects != VK_IMAGE_ASPECT_DEPTH_BIT)
    throw user_error("of VkImageAspectFlags {:#x}", aspects);
  return aspects == VK_IMAGE_ASPECT_DEPTH_BIT;
}

}  // namespace quadrille::capture
