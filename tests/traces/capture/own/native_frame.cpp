/// The program whose frame is captured in native_frame.gfxr: Vulkan 1.3 with dynamic rendering, 96x72 pixels.
///
/// It has what Vulkan's own programs have and OpenGL's lack: a prepass of depths whose pipeline has no
/// fragment shader, a copy of these depths that a later shader samples, draws whose arguments lie in a
/// buffer, a pass of four samples a pixel that leaves out its first colour attachment, a resolve behind it,
/// and a blit to the swapchain's image. The build does not need it; shaders are compiled when it starts.
/// To capture anew, with libvulkan-dev, libxcb1-dev and glslang-tools installed:
///   g++ -std=c++20 -O1 -I. -o /tmp/native_frame tests/traces/capture/own/native_frame.cpp -lvulkan -lxcb
///   scripts/capture --frame 3 --out tests/traces/capture/own/native_frame /tmp/native_frame
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "tests/traces/capture/own/native_device.h"

namespace {

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Turn { mat4 matrix; } turn;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 tint;
layout(location = 0) out vec3 color;
void main() {
  vec3 shift = vec3(gl_InstanceIndex == 0 ? -0.9 : 1.0, 0.0, gl_InstanceIndex == 0 ? 0.0 : 0.8);
  gl_Position = turn.matrix * vec4(position + shift, 1.0);
  color = tint;
})";
// What output 0 gets is seen nowhere.
constexpr const char* kFragment = R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D depths;
layout(location = 0) in vec3 color;
layout(location = 0) out vec4 left_out;
layout(location = 1) out vec4 shown;
void main() {
  float depth = texture(depths, gl_FragCoord.xy / vec2(48.0, 36.0)).r;
  left_out = vec4(1.0, 0.0, 1.0, 1.0);
  shown = vec4(mix(color, vec3(0.1, 0.2, 0.4), clamp((depth - 0.8) * 5.0, 0.0, 1.0)), 1.0);
})";

struct Corner {
  std::array<float, 3> position, tint;
};

/// Four corners of each of six faces.
std::vector<Corner> corners() {
  std::vector<Corner> all;
  for (std::size_t face = 0; face < 6; ++face)
    for (int corner = 0; corner < 4; ++corner) {
      Corner c{};
      const float side = face % 2 == 0 ? 0.6f : -0.6f;
      c.position.at(face / 2) = side;
      c.position.at((face / 2 + 1) % 3) = (corner % 2 == 0 ? -1.0f : 1.0f) * side;
      c.position.at((face / 2 + 2) % 3) = corner / 2 == 0 ? -0.6f : 0.6f;
      c.tint = {0.9f - 0.1f * static_cast<float>(face), face % 2 == 0 ? 0.8f : 0.3f,
                0.2f + 0.2f * static_cast<float>(corner)};
      all.push_back(c);
    }
  return all;
}

/// Two draws of three faces each, of two instances.
struct Arguments {
  std::vector<std::uint16_t> indices;
  std::array<VkDrawIndexedIndirectCommand, 2> draws{{{18, 2, 0, 0, 0}, {18, 2, 0, 12, 0}}};
  Arguments() {
    for (int face = 0; face < 3; ++face)
      for (const int corner : {0, 1, 2, 2, 1, 3})
        indices.push_back(static_cast<std::uint16_t>(4 * face + corner));
  }
};

/// Column by column: turned, moved away, and seen with 90 degrees.
std::array<float, 16> matrix(float angle) {
  const float c = std::cos(angle), s = std::sin(angle), near = 0.5f, far = 8.0f, away = 2.6f;
  const float a = far / (far - near), b = -near * a, tilt = 0.5f;
  // Rows of the turn: (c, 0, s), (tilt s, 1, -tilt c), (-s, 0, c); then z grows by `away`.
  return {c * 0.75f, tilt * s, -s * a, -s,           0,   1, 0, 0, s * 0.75f, -tilt * c, c * a,
          c,         0,        0,      away * a + b, away};
}

