#include "tests/traces/capture/small_capture.h"

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstring>
#include <string>

#include "scenes/material/glsl.h"

namespace quadrille::capture {
namespace {

using nlohmann::json;

constexpr const char* kVertexShader = R"(#version 450
layout(location = 0) in vec2 place;
void main() { gl_Position = vec4(place, 0.25, 1.0); }
)";
constexpr const char* kFragmentShader = R"(#version 450
layout(set = 0, binding = 3) uniform sampler2D picture;
layout(location = 0) out vec4 color;
void main() { color = texture(picture, vec2(0.5)); }
)";

/// The words with another name of the entry point, of four to seven letters, which takes as many words as
/// "main" does.
std::vector<std::uint32_t> renamed(std::vector<std::uint32_t> words, const std::string& entry) {
  if (entry == "main") return words;
  for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
    if ((words[at] & 0xffff) != 15) continue;
    std::array<char, 8> text{};
    std::memcpy(text.data(), entry.data(), entry.size());
    std::memcpy(&words[at + 3], text.data(), text.size());
  }
  return words;
}

void add_shader(CaptureWriter& file, std::uint64_t handle, const char* source, traces::ShaderStage stage,
                const char* entry) {
  const auto words = renamed(scenes::compile_glsl(source, stage, "shader"), entry);
  file.call("CreateShaderModule",
            {{"pCreateInfo", {{"codeSize", words.size() * 4}, {"pCode", words}}}, {"pShaderModule", handle}});
}

void add_objects(CaptureWriter& file, const SmallCapture& wish) {
  const json size{{"width", 16}, {"height", 16}};
  file.call("CreateSwapchainKHR",
            {{"pCreateInfo", {{"imageFormat", VK_FORMAT_B8G8R8A8_UNORM}, {"imageExtent", size}}},
             {"pSwapchain", kSwapchain}});
  file.call("GetSwapchainImagesKHR",
            {{"swapchain", kSwapchain}, {"pSwapchainImages", json::array({kShown})}});
  const json range{{"aspectMask", 1}, {"levelCount", 1}, {"layerCount", 1}};
  const auto view = [&](std::uint64_t image, VkFormat format, std::uint64_t handle) {
    file.call("CreateImageView", {{"pCreateInfo",
                                   {{"image", image},
                                    {"viewType", VK_IMAGE_VIEW_TYPE_2D},
                                    {"format", format},
                                    {"subresourceRange", range}}},
                                  {"pView", handle}});
  };
  view(kShown, VK_FORMAT_B8G8R8A8_UNORM, kShownView);
  file.call("AllocateMemory", {{"pAllocateInfo", {{"allocationSize", 64}}}, {"pMemory", kMemory}});
  file.call("CreateBuffer", {{"pCreateInfo", {{"size", 24}}}, {"pBuffer", kVertices}});
  file.call("BindBufferMemory", {{"buffer", kVertices}, {"memory", kMemory}, {"memoryOffset", 16}});
  file.call("MapMemory", {{"memory", kMemory}, {"offset", 8}});
  const std::array<float, 6> places{-1, -1, -1, 1, 1, 1};
  file.fill_memory(kMemory, 8, std::as_bytes(std::span(places)));
  file.call("CreateImage", {{"pCreateInfo",
                             {{"imageType", VK_IMAGE_TYPE_2D},
                              {"format", VK_FORMAT_R8G8B8A8_UNORM},
                              {"extent", {{"width", 1}, {"height", 1}, {"depth", 1}}},
                              {"mipLevels", 1},
                              {"arrayLayers", 1},
                              {"samples", 1},
                              {"usage", VK_IMAGE_USAGE_SAMPLED_BIT}}},
                            {"pImage", kTexture}});
  file.init_image(kTexture, std::as_bytes(std::span(kTexel)));
  view(kTexture, VK_FORMAT_R8G8B8A8_UNORM, kTextureView);
  file.call(
      "CreateSampler",
      {{"pCreateInfo", {{"maxLod", 1.0}, {"unnormalizedCoordinates", wish.sampler_counts_texels ? 1 : 0}}},
       {"pSampler", kSampler}});
}

void add_descriptors(CaptureWriter& file) {
  const json binding{{"binding", 3}, {"descriptorType", 1}, {"descriptorCount", 1}};
  file.call("CreateDescriptorSetLayout",
            {{"pCreateInfo", {{"pBindings", json::array({binding})}}}, {"pSetLayout", kSetLayout}});
  file.call("CreatePipelineLayout", {{"pPipelineLayout", kLayout}});
  file.call("AllocateDescriptorSets", {{"pAllocateInfo", {{"pSetLayouts", json::array({kSetLayout})}}},
                                       {"pDescriptorSets", json::array({kSet})}});
  const json image{{"sampler", kSampler}, {"imageView", kTextureView}};
  file.call("UpdateDescriptorSets",
            {{"pDescriptorWrites", json::array({{{"dstSet", kSet},
                                                 {"dstBinding", 3},
                                                 {"descriptorCount", 1},
                                                 {"descriptorType", 1},
                                                 {"pImageInfo", json::array({image})}}})}});
}

