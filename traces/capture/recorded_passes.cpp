/// Passes: attachments, what they begin with, and clears.
#include <fmt/format.h>
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <bit>

#include "models/base/error.h"
#include "traces/capture/frame_recorder.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

bool covers(const Value& area, std::uint32_t width, std::uint32_t height) {
  return area["offset"]["x"].i32() == 0 && area["offset"]["y"].i32() == 0 &&
         area["extent"]["width"].u32() >= width && area["extent"]["height"].u32() >= height;
}

}  // namespace

std::array<std::uint32_t, 4> clear_bits(const Value& clear) {
  std::array<std::uint32_t, 4> bits{};
  for (std::size_t c = 0; c < 4 && c < clear["color"].size(); ++c) bits[c] = clear["color"].u32(c);
  return bits;
}

void set_clear(traces::ColorAttachmentUse& use, const std::array<std::uint32_t, 4>& bits, bool integers) {
  use.load = traces::LoadOp::kClear;
  if (integers) use.clear_integers = bits;
  else
    for (std::size_t c = 0; c < 4; ++c) use.clear[c] = std::bit_cast<float>(bits[c]);
}

bool FrameRecorder::change_pass(const Call& call) {
  const Value& p = call.parameters;
  if (call.name == "CmdBeginRendering") begin_rendering(p["pRenderingInfo"]);
  else if (call.name == "CmdBeginRenderPass" || call.name == "CmdBeginRenderPass2")
    begin_render_pass(p["pRenderPassBegin"]);
  else if (call.name == "CmdEndRendering" || call.name == "CmdEndRenderPass" ||
           call.name == "CmdEndRenderPass2")
    end_pass();
  else if (call.name == "CmdClearAttachments") clear_attachments(p);
  else if (call.name == "CmdClearColorImage") clear_image(p);
  else return false;
  return true;
}

void FrameRecorder::begin_rendering(const Value& info) {
  const auto target = [](const Value& from) {
    PassTarget to;
    to.view = from["imageView"].u64();
    if (from["resolveMode"].u32() != VK_RESOLVE_MODE_NONE) to.resolve = from["resolveImageView"].u64();
    to.load = load_of(from["loadOp"].u32());
    to.store = store_of(from["storeOp"].u32());
    to.clear = clear_bits(from["clearValue"]);
    return to;
  };
  std::vector<PassTarget> colors;
  for (std::size_t i = 0; i < info["pColorAttachments"].size(); ++i)
    colors.push_back(target(info["pColorAttachments"].at(i)));
  PassTarget depth, stencil;
  if (!info["pDepthAttachment"].null()) depth = target(info["pDepthAttachment"]);
  if (!info["pStencilAttachment"].null()) stencil = target(info["pStencilAttachment"]);
  if (depth.view == 0) depth = stencil;
  if (stencil.view != 0) {
    depth.clear[1] = stencil.clear[1];
    if (stencil.store == traces::StoreOp::kStore) depth.store = traces::StoreOp::kStore;
  }
  begin_pass_in(colors, depth, info["renderArea"]);
}

void FrameRecorder::begin_render_pass(const Value& info) {
  const RenderPassObject& pass = object(device_.render_passes, info["renderPass"].u64(), "render pass");
  const std::vector<Handle>& views = object(device_.framebuffers, info["framebuffer"].u64(), "framebuffer");
  if (pass.subpasses != 1) throw user_error("a render pass of {} subpasses is not supported", pass.subpasses);
  const auto target = [&](std::uint32_t number) {
    PassTarget to;
    if (number == RenderPassObject::kUnused) return to;
    if (number >= pass.attachments.size() || number >= views.size())
      throw user_error("attachment {} of a render pass that has {}", number, pass.attachments.size());
    const PassAttachment& from = pass.attachments[number];
    to.view = views[number];
    to.load = load_of(from.load);
    to.store = store_of(from.store);
    if (number < info["pClearValues"].size()) to.clear = clear_bits(info["pClearValues"].at(number));
    return to;
  };
  std::vector<PassTarget> colors;
  for (std::size_t i = 0; i < pass.colors.size(); ++i) {
    colors.push_back(target(pass.colors[i]));
    if (i < pass.resolves.size()) colors.back().resolve = target(pass.resolves[i]).view;
  }
  begin_pass_in(colors, target(pass.depth), info["renderArea"]);
}

