/// Descriptor sets, pipeline layouts and pipelines of a frame.
///
/// The stream has no layouts: a set's layout follows from what it holds, and a pipeline is made for each
/// combination of sets it is drawn with.
#include <algorithm>

#include "models/base/descriptor_binding.h"
#include "models/base/error.h"
#include "tests/lavapipe/sample_inputs.h"
#include "tests/lavapipe/vulkan_enums.h"
#include "tests/lavapipe/vulkan_frame.h"

namespace quadrille::lavapipe {
namespace {

constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, VkShaderModule module) {
  VkPipelineShaderStageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage = stage;
  info.module = module;
  info.pName = "main";
  return info;
}

/// The vertex input state and the arrays it points to.
struct VertexInput {
  std::vector<VkVertexInputBindingDescription> bindings;
  std::vector<VkVertexInputAttributeDescription> attributes;
  VkPipelineVertexInputStateCreateInfo info{};

  explicit VertexInput(const traces::Pipeline& pipeline) {
    for (const auto& b : pipeline.bindings)
      bindings.push_back({b.binding, b.stride,
                          b.per_instance ? VK_VERTEX_INPUT_RATE_INSTANCE : VK_VERTEX_INPUT_RATE_VERTEX});
    for (const auto& a : pipeline.attributes)
      attributes.push_back({a.location, a.binding, vk_format(a.format), a.offset});
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    info.vertexBindingDescriptionCount = static_cast<std::uint32_t>(bindings.size());
    info.pVertexBindingDescriptions = bindings.data();
    info.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(attributes.size());
    info.pVertexAttributeDescriptions = attributes.data();
  }
};

VkPipelineColorBlendAttachmentState blend_attachment(const traces::BlendState& blend) {
  VkPipelineColorBlendAttachmentState state{};
  state.blendEnable = blend.enable ? VK_TRUE : VK_FALSE;
  state.srcColorBlendFactor = vk_blend_factor(blend.src_color);
  state.dstColorBlendFactor = vk_blend_factor(blend.dst_color);
  state.colorBlendOp = vk_blend_op(blend.color);
  state.srcAlphaBlendFactor = vk_blend_factor(blend.src_alpha);
  state.dstAlphaBlendFactor = vk_blend_factor(blend.dst_alpha);
  state.alphaBlendOp = vk_blend_op(blend.alpha);
  state.colorWriteMask = blend.write_mask;
  return state;
}

VkPipelineRasterizationStateCreateInfo raster_state(const traces::Pipeline& pipeline) {
  VkPipelineRasterizationStateCreateInfo state{};
  state.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  state.depthClampEnable = pipeline.depth_clamp ? VK_TRUE : VK_FALSE;
  state.polygonMode = vk_polygon_mode(pipeline.polygon_mode);
  state.cullMode = vk_cull(pipeline.cull);
  state.frontFace = vk_front(pipeline.front);
  state.lineWidth = pipeline.line_width;
  state.depthBiasEnable = pipeline.depth_bias.enable ? VK_TRUE : VK_FALSE;
  state.depthBiasConstantFactor = pipeline.depth_bias.constant;
  state.depthBiasSlopeFactor = pipeline.depth_bias.slope;
  state.depthBiasClamp = pipeline.depth_bias.clamp;
  return state;
}

VkStencilOpState stencil_face(const traces::StencilFace& face) {
  return {vk_stencil_op(face.fail),
          vk_stencil_op(face.pass),
          vk_stencil_op(face.depth_fail),
          vk_compare(face.compare),
          face.compare_mask,
          face.write_mask,
          face.reference};
}

VkPipelineDepthStencilStateCreateInfo depth_state(const traces::Pipeline& pipeline) {
  const traces::DepthState& depth = pipeline.depth;
  VkPipelineDepthStencilStateCreateInfo state{};
  state.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  state.depthTestEnable = depth.test ? VK_TRUE : VK_FALSE;
  state.depthWriteEnable = depth.write ? VK_TRUE : VK_FALSE;
  state.depthCompareOp = vk_compare(depth.compare);
  state.depthBoundsTestEnable = pipeline.depth_bounds.test ? VK_TRUE : VK_FALSE;
  state.minDepthBounds = pipeline.depth_bounds.least;
  state.maxDepthBounds = pipeline.depth_bounds.most;
  state.stencilTestEnable = pipeline.stencil.test ? VK_TRUE : VK_FALSE;
  state.front = stencil_face(pipeline.stencil.front);
  state.back = stencil_face(pipeline.stencil.back);
  return state;
}

}  // namespace