class Program : NativeDevice {
 public:
  Program() {
    make_images();
    make_buffer();
    make_pipelines();
    make_commands();
  }
  void draw(int frame) {
    std::uint32_t number = 0;
    check(vkAcquireNextImageKHR(device_, swapchain_, UINT64_MAX, VK_NULL_HANDLE, fence_, &number), "acquire");
    check(vkWaitForFences(device_, 1, &fence_, VK_TRUE, UINT64_MAX), "wait");
    check(vkResetFences(device_, 1, &fence_), "reset");
    record(shown_.at(number), matrix(0.3f * static_cast<float>(frame)));
    const VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, commands_,
                                             0};
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    check(vkQueueSubmit2(queue_, 1, &submit, VK_NULL_HANDLE), "submit");
    check(vkQueueWaitIdle(queue_), "idle");
    VkPresentInfoKHR present{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    present.swapchainCount = 1;
    present.pSwapchains = &swapchain_;
    present.pImageIndices = &number;
    check(vkQueuePresentKHR(queue_, &present), "present");
  }

 private:
  void make_images() {
    prepass_ = image(kDepth, VK_SAMPLE_COUNT_1_BIT,
                     VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, true);
    copied_ = image(kDepth, VK_SAMPLE_COUNT_1_BIT,
                    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, true);
    samples_ = image(kColor, VK_SAMPLE_COUNT_4_BIT,
                     VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, true);
    sample_depths_ = image(kDepth, VK_SAMPLE_COUNT_4_BIT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, true);
    resolved_ = image(kColor, VK_SAMPLE_COUNT_1_BIT,
                      VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, false);
  }
  /// Indices, arguments and corners in one. Indices are at its begin: lavapipe 22.3 draws indirectly with
  /// those alone.
  void make_buffer() {
    const std::vector<Corner> vertices = corners();
    const Arguments arguments;
    arguments_at_ = arguments.indices.size() * sizeof(std::uint16_t);
    corners_at_ = arguments_at_ + sizeof arguments.draws;
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = corners_at_ + vertices.size() * sizeof(Corner);
    info.usage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    check(vkCreateBuffer(device_, &info, nullptr, &buffer_), "buffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, buffer_, &needs);
    VkDeviceMemory held =
        memory(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    check(vkBindBufferMemory(device_, buffer_, held, 0), "bind buffer");
    void* mapped = nullptr;
    check(vkMapMemory(device_, held, 0, VK_WHOLE_SIZE, 0, &mapped), "map");
    auto* bytes = static_cast<std::byte*>(mapped);
    std::memcpy(bytes, arguments.indices.data(), arguments_at_);
    std::memcpy(bytes + arguments_at_, arguments.draws.data(), sizeof arguments.draws);
    std::memcpy(bytes + corners_at_, vertices.data(), vertices.size() * sizeof(Corner));
    vkUnmapMemory(device_, held);
  }
  void make_pipelines() {
    VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    VkSampler nearest = VK_NULL_HANDLE;
    check(vkCreateSampler(device_, &sampler, nullptr, &nearest), "sampler");
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                               VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
    VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr, 0, 1,
                                        &binding};
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device_, &set, nullptr, &set_layout), "set layout");
    const VkPushConstantRange push{VK_SHADER_STAGE_VERTEX_BIT, 0, 64};
    VkPipelineLayoutCreateInfo layout{
        VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 1, &set_layout, 1, &push};
    check(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_), "layout");
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, 1, 1, &size};
    VkDescriptorPool made_pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device_, &pool, nullptr, &made_pool), "pool");
    VkDescriptorSetAllocateInfo wish{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, made_pool, 1,
                                     &set_layout};
    check(vkAllocateDescriptorSets(device_, &wish, &set_), "set");
    const VkDescriptorImageInfo texture{nearest, copied_.view, VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set_;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &texture;
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
    const VkShaderModule vertex = module(kVertex, "vert"), fragment = module(kFragment, "frag");
    depth_pipeline_ = pipeline(vertex, VK_NULL_HANDLE);
    pipeline_ = pipeline(vertex, fragment);
  }
  /// Without a fragment shader, of one sample and of depths alone.
  VkPipeline pipeline(VkShaderModule vertex, VkShaderModule fragment) {
    const bool colors = fragment != VK_NULL_HANDLE;
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    stages[0] = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                 nullptr,
                 0,
                 VK_SHADER_STAGE_VERTEX_BIT,
                 vertex,
                 "main",
                 nullptr};
    stages[1] = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                 nullptr,
                 0,
                 VK_SHADER_STAGE_FRAGMENT_BIT,
                 fragment,
                 "main",
                 nullptr};
    const VkVertexInputBindingDescription binding{0, sizeof(Corner), VK_VERTEX_INPUT_RATE_VERTEX};
    const std::array attributes{VkVertexInputAttributeDescription{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                                VkVertexInputAttributeDescription{1, 0, VK_FORMAT_R32G32B32_SFLOAT, 12}};
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
                                               nullptr,
                                               0,
                                               1,
                                               &binding,
                                               2,
                                               attributes.data()};
    VkPipelineInputAssemblyStateCreateInfo assembly{
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO, nullptr, 0,
        VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_FALSE};
    const VkViewport viewport{0, 0, kInnerWidth, kInnerHeight, 0, 1};
    const VkRect2D scissor{{0, 0}, {kInnerWidth, kInnerHeight}};
    VkPipelineViewportStateCreateInfo window{
        VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, nullptr, 0, 1, &viewport, 1, &scissor};
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = colors ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_LESS;
    std::array<VkPipelineColorBlendAttachmentState, 2> blends{};
    blends[1].colorWriteMask = 0xf;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = colors ? 2 : 0;
    blend.pAttachments = blends.data();
    const std::array formats{VK_FORMAT_UNDEFINED, kColor};
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = blend.attachmentCount;
    rendering.pColorAttachmentFormats = formats.data();
    rendering.depthAttachmentFormat = kDepth;
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
    info.stageCount = colors ? 2 : 1;
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &window;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.layout = layout_;
    VkPipeline made = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &made), "pipeline");
    return made;
  }
  void make_commands() {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                 VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, 0};
    VkCommandBufferAllocateInfo wish{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    check(vkCreateCommandPool(device_, &pool, nullptr, &wish.commandPool), "command pool");
    wish.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device_, &wish, &commands_), "command buffer");
    VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(device_, &fence, nullptr, &fence_), "fence");
  }
  void begin(const VkRenderingAttachmentInfo& depth, const std::vector<VkRenderingAttachmentInfo>& colors) {
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea = {{0, 0}, {kInnerWidth, kInnerHeight}};
    info.layerCount = 1;
    info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
    info.pColorAttachments = colors.data();
    info.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands_, &info);
  }
  static VkRenderingAttachmentInfo attachment(VkImageView view, const VkClearValue& clear) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = view;
    info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    info.clearValue = clear;
    return info;
  }
  void draw_cubes(VkPipeline pipeline, const std::array<float, 16>& turned) {
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set_, 0, nullptr);
    vkCmdBindVertexBuffers(commands_, 0, 1, &buffer_, &corners_at_);
    vkCmdBindIndexBuffer(commands_, buffer_, 0, VK_INDEX_TYPE_UINT16);
    vkCmdPushConstants(commands_, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof turned, turned.data());
    vkCmdDrawIndexedIndirect(commands_, buffer_, arguments_at_, 2, sizeof(VkDrawIndexedIndirectCommand));
    vkCmdEndRendering(commands_);
  }
  void record(VkImage shown, const std::array<float, 16>& turned);

  Image prepass_, copied_, samples_, sample_depths_, resolved_;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceSize arguments_at_ = 0, corners_at_ = 0;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  VkPipeline depth_pipeline_ = VK_NULL_HANDLE, pipeline_ = VK_NULL_HANDLE;
  VkFence fence_ = VK_NULL_HANDLE;
};

