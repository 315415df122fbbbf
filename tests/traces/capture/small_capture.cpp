#include "tests/traces/capture/small_capture.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
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

constexpr const char* kArrayShader = R"(#version 450
layout(set = 0, binding = 3) uniform sampler2D picture[2];
layout(set = 0, binding = 0) uniform First { float blue; } first;
layout(set = 0, binding = 1) uniform Second { float blue; } second;
layout(set = 1, binding = 0) uniform Third { float blue; } third;
layout(location = 0) out vec4 color;
void main() {
  color = texture(picture[int(first.blue)], vec2(0.5));
  color.b = second.blue == 0.25 ? third.blue : 0.0;
}
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
  if (wish.texture_in_memory) {
    std::array<std::uint8_t, 512> bytes{};
    std::ranges::copy(kTexel, bytes.begin() + 128);
    file.call("AllocateMemory",
              {{"pAllocateInfo", {{"allocationSize", bytes.size()}}}, {"pMemory", kBlockMemory}});
    file.call("BindImageMemory", {{"image", kTexture}, {"memory", kBlockMemory}, {"memoryOffset", 128}});
    file.call("MapMemory", {{"memory", kBlockMemory}, {"offset", 0}});
    file.fill_memory(kBlockMemory, 0, std::as_bytes(std::span(bytes)));
  } else {
    file.init_image(kTexture, std::as_bytes(std::span(kTexel)));
  }
  view(kTexture, VK_FORMAT_R8G8B8A8_UNORM, kTextureView);
  file.call(
      "CreateSampler",
      {{"pCreateInfo", {{"maxLod", 1.0}, {"unnormalizedCoordinates", wish.sampler_counts_texels ? 1 : 0}}},
       {"pSampler", kSampler}});
}

/// Two sets: a buffer of three blocks at the bindings 0 and 1 of the one and 0 of the other, and an array of
/// textures whose samplers are the layout's.
void add_arrays(CaptureWriter& file) {
  constexpr std::uint32_t kStride = 256;
  std::vector<std::byte> blocks(std::size_t{3} * kStride);
  for (std::size_t k = 0; k < 3; ++k) std::memcpy(&blocks[k * kStride], &kBlueOfBlocks.at(k), 4);
  file.call("AllocateMemory",
            {{"pAllocateInfo", {{"allocationSize", blocks.size()}}}, {"pMemory", kBlockMemory}});
  file.call("CreateBuffer", {{"pCreateInfo", {{"size", blocks.size()}}}, {"pBuffer", kBlocks}});
  file.call("BindBufferMemory", {{"buffer", kBlocks}, {"memory", kBlockMemory}, {"memoryOffset", 0}});
  file.call("MapMemory", {{"memory", kBlockMemory}, {"offset", 0}});
  file.fill_memory(kBlockMemory, 0, blocks);
  const auto block = [](int binding) {
    return json{{"binding", binding}, {"descriptorType", 8}, {"descriptorCount", 1}};
  };
  const json textures{{"binding", 3},
                      {"descriptorType", 1},
                      {"descriptorCount", 2},
                      {"pImmutableSamplers", json::array({kSampler, kSampler})}};
  const auto layout = [&](const json& bindings, std::uint64_t handle) {
    file.call("CreateDescriptorSetLayout",
              {{"pCreateInfo", {{"pBindings", bindings}}}, {"pSetLayout", handle}});
  };
  layout(json::array({block(1), textures, block(0)}), kSetLayout);
  layout(json::array({block(0)}), kSecondSetLayout);
  file.call("CreatePipelineLayout", {{"pPipelineLayout", kLayout}});
  file.call("AllocateDescriptorSets",
            {{"pAllocateInfo", {{"pSetLayouts", json::array({kSetLayout, kSecondSetLayout})}}},
             {"pDescriptorSets", json::array({kSet, kSecondSet})}});
  const auto buffer = [](std::uint64_t set, int binding) {
    return json{{"dstSet", set},
                {"dstBinding", binding},
                {"descriptorCount", 1},
                {"descriptorType", 8},
                {"pBufferInfo", json::array({{{"buffer", kBlocks}, {"range", 16}}})}};
  };
  const json image{{"dstSet", kSet},
                   {"dstBinding", 3},
                   {"descriptorCount", 1},
                   {"descriptorType", 1},
                   {"pImageInfo", json::array({{{"imageView", kTextureView}}})}};
  file.call(
      "UpdateDescriptorSets",
      {{"pDescriptorWrites", json::array({buffer(kSet, 0), buffer(kSet, 1), buffer(kSecondSet, 0), image})}});
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
  add_shader(file, kFragmentModule, wish.arrays ? kArrayShader : kFragmentShader,
             traces::ShaderStage::kFragment, wish.entry);
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

void add_commands(CaptureWriter& file, const SmallCapture& wish, const json& part = nullptr) {
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
  json area{{"extent", {{"width", 16}, {"height", 16}}}};
  if (!part.is_null()) area = part;
  for (const auto& [name, parameters] : wish.before) command(name, parameters);
  command("CmdBeginRendering",
          {{"pRenderingInfo",
            {{"renderArea", area}, {"layerCount", 1}, {"pColorAttachments", json::array({color})}}}});
  command("CmdBindPipeline", {{"pipeline", kPipeline}});
  command("CmdSetCullMode", {{"cullMode", VK_CULL_MODE_NONE}});
  command("CmdSetDepthClipNegativeOneToOneEXT", {{"negativeOneToOne", wish.negative_one_to_one ? 1 : 0}});
  command("CmdBindVertexBuffers", {{"pBuffers", json::array({kVertices})}, {"pOffsets", json::array({0})}});
  json bound{{"layout", kLayout}, {"pDescriptorSets", json::array({kSet})}};
  if (wish.arrays) {
    bound["pDescriptorSets"] = json::array({kSet, kSecondSet});
    bound["pDynamicOffsets"] = json::array({0, 256, 512});
  }
  command("CmdBindDescriptorSets", bound);
  if (wish.extra_command != nullptr) {
    const std::uint64_t buffer = kCommands;
    file.raw_call(call_number(wish.extra_command), std::as_bytes(std::span(&buffer, 1)));
  }
  command("CmdDraw", {{"vertexCount", 3}, {"instanceCount", 1}});
  for (const auto& [name, parameters] : wish.behind) command(name, parameters);
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

void add_shader(CaptureWriter& file, std::uint64_t handle, const char* source, traces::ShaderStage stage,
                const char* entry) {
  const auto words = renamed(scenes::compile_glsl(source, stage, "shader"), entry);
  file.call("CreateShaderModule",
            {{"pCreateInfo", {{"codeSize", words.size() * 4}, {"pCode", words}}}, {"pShaderModule", handle}});
}

std::vector<std::byte> small_capture(const SmallCapture& wish) {
  CaptureWriter file(wish.packing);
  file.device_properties(wish.lavapipe);
  add_objects(file, wish);
  if (wish.arrays) add_arrays(file);
  else add_descriptors(file);
  add_pipeline(file, wish);
  if (wish.objects) wish.objects(file);
  add_commands(file, wish);
  for (int frame = 1; frame < wish.frames; ++frame) {
    const std::array<float, 6> places{0, 0, 1, 0, 1, 1};
    if (frame == 1) file.fill_memory(kMemory, 8, std::as_bytes(std::span(places)));
    SmallCapture later = wish;
    later.loads = wish.later_area.is_null();
    later.before.clear();
    add_commands(file, later, wish.later_area);
  }
  return file.bytes();
}

}  // namespace quadrille::capture