VulkanFrame::SetShape VulkanFrame::shape_of(traces::Index set) const {
  SetShape shape;
  if (set == traces::kNone) return shape;
  const auto add = [&shape](std::uint32_t number, VkDescriptorType type) {
    ArrayShape& array = shape[models::binding_of(number)];
    array.type = type;
    array.count = std::max(array.count, models::element_of(number) + 1);
  };
  for (const auto& uniform : stream_.descriptor_sets[set].uniforms)
    add(uniform.binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
  for (const auto& buffer : stream_.descriptor_sets[set].buffers)
    add(buffer.binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  for (const auto& texture : stream_.descriptor_sets[set].textures)
    add(texture.binding, texture.sampler == traces::kNone ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE
                                                          : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
  for (const auto& sampler : stream_.descriptor_sets[set].samplers)
    add(sampler.binding, VK_DESCRIPTOR_TYPE_SAMPLER);
  return shape;
}

VkDescriptorSetLayout VulkanFrame::set_layout(const SetShape& shape) {
  const auto known = set_layouts_.find(shape);
  if (known != set_layouts_.end()) return known->second;
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const auto& [binding, array] : shape)
    bindings.push_back({binding, array.type, array.count, kStages, nullptr});
  VkDescriptorSetLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  require(vkCreateDescriptorSetLayout(device_.handle(), &info, nullptr, &layout),
          "vkCreateDescriptorSetLayout");
  cleanup_.add([this, layout] { vkDestroyDescriptorSetLayout(device_.handle(), layout, nullptr); });
  return set_layouts_[shape] = layout;
}

void VulkanFrame::create_descriptor_sets() {
  std::uint32_t uniforms = 1, textures = 1, buffers = 1;
  for (const auto& set : stream_.descriptor_sets) {
    uniforms += static_cast<std::uint32_t>(set.uniforms.size());
    buffers += static_cast<std::uint32_t>(set.buffers.size());
    textures += static_cast<std::uint32_t>(set.textures.size() + set.samplers.size());
  }
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, uniforms},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, buffers},
                                        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, textures},
                                        {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, textures},
                                        {VK_DESCRIPTOR_TYPE_SAMPLER, textures}};
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = static_cast<std::uint32_t>(stream_.descriptor_sets.size()) + 1;
  info.poolSizeCount = static_cast<std::uint32_t>(std::size(sizes));
  info.pPoolSizes = sizes;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  require(vkCreateDescriptorPool(device_.handle(), &info, nullptr, &pool), "vkCreateDescriptorPool");
  cleanup_.add([this, pool] { vkDestroyDescriptorPool(device_.handle(), pool, nullptr); });

  for (traces::Index index = 0; index < stream_.descriptor_sets.size(); ++index) {
    const traces::DescriptorSet& source = stream_.descriptor_sets[index];
    const VkDescriptorSetLayout layout = set_layout(shape_of(index));
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    require(vkAllocateDescriptorSets(device_.handle(), &allocate, &set), "vkAllocateDescriptorSets");
    descriptor_sets_.push_back(set);
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.descriptorCount = 1;
    const auto write_block = [&](const auto& block, VkDescriptorType type) {
      const VkDescriptorBufferInfo buffer{buffers_[block.buffer], block.offset, block.range};
      write.dstBinding = models::binding_of(block.binding);
      write.dstArrayElement = models::element_of(block.binding);
      write.descriptorType = type;
      write.pBufferInfo = &buffer;
      vkUpdateDescriptorSets(device_.handle(), 1, &write, 0, nullptr);
    };
    for (const auto& uniform : source.uniforms) write_block(uniform, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
    for (const auto& buffer : source.buffers) write_block(buffer, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    const auto write_image = [&](std::uint32_t number, VkDescriptorType type,
                                 const VkDescriptorImageInfo& image) {
      write.dstBinding = models::binding_of(number);
      write.dstArrayElement = models::element_of(number);
      write.descriptorType = type;
      write.pImageInfo = &image;
      vkUpdateDescriptorSets(device_.handle(), 1, &write, 0, nullptr);
    };
    for (const auto& texture : source.textures) {
      const bool integers = traces::is_integer_format(stream_.images[texture.image].format);
      const bool combined = texture.sampler != traces::kNone;
      write_image(texture.binding,
                  combined ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                  {combined ? sampler_of({texture.sampler, integers}) : VK_NULL_HANDLE,
                   view_of({{texture.image, texture.first_level, texture.layer},
                            traces::level_count(stream_, texture),
                            texture.view,
                            texture.layers,
                            texture.components}),
                   VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    }
    for (const auto& sampler : source.samplers)
      write_image(sampler.binding, VK_DESCRIPTOR_TYPE_SAMPLER,
                  {sampler_of({sampler.sampler, false}), VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED});
  }
}

VkPipelineLayout VulkanFrame::pipeline_layout(const SetShapes& shapes) {
  const auto known = pipeline_layouts_.find(shapes);
  if (known != pipeline_layouts_.end()) return known->second;
  std::vector<VkDescriptorSetLayout> sets;
  for (const SetShape& shape : shapes) sets.push_back(set_layout(shape));
  const VkPushConstantRange range{kStages, 0,
                                  std::min(traces::kMaxPushConstantBytes, device_.info().max_push_constants)};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
  info.pSetLayouts = sets.data();
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  require(vkCreatePipelineLayout(device_.handle(), &info, nullptr, &layout), "vkCreatePipelineLayout");
  cleanup_.add([this, layout] { vkDestroyPipelineLayout(device_.handle(), layout, nullptr); });
  return pipeline_layouts_[shapes] = layout;
}

VkShaderModule VulkanFrame::shader_module(traces::Index shader, bool by_sample) {
  const auto known = modules_.find({shader, by_sample});
  if (known != modules_.end()) return known->second;
  const traces::Shader& source = stream_.shaders[shader];
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  const std::vector<std::uint32_t> words = by_sample ? with_sample_inputs(source.spirv) : source.spirv;
  info.codeSize = words.size() * sizeof(std::uint32_t);
  info.pCode = words.data();
  VkShaderModule module = VK_NULL_HANDLE;
  require(vkCreateShaderModule(device_.handle(), &info, nullptr, &module), "vkCreateShaderModule");
  cleanup_.add([this, module] { vkDestroyShaderModule(device_.handle(), module, nullptr); });
  return modules_[{shader, by_sample}] = module;
}

const VulkanFrame::PipelineObjects& VulkanFrame::pipeline_for(const Bound& bound) {
  const std::uint32_t limit = device_.info().max_push_constants;
  if (bound.push_constants.size() > limit)
    throw user_error("{}: pushes {} bytes of constants; {} takes at most {}", stream_.name,
                     bound.push_constants.size(), device_.info().name, limit);
  SetShapes shapes;
  for (const traces::Index set : bound.sets) shapes.push_back(shape_of(set));
  const PassFormats formats = formats_of(*bound.pass);
  const auto key = std::tuple{bound.pipeline, formats, shapes};
  const auto known = pipelines_.find(key);
  if (known != pipelines_.end()) return known->second;
  PipelineObjects objects;
  objects.layout = pipeline_layout(shapes);
  objects.pipeline = create_pipeline(stream_.pipelines[bound.pipeline], formats, objects.layout);
  cleanup_.add([this, handle = objects.pipeline] { vkDestroyPipeline(device_.handle(), handle, nullptr); });
  return pipelines_[key] = objects;
}

VulkanFrame::PassFormats VulkanFrame::formats_of(const traces::BeginPass& pass) const {
  PassFormats of;
  for (const traces::ColorAttachmentUse& use : pass.colors)
    of.formats.push_back(stream_.images[use.image].format);
  of.formats.push_back(pass.depth.image == traces::kNone ? traces::Format::kUndefined
                                                         : stream_.images[pass.depth.image].format);
  of.samples = stream_.images[pass.first_image()].samples;
  return of;
}

VkPipeline VulkanFrame::create_pipeline(const traces::Pipeline& pipeline, const PassFormats& pass,
                                        VkPipelineLayout layout) {
  const VkPipelineShaderStageCreateInfo stages[] = {
      stage_info(VK_SHADER_STAGE_VERTEX_BIT, shader_module(pipeline.vertex_shader)),
      stage_info(VK_SHADER_STAGE_FRAGMENT_BIT,
                 shader_module(pipeline.fragment_shader, pipeline.sample_shading))};
  const VertexInput input(pipeline);
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = vk_topology(pipeline.topology);
  assembly.primitiveRestartEnable = pipeline.primitive_restart ? VK_TRUE : VK_FALSE;
  VkPipelineViewportStateCreateInfo viewport{};
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = viewport.scissorCount = pipeline.viewports;
  VkPipelineRasterizationStateCreateInfo raster = raster_state(pipeline);
  VkPipelineRasterizationLineStateCreateInfoEXT lines{};
  lines.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT;
  lines.lineRasterizationMode = vk_line_mode(pipeline.line_mode);
  if (device_.info().line_modes) raster.pNext = &lines;
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = static_cast<VkSampleCountFlagBits>(pass.samples);
  samples.sampleShadingEnable = pipeline.sample_shading ? VK_TRUE : VK_FALSE;
  samples.minSampleShading = 1;
  samples.pSampleMask = &pipeline.sample_mask;
  samples.alphaToCoverageEnable = pipeline.alpha_to_coverage ? VK_TRUE : VK_FALSE;
  const VkPipelineDepthStencilStateCreateInfo depth = depth_state(pipeline);
  const std::vector<traces::Format>& formats = pass.formats;
  std::vector<VkPipelineColorBlendAttachmentState> attachments;
  std::vector<VkFormat> color_formats;
  for (std::size_t i = 0; i + 1 < formats.size(); ++i) {
    attachments.push_back(blend_attachment(pipeline.blend[i]));
    color_formats.push_back(vk_format(formats[i]));
  }
  VkPipelineColorBlendStateCreateInfo blend{};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = static_cast<std::uint32_t>(attachments.size());
  blend.pAttachments = attachments.data();
  blend.logicOpEnable = pipeline.blend_shared.logic ? VK_TRUE : VK_FALSE;
  blend.logicOp = vk_logic_op(pipeline.blend_shared.logic_op);
  std::ranges::copy(pipeline.blend_shared.constants, blend.blendConstants);
  const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{};
  dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
  dynamic.dynamicStateCount = 2;
  dynamic.pDynamicStates = dynamic_states;
  VkPipelineRenderingCreateInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = static_cast<std::uint32_t>(color_formats.size());
  rendering.pColorAttachmentFormats = color_formats.data();
  rendering.depthAttachmentFormat = vk_format(formats.back());
  if (models::has_stencil(formats.back()))
    rendering.stencilAttachmentFormat = rendering.depthAttachmentFormat;

  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.pNext = &rendering;
  info.stageCount = 2;
  info.pStages = stages;
  info.pVertexInputState = &input.info;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout;
  VkPipeline handle = VK_NULL_HANDLE;
  require(vkCreateGraphicsPipelines(device_.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &handle),
          "vkCreateGraphicsPipelines");
  return handle;
}

}  // namespace quadrille::lavapipe