void FrameRecorder::check_view_format(const ViewObject& view) {
  const ImageObject& image = object(device_.images, view.image, "image");
  const bool same = view.format == image.format || image_format(view.format) == image_format(image.format);
  if (same || (view.aspect & VK_IMAGE_ASPECT_COLOR_BIT) == 0) return;
  ++unsupported_[fmt::format("a view of {} of an attachment of {}", format_name(view.format),
                             format_name(image.format))];
}

void FrameRecorder::attach(traces::AttachmentUse& use, const PassTarget& target) {
  const ViewObject& view = object(device_.views, target.view, "image view");
  use.image = tables_.attachment(view.image);
  check_view_format(view);
  use.level = view.level;
  use.layer = view.layer;
  use.load = target.load;
  use.store = target.store;
  // What earlier frames left there is not known but where the capture brings it.
  if (use.load == traces::LoadOp::kLoad && !tables_.holds(view.image, view.level, view.layer)) {
    use.load = traces::LoadOp::kDontCare;
    pass_lacks_.insert(use.image);
  }
  if (use.store == traces::StoreOp::kStore) pass_stores_.push_back({view.image, view.level, view.layer});
  const traces::Image& image = tables_.stream.images[use.image];
  pass_width_ = traces::level_width(image, use.level);
  pass_height_ = traces::level_height(image, use.level);
}

/// Outside of a part that it renders to, the pass leaves its attachments as they are: it loads them, and
/// clears the part by draws. [VK1.3 #renderpass-load-ops]
void FrameRecorder::begin_pass_in(std::vector<PassTarget> colors, PassTarget depth, const Value& area) {
  const auto found = std::ranges::find_if(colors, [](const PassTarget& color) { return color.view != 0; });
  const Handle first = found != colors.end() ? found->view : depth.view;
  if (first == 0) return begin_pass(colors, depth);
  const ViewObject& view = object(device_.views, first, "image view");
  const ImageObject& image = object(device_.images, view.image, "image");
  if (covers(area, std::max(1u, image.width >> view.level), std::max(1u, image.height >> view.level)))
    return begin_pass(colors, depth);
  const auto whole = [](PassTarget& target) {
    if (target.resolve != 0)
      throw user_error("a pass that resolves a part of its attachments is not supported");
    const bool clears = target.load == traces::LoadOp::kClear;
    target.load = traces::LoadOp::kLoad;
    target.store = traces::StoreOp::kStore;
    return clears;
  };
  std::vector<std::uint32_t> cleared;
  for (std::uint32_t i = 0; i < colors.size(); ++i)
    if (colors[i].view != 0 && whole(colors[i])) cleared.push_back(i);
  const bool clears_depth = whole(depth);
  begin_pass(colors, depth);
  const Area part = area_of(area);
  for (const std::uint32_t i : cleared) clear_color_area(color_places_[i], colors[i].clear, part);
  if (clears_depth)
    clear_depth_area(VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT, depth.clear, part);
}

FrameRecorder::Area FrameRecorder::area_of(const Value& rect) {
  return {rect["offset"]["x"].i32(), rect["offset"]["y"].i32(), rect["extent"]["width"].u32(),
          rect["extent"]["height"].u32()};
}

