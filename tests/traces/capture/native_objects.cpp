#include "tests/traces/capture/native_objects.h"

#include <fmt/format.h>

#include <stdexcept>

#include "models/base/error.h"
#include "models/precision.h"
#include "pipeline/frame_contents.h"

namespace quadrille::capture {

using nlohmann::json;

void add_image(CaptureWriter& file, const NativeImage& wish) {
  file.call("CreateImage",
            {{"pCreateInfo",
              {{"imageType", wish.type},
               {"format", wish.format},
               {"extent", {{"width", wish.width}, {"height", wish.height}, {"depth", wish.depth}}},
               {"mipLevels", 1},
               {"arrayLayers", 1},
               {"samples", wish.samples},
               {"usage", VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}}},
             {"pImage", wish.image}});
  if (wish.view == 0) return;
  file.call("CreateImageView",
            {{"pCreateInfo",
              {{"image", wish.image},
               {"viewType", wish.type},  // the numbers are the same
               {"format", wish.format},
               {"subresourceRange", {{"aspectMask", 1}, {"levelCount", 1}, {"layerCount", 1}}}}},
             {"pView", wish.view}});
}

void add_pipeline(CaptureWriter& file, const NativePipeline& wish) {
  const auto stage = [&](int bit, std::uint64_t module) {
    return json{{"stage", bit}, {"module", module}, {"pName", "main"}};
  };
  add_shader(file, kOwnVertex, wish.vertex, traces::ShaderStage::kVertex);
  json state{{"pStages", json::array({stage(1, kOwnVertex)})}};
  if (wish.fragment != nullptr) {
    add_shader(file, kOwnFragment, wish.fragment, traces::ShaderStage::kFragment);
    state["pStages"].push_back(stage(16, kOwnFragment));
  }
  state["pVertexInputState"] = {
      {"pVertexBindingDescriptions", json::array({{{"stride", 8}}})},
      {"pVertexAttributeDescriptions", json::array({{{"format", VK_FORMAT_R32G32_SFLOAT}}})}};
  state["pInputAssemblyState"] = {{"topology", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST}};
  state["pViewportState"] = {
      {"viewportCount", 1},
      {"scissorCount", 1},
      {"pViewports", json::array({{{"width", 16.0}, {"height", 16.0}, {"maxDepth", 1.0}}})},
      {"pScissors", json::array({{{"extent", {{"width", 16}, {"height", 16}}}}})}};
  state["pRasterizationState"] = {{"lineWidth", 1.0}};
  state["pMultisampleState"] = {{"rasterizationSamples", wish.samples}};
  if (wish.depth)
    state["pDepthStencilState"] = {
        {"depthTestEnable", 1}, {"depthWriteEnable", 1}, {"depthCompareOp", VK_COMPARE_OP_LESS}};
  json blends = json::array();
  for (int i = 0; i < wish.colors; ++i) blends.push_back({{"colorWriteMask", 15}});
  state["pColorBlendState"] = {{"pAttachments", blends}};
  file.call("CreateGraphicsPipelines",
            {{"pCreateInfos", json::array({state})}, {"pPipelines", json::array({kOwnPipeline})}});
}

void add_arguments(CaptureWriter& file, std::uint64_t bytes) {
  file.call("AllocateMemory", {{"pAllocateInfo", {{"allocationSize", bytes}}}, {"pMemory", kArgumentMemory}});
  file.call("CreateBuffer", {{"pCreateInfo", {{"size", bytes}}}, {"pBuffer", kArguments}});
  file.call("BindBufferMemory", {{"buffer", kArguments}, {"memory", kArgumentMemory}, {"memoryOffset", 0}});
}

json attachment(std::uint64_t view, const std::vector<std::uint32_t>& clear) {
  return {{"imageView", view},
          {"storeOp", VK_ATTACHMENT_STORE_OP_STORE},
          {"loadOp", VK_ATTACHMENT_LOAD_OP_CLEAR},
          {"clearValue", {{"color", clear}}}};
}

Commands pass(const json& colors, const json& depth, const Commands& draws) {
  json info{{"renderArea", {{"extent", {{"width", 16}, {"height", 16}}}}}, {"layerCount", 1}};
  info["pColorAttachments"] = colors;
  if (!depth.is_null()) info["pDepthAttachment"] = info["pStencilAttachment"] = depth;
  return together({{{"CmdBeginRendering", {{"pRenderingInfo", info}}}}, draws, {{"CmdEndRendering", {}}}});
}

Commands triangle() {
  return {{"CmdBindPipeline", {{"pipeline", kOwnPipeline}}},
          {"CmdBindVertexBuffers", {{"pBuffers", json::array({kVertices})}, {"pOffsets", json::array({0})}}},
          {"CmdDraw", {{"vertexCount", 3}, {"instanceCount", 1}}}};
}

json subresource(int aspects, int layers) { return {{"aspectMask", aspects}, {"layerCount", layers}}; }
json extent(int width, int height, int depth) {
  return {{"width", width}, {"height", height}, {"depth", depth}};
}

Commands together(std::initializer_list<Commands> parts) {
  Commands all;
  for (const Commands& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Import import_small(const SmallCapture& wish) { return import_bytes("small.gfxr", small_capture(wish)); }

std::string refusal(const SmallCapture& wish) {
  try {
    (void)import_small(wish);
  } catch (const UserError& error) { return error.what(); }
  return "";
}

std::vector<std::byte> left_in(const Import& import, std::uint64_t image) {
  const traces::FrameContents left = pipeline::contents_after(import.stream, models::Precision{});
  for (const traces::FrameContents::Part& part : left.parts)
    if (import.stream.images[part.part.image].name == fmt::format("image {}", image)) return part.texels;
  throw std::runtime_error("the frame leaves nothing in it");
}

}  // namespace quadrille::capture
