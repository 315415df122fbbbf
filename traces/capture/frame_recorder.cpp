/// Submissions, command buffers, and what is bound in them.
#include "traces/capture/frame_recorder.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>

#include "models/base/error.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {

void FrameRecorder::submit(const Call& call) {
  const Value& submits = call.parameters["pSubmits"];
  for (std::size_t i = 0; i < submits.size(); ++i) {
    const Value& one = submits.at(i);
    if (call.name == "QueueSubmit") {
      const Value& buffers = one["pCommandBuffers"];
      for (std::size_t b = 0; b < buffers.size(); ++b) run(buffers.u64(b));
    } else {
      const Value& infos = one["pCommandBufferInfos"];
      for (std::size_t b = 0; b < infos.size(); ++b) run(infos.at(b)["commandBuffer"].u64());
    }
  }
}

void FrameRecorder::present(const Call& call) {
  const Value& info = call.parameters["pPresentInfo"];
  const SwapchainObject& chain = object(device_.swapchains, info["pSwapchains"].u64(), "swapchain");
  const std::uint32_t image = info["pImageIndices"].u32();
  if (image >= chain.images.size())
    throw user_error("image {} of {} is presented", image, chain.images.size());
  presented_ = chain.images[image];
}

void FrameRecorder::run(Handle command_buffer) {
  const CommandBufferObject& commands = object(device_.command_buffers, command_buffer, "command buffer");
  for (const auto& [name, count] : commands.unsupported) unsupported_[name] += count;
  BoundState bound;
  for (const KeptCall& call : commands.calls) {
    try {
      run(*call, bound);
    } catch (const UserError& error) { ++unsupported_[fmt::format("vk{}: {}", call->name, error.what())]; }
  }
}

void FrameRecorder::run(const Call& call, BoundState& bound) {
  if (set_dynamic_state(bound.dynamic, call) || bind(call, bound) || change_pass(call) || copy(call) ||
      draw(call, bound) || label(call))
    return;
  if (call.name == "CmdExecuteCommands") {
    const Value& buffers = call.parameters["pCommandBuffers"];
    for (std::size_t i = 0; i < buffers.size(); ++i) {
      if (++depth_ > 2) throw user_error("secondary command buffers that execute others");
      run(buffers.u64(i));
      --depth_;
    }
    return;
  }
  ++unsupported_["vk" + std::string(call.name)];
}

bool FrameRecorder::bind(const Call& call, BoundState& bound) {
  const Value& p = call.parameters;
  if (call.name == "CmdBindPipeline") {
    bound.pipeline = &object(device_.pipelines, p["pipeline"].u64(), "graphics pipeline");
    bound.fixed = fixed_state(*bound.pipeline->state);
  } else if (call.name == "CmdBindDescriptorSets") {
    bind_sets(p, bound);
  } else if (call.name == "CmdPushDescriptorSetKHR") {
    BoundState::Set& set = bound.sets[p["set"].u32()];
    set.set = 0;
    for (std::size_t i = 0; i < p["pDescriptorWrites"].size(); ++i)
      device_.update(set.pushed, p["pDescriptorWrites"].at(i));
  } else if (call.name == "CmdPushDescriptorSetWithTemplateKHR") {
    const TemplateObject& made =
        object(device_.templates, p["descriptorUpdateTemplate"].u64(), "update template");
    BoundState::Set& set = bound.sets[p["set"].u32()];
    set.set = 0;
    device_.update(set.pushed, made, p["pData"]);
  } else if (call.name == "CmdPushConstants") {
    push_constants(p, bound);
  } else if (call.name == "CmdBindVertexBuffers" || call.name == "CmdBindVertexBuffers2") {
    bind_vertex_buffers(p, bound);
  } else if (call.name == "CmdBindIndexBuffer") {
    bound.index_buffer = p["buffer"].u64();
    bound.index_offset = p["offset"].u64();
    bound.index_type = index_type_of(p["indexType"].u32());
  } else {
    return false;
  }
  return true;
}

void FrameRecorder::bind_sets(const Value& call, BoundState& bound) {
  if (call["pipelineBindPoint"].u32() != VK_PIPELINE_BIND_POINT_GRAPHICS) return;
  const Value& sets = call["pDescriptorSets"];
  const Value& offsets = call["pDynamicOffsets"];
  std::size_t taken = 0;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    BoundState::Set& set = bound.sets[call["firstSet"].u32() + static_cast<std::uint32_t>(i)];
    set = {};
    set.set = sets.u64(i);
    if (offsets.size() == 0) continue;
    const std::uint64_t last = taken + dynamic_offsets(device_.layout_of(set.set));
    for (; taken < std::min<std::uint64_t>(last, offsets.size()); ++taken)
      set.offsets.push_back(offsets.u32(taken));
  }
}

void FrameRecorder::bind_vertex_buffers(const Value& call, BoundState& bound) {
  const Value& buffers = call["pBuffers"];
  const bool strides = call.has("pStrides") && !call["pStrides"].null();
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    BoundState::VertexBuffer& to =
        bound.vertex_buffers[call["firstBinding"].u32() + static_cast<std::uint32_t>(i)];
    to = {buffers.u64(i), call["pOffsets"].u64(i), std::nullopt};
    if (strides) to.stride = static_cast<std::uint32_t>(call["pStrides"].u64(i));
  }
}

void FrameRecorder::push_constants(const Value& call, BoundState& bound) {
  const std::span<const std::byte> values = call["pValues"].bytes();
  const std::uint64_t offset = call["offset"].u32(), end = offset + values.size();
  if (end > traces::kMaxPushConstantBytes)
    throw user_error("push constants end at byte {}; there are {}", end, traces::kMaxPushConstantBytes);
  if (bound.constants.size() < end) bound.constants.resize(end);
  std::ranges::copy(values, bound.constants.begin() + static_cast<std::ptrdiff_t>(offset));
}

bool FrameRecorder::label(const Call& call) {
  if (call.name == "CmdBeginDebugUtilsLabelEXT")
    labels_.push_back(call.parameters["pLabelInfo"]["pLabelName"].text());
  else if (call.name == "CmdEndDebugUtilsLabelEXT") {
    if (!labels_.empty()) labels_.pop_back();
  } else return call.name == "CmdInsertDebugUtilsLabelEXT";
  return true;
}

void FrameRecorder::keep(const traces::FrameContents& contents) {
  for (const auto& [part, texels] : contents.parts)
    device_.keep_drawn(tables_.image_of(part.image), part.level, part.layer, texels);
  for (const auto& [buffer, data] : contents.buffers)
    device_.write_buffer(tables_.buffer_of(buffer), 0, data);
}

traces::CommandStream FrameRecorder::take() {
  if (in_pass_) end_pass();
  // What is shown was drawn earlier: a last pass, without a draw, makes it the picture.
  if (presented_ != 0 && last_shown_ != presented_ && tables_.holds(presented_, 0, 0)) {
    begin_blit({presented_, 0, 0}, false);
    end_pass();
  }
  if (presented_ != 0 && last_shown_ != presented_)
    throw user_error("the last pass of the frame draws to image {}, and image {} is shown", last_shown_,
                     presented_);
  tables_.forget_unneeded();
  return std::move(tables_.stream);
}

}  // namespace quadrille::capture