void add_pipeline(CaptureWriter& file, const SmallCapture& wish) {
  add_shader(file, kVertexModule, kVertexShader, traces::ShaderStage::kVertex, wish.entry);
  add_shader(file, kFragmentModule, kFragmentShader, traces::ShaderStage::kFragment, wish.entry);
  const auto stage = [&](int bit, std::uint64_t module) {
    return json{{"stage", bit}, {"module", module}, {"pName", wish.entry}};
  };
  const json viewport{{"width", 16.0}, {"height", 16.0}, {"maxDepth", 1.0}};
  const json scissor{{"extent", {{"width", 16}, {"height", 16}}}};
  const json attribute{{"format", VK_FORMAT_R32G32_SFLOAT}};
  json state{{"pStages", json::array({stage(1, kVertexModule), stage(16, kFragmentModule)})}};
  state["pVertexInputState"] = {{"pVertexBindingDescriptions", json::array({{{"stride", 8}}})},
                                {"pVertexAttributeDescriptions", json::array({attribute})}};
  state["pInputAssemblyState"] = {{"topology", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST}};
  state["pViewportState"] = {{"viewportCount", 1},
                             {"scissorCount", 1},
                             {"pViewports", json::array({viewport})},
                             {"pScissors", json::array({scissor})}};
  state["pRasterizationState"] = {{"lineWidth", 1.0}, {"cullMode", VK_CULL_MODE_BACK_BIT}};
  state["pMultisampleState"] = {{"rasterizationSamples", 1}};
  state["pColorBlendState"] = {{"pAttachments", json::array({{{"colorWriteMask", 15}}})}};
  state["pDynamicState"] = {
      {"pDynamicStates",
       json::array({VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_DEPTH_CLIP_NEGATIVE_ONE_TO_ONE_EXT})}};
  file.call("CreateGraphicsPipelines",
            {{"pCreateInfos", json::array({state})}, {"pPipelines", json::array({kPipeline})}});
}

void add_commands(CaptureWriter& file, const SmallCapture& wish) {
  const auto command = [&](const char* name, json parameters) {
    parameters["commandBuffer"] = kCommands;
    file.call(name, parameters);
  };
  command("BeginCommandBuffer", {});
  const json clear{{"color", json::array({0, 0, 0x3f800000, 0x3f800000})}};  // blue
  const json color{{"imageView", kShownView},
                   {"storeOp", VK_ATTACHMENT_STORE_OP_STORE},
                   {"loadOp", wish.loads ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR},
                   {"clearValue", clear}};
  const json area{{"extent", {{"width", 16}, {"height", 16}}}};
  for (const auto& [name, parameters] : wish.before) command(name, parameters);
  command("CmdBeginRendering",
          {{"pRenderingInfo",
            {{"renderArea", area}, {"layerCount", 1}, {"pColorAttachments", json::array({color})}}}});
  command("CmdBindPipeline", {{"pipeline", kPipeline}});
  command("CmdSetCullMode", {{"cullMode", VK_CULL_MODE_NONE}});
  command("CmdSetDepthClipNegativeOneToOneEXT", {{"negativeOneToOne", wish.negative_one_to_one ? 1 : 0}});
  command("CmdBindVertexBuffers", {{"pBuffers", json::array({kVertices})}, {"pOffsets", json::array({0})}});
  command("CmdBindDescriptorSets", {{"layout", kLayout}, {"pDescriptorSets", json::array({kSet})}});
  if (wish.extra_command != nullptr) {
    const std::uint64_t buffer = kCommands;
    file.raw_call(call_number(wish.extra_command), std::as_bytes(std::span(&buffer, 1)));
  }
  command("CmdDraw", {{"vertexCount", 3}, {"instanceCount", 1}});
  command("CmdEndRendering", {});
  command("EndCommandBuffer", {});
  file.call("QueueSubmit", {{"queue", kQueue},
                            {"pSubmits", json::array({{{"pCommandBuffers", json::array({kCommands})}}})}});
  file.call(
      "QueuePresentKHR",
      {{"queue", kQueue},
       {"pPresentInfo", {{"pSwapchains", json::array({kSwapchain})}, {"pImageIndices", json::array({0})}}}});
}

}  // namespace

std::vector<std::byte> small_capture(const SmallCapture& wish) {
  CaptureWriter file(wish.packing);
  add_objects(file, wish);
  add_descriptors(file);
  add_pipeline(file, wish);
  add_commands(file, wish);
  for (int frame = 1; frame < wish.frames; ++frame) {
    const std::array<float, 6> places{0, -1, 1, -1, 1, 0};
    if (frame == 1) file.fill_memory(kMemory, 8, std::as_bytes(std::span(places)));
    SmallCapture later = wish;
    later.loads = true;
    later.before.clear();
    add_commands(file, later);
  }
  return file.bytes();
}

}  // namespace quadrille::capture