void FrameRecorder::begin_pass(const std::vector<PassTarget>& colors, const PassTarget& depth) {
  if (in_pass_) end_pass();
  pass_ = {};
  pass_stores_.clear();
  pass_lacks_.clear();
  last_shown_ = 0;
  color_places_.clear();
  if (colors.size() > traces::kMaxColorAttachments)
    throw user_error("of {} colour attachments", colors.size());
  for (const PassTarget& color : colors) {
    const auto place = static_cast<traces::Index>(pass_.colors.size());
    color_places_.push_back(color.view != 0 ? place : traces::kNone);
    if (color.view == 0) continue;
    traces::ColorAttachmentUse& use = pass_.colors.emplace_back();
    attach(use, color);
    const traces::Format format = tables_.stream.images[use.image].format;
    if (use.load == traces::LoadOp::kClear) set_clear(use, color.clear, traces::is_integer_format(format));
    Handle shown = object(device_.views, color.view, "image view").image;
    if (color.resolve != 0) {
      const ViewObject& view = object(device_.views, color.resolve, "image view");
      use.resolve = tables_.attachment(view.image);
      use.resolve_level = view.level;
      use.resolve_layer = view.layer;
      pass_stores_.push_back({view.image, view.level, view.layer});
      shown = view.image;
    }
    if (pass_.colors.size() == 1) last_shown_ = shown;
  }
  if (depth.view != 0) {
    attach(pass_.depth, depth);
    pass_.depth.clear = std::bit_cast<float>(depth.clear[0]);
    pass_.depth.clear_stencil = static_cast<std::uint8_t>(depth.clear[1]);
    if (pass_.depth.load == traces::LoadOp::kDontCare) pass_.depth.clear = 1;
    if (pass_lacks_.contains(pass_.depth.image)) {
      pass_.depth.load = traces::LoadOp::kClear;
      pass_.depth.clear_stencil = 0;
    }
  }
  if (pass_.first_image() == traces::kNone) throw user_error("a pass without attachments is not supported");
  in_pass_ = true;
  drew_ = false;
  begin_at_ = tables_.stream.commands.size();
  tables_.stream.commands.emplace_back(pass_);
  forget_windows();
}

void FrameRecorder::end_pass() {
  if (!in_pass_) return;
  in_pass_ = false;
  tables_.stream.commands.emplace_back(traces::EndPass{});
  note_begin();
  for (const StoredPart& part : pass_stores_) tables_.note_stored(part.image, part.level, part.layer);
}

/// What the pass begins with, unless a clear at its begin filled it.
void FrameRecorder::note_begin() {
  const auto& begin = std::get<traces::BeginPass>(tables_.stream.commands[begin_at_]);
  const auto note = [&](const traces::AttachmentUse& use) {
    if (use.load == traces::LoadOp::kLoad) tables_.note_needed(use.part());
    if (pass_lacks_.contains(use.image))
      tables_.note_lacking(use.image,
                           " begins with what an earlier frame left, which the capture does not hold: zeros, "
                           "and depths of 1");
  };
  for (const traces::ColorAttachmentUse& color : begin.colors) note(color);
  if (begin.depth.image != traces::kNone) note(begin.depth);
}

/// A clear of everything before the first draw is how the pass begins.
void FrameRecorder::clear_attachments(const Value& call) {
  if (!in_pass_) throw user_error("outside a pass");
  const Value &rects = call["pRects"], &attachments = call["pAttachments"];
  const bool at_begin = !drew_ && rects.size() == 1 && covers(rects.at(0)["rect"], pass_width_, pass_height_);
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    if (at_begin) {
      clear_at_begin(attachments.at(i));
      continue;
    }
    for (std::size_t r = 0; r < rects.size(); ++r)
      clear_area(attachments.at(i), area_of(rects.at(r)["rect"]));
  }
}

/// Of the attachment that a clear names; `kNone` where there is nothing to clear.
traces::Index FrameRecorder::color_place(const Value& attachment) const {
  const std::uint32_t number = attachment["colorAttachment"].u32();
  return number < color_places_.size() ? color_places_[number] : traces::kNone;
}

void FrameRecorder::clear_at_begin(const Value& attachment) {
  auto& begin = std::get<traces::BeginPass>(tables_.stream.commands[begin_at_]);
  const std::uint32_t aspect = attachment["aspectMask"].u32();
  const std::uint32_t number = color_place(attachment);
  const std::array<std::uint32_t, 4> bits = clear_bits(attachment["clearValue"]);
  if ((aspect & VK_IMAGE_ASPECT_COLOR_BIT) != 0 && number != traces::kNone) {
    const traces::Format format = tables_.stream.images[begin.colors[number].image].format;
    set_clear(begin.colors[number], bits, traces::is_integer_format(format));
    pass_lacks_.erase(begin.colors[number].image);
  }
  if ((aspect & VK_IMAGE_ASPECT_DEPTH_BIT) != 0) {
    pass_lacks_.erase(begin.depth.image);
    begin.depth.load = traces::LoadOp::kClear;
    begin.depth.clear = std::bit_cast<float>(bits[0]);
  }
  if ((aspect & VK_IMAGE_ASPECT_STENCIL_BIT) != 0)
    begin.depth.clear_stencil = static_cast<std::uint8_t>(bits[1]);
}

}  // namespace quadrille::capture