void Program::record(VkImage shown, const std::array<float, 16>& turned) {
  constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL, kUndefined = VK_IMAGE_LAYOUT_UNDEFINED;
  VkCommandBufferBeginInfo once{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  check(vkBeginCommandBuffer(commands_, &once), "begin");
  const VkImageAspectFlags depths = VK_IMAGE_ASPECT_DEPTH_BIT, colors = VK_IMAGE_ASPECT_COLOR_BIT;
  for (const Image* image : {&prepass_, &copied_, &sample_depths_})
    barrier(image->image, depths, kUndefined, kGeneral);
  for (VkImage image : {samples_.image, resolved_.image, shown}) barrier(image, colors, kUndefined, kGeneral);
  VkClearValue far{}, sky{};
  far.depthStencil.depth = 1;
  sky.color = {{0.1f, 0.2f, 0.4f, 1.0f}};

  begin(attachment(prepass_.view, far), {});
  draw_cubes(depth_pipeline_, turned);
  barrier(prepass_.image, depths, kGeneral, kGeneral);
  const VkExtent3D whole{kInnerWidth, kInnerHeight, 1};
  const VkImageSubresourceLayers depth_layer{depths, 0, 0, 1}, layer{colors, 0, 0, 1};
  const VkImageCopy2 copy{VK_STRUCTURE_TYPE_IMAGE_COPY_2, nullptr, depth_layer, {}, depth_layer, {}, whole};
  const VkCopyImageInfo2 copies{VK_STRUCTURE_TYPE_COPY_IMAGE_INFO_2,
                                nullptr,
                                prepass_.image,
                                kGeneral,
                                copied_.image,
                                kGeneral,
                                1,
                                &copy};
  vkCmdCopyImage2(commands_, &copies);
  barrier(copied_.image, depths, kGeneral, kGeneral);

  begin(attachment(sample_depths_.view, far),
        {attachment(VK_NULL_HANDLE, sky), attachment(samples_.view, sky)});
  draw_cubes(pipeline_, turned);
  barrier(samples_.image, colors, kGeneral, kGeneral);
  const VkImageResolve2 resolve{VK_STRUCTURE_TYPE_IMAGE_RESOLVE_2, nullptr, layer, {}, layer, {}, whole};
  const VkResolveImageInfo2 resolves{VK_STRUCTURE_TYPE_RESOLVE_IMAGE_INFO_2,
                                     nullptr,
                                     samples_.image,
                                     kGeneral,
                                     resolved_.image,
                                     kGeneral,
                                     1,
                                     &resolve};
  vkCmdResolveImage2(commands_, &resolves);
  barrier(resolved_.image, colors, kGeneral, kGeneral);
  VkImageBlit2 blit{VK_STRUCTURE_TYPE_IMAGE_BLIT_2};
  blit.srcSubresource = blit.dstSubresource = layer;
  blit.srcOffsets[1] = {kInnerWidth, kInnerHeight, 1};
  blit.dstOffsets[1] = {kWidth, kHeight, 1};
  const VkBlitImageInfo2 blits{VK_STRUCTURE_TYPE_BLIT_IMAGE_INFO_2,
                               nullptr,
                               resolved_.image,
                               kGeneral,
                               shown,
                               kGeneral,
                               1,
                               &blit,
                               VK_FILTER_LINEAR};
  vkCmdBlitImage2(commands_, &blits);
  barrier(shown, colors, kGeneral, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
  check(vkEndCommandBuffer(commands_), "end");
}

}  // namespace

int main() {
  Program program;
  for (int frame = 1; frame <= 30; ++frame) program.draw(frame);
  return 0;
}
