/// Members of the structures that calls of the tables can reach, in their order. [VK registry]
#include <vulkan/vulkan_core.h>

#include "traces/capture/schema.h"

namespace quadrille::capture {
namespace {

// clang-format off: a row an entry
constexpr SchemaRow kStructures[] = {
    {"AllocationCallbacks",
     "pUserData:u64 pfnAllocation:u64 pfnReallocation:u64 pfnFree:u64 "
     "pfnInternalAllocation:u64 pfnInternalFree:u64"},
    {"AttachmentDescription",
     "flags:u32 format:u32 samples:u32 loadOp:u32 storeOp:u32 stencilLoadOp:u32 "
     "stencilStoreOp:u32 initialLayout:u32 finalLayout:u32"},
    {"AttachmentDescription2",
     "sType:u32 pNext:next flags:u32 format:u32 samples:u32 loadOp:u32 storeOp:u32 "
     "stencilLoadOp:u32 stencilStoreOp:u32 initialLayout:u32 finalLayout:u32",
     VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2},
    {"AttachmentDescriptionStencilLayout",
     "sType:u32 pNext:next stencilInitialLayout:u32 "
     "stencilFinalLayout:u32",
     VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_STENCIL_LAYOUT},
    {"AttachmentReference", "attachment:u32 layout:u32"},
    {"AttachmentReference2", "sType:u32 pNext:next attachment:u32 layout:u32 aspectMask:u32",
     VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2},
    {"AttachmentReferenceStencilLayout", "sType:u32 pNext:next stencilLayout:u32",
     VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_STENCIL_LAYOUT},
    {"BindBufferMemoryInfo", "sType:u32 pNext:next buffer:u64 memory:u64 memoryOffset:u64",
     VK_STRUCTURE_TYPE_BIND_BUFFER_MEMORY_INFO},
    {"BindImageMemoryInfo", "sType:u32 pNext:next image:u64 memory:u64 memoryOffset:u64",
     VK_STRUCTURE_TYPE_BIND_IMAGE_MEMORY_INFO},
    {"BufferCreateInfo",
     "sType:u32 pNext:next flags:u32 size:u64 usage:u32 sharingMode:u32 "
     "queueFamilyIndexCount:u32 pQueueFamilyIndices:*u32",
     VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO},
    {"BufferOpaqueCaptureAddressCreateInfo", "sType:u32 pNext:next opaqueCaptureAddress:u64",
     VK_STRUCTURE_TYPE_BUFFER_OPAQUE_CAPTURE_ADDRESS_CREATE_INFO},
    {"BufferViewCreateInfo", "sType:u32 pNext:next flags:u32 buffer:u64 format:u32 offset:u64 range:u64",
     VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO},
    {"ClearAttachment", "aspectMask:u32 colorAttachment:u32 clearValue:ClearValue"},
    {"ClearDepthStencilValue", "depth:f32 stencil:u32"},
    {"ClearRect", "rect:Rect2D baseArrayLayer:u32 layerCount:u32"},
    {"ClearValue", "color:*u32"},
    {"ColorBlendEquationEXT",
     "srcColorBlendFactor:u32 dstColorBlendFactor:u32 colorBlendOp:u32 "
     "srcAlphaBlendFactor:u32 dstAlphaBlendFactor:u32 alphaBlendOp:u32"},
    {"CommandBufferBeginInfo",
     "sType:u32 pNext:next flags:u32 "
     "pInheritanceInfo:*CommandBufferInheritanceInfo",
     VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO},
    {"CommandBufferInheritanceInfo",
     "sType:u32 pNext:next renderPass:u64 subpass:u32 framebuffer:u64 "
     "occlusionQueryEnable:u32 queryFlags:u32 pipelineStatistics:u32",
     VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO},
    {"CommandBufferSubmitInfo", "sType:u32 pNext:next commandBuffer:u64 deviceMask:u32",
     VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO},
    {"ComponentMapping", "r:u32 g:u32 b:u32 a:u32"},
    {"CopyDescriptorSet",
     "sType:u32 pNext:next srcSet:u64 srcBinding:u32 srcArrayElement:u32 dstSet:u64 "
     "dstBinding:u32 dstArrayElement:u32 descriptorCount:u32",
     VK_STRUCTURE_TYPE_COPY_DESCRIPTOR_SET},
    {"DebugUtilsLabelEXT", "sType:u32 pNext:next pLabelName:str color:*f32",
     VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT},
    {"DescriptorBufferInfo", "buffer:u64 offset:u64 range:u64"},
    {"DescriptorImageInfo", "sampler:u64 imageView:u64 imageLayout:u32"},
    {"DescriptorSetAllocateInfo",
     "sType:u32 pNext:next descriptorPool:u64 descriptorSetCount:u32 "
     "pSetLayouts:*u64",
     VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO},
    {"DescriptorSetLayoutBinding",
     "binding:u32 descriptorType:u32 descriptorCount:u32 stageFlags:u32 "
     "pImmutableSamplers:*u64"},
    {"DescriptorSetLayoutBindingFlagsCreateInfo", "sType:u32 pNext:next bindingCount:u32 pBindingFlags:*u32",
     VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO},
    {"DescriptorSetLayoutCreateInfo",
     "sType:u32 pNext:next flags:u32 bindingCount:u32 "
     "pBindings:*DescriptorSetLayoutBinding",
     VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO},
    {"DescriptorSetVariableDescriptorCountAllocateInfo",
     "sType:u32 pNext:next descriptorSetCount:u32 "
     "pDescriptorCounts:*u32",
     VK_STRUCTURE_TYPE_DESCRIPTOR_SET_VARIABLE_DESCRIPTOR_COUNT_ALLOCATE_INFO},
    {"DescriptorUpdateTemplateCreateInfo",
     "sType:u32 pNext:next flags:u32 descriptorUpdateEntryCount:u32 "
     "pDescriptorUpdateEntries:*DescriptorUpdateTemplateEntry templateType:u32 descriptorSetLayout:u64 "
     "pipelineBindPoint:u32 pipelineLayout:u64 set:u32",
     VK_STRUCTURE_TYPE_DESCRIPTOR_UPDATE_TEMPLATE_CREATE_INFO},
    {"DescriptorUpdateTemplateEntry",
     "dstBinding:u32 dstArrayElement:u32 descriptorCount:u32 "
     "descriptorType:u32 offset:u64 stride:u64"},
    {"ExportMemoryAllocateInfo", "sType:u32 pNext:next handleTypes:u32",
     VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO},
    {"Extent2D", "width:u32 height:u32"},
    {"Extent3D", "width:u32 height:u32 depth:u32"},
    {"ExternalMemoryBufferCreateInfo", "sType:u32 pNext:next handleTypes:u32",
     VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO},
    {"ExternalMemoryImageCreateInfo", "sType:u32 pNext:next handleTypes:u32",
     VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO},
    {"FramebufferAttachmentImageInfo",
     "sType:u32 pNext:next flags:u32 usage:u32 width:u32 height:u32 "
     "layerCount:u32 viewFormatCount:u32 pViewFormats:*u32",
     VK_STRUCTURE_TYPE_FRAMEBUFFER_ATTACHMENT_IMAGE_INFO},
    {"FramebufferAttachmentsCreateInfo",
     "sType:u32 pNext:next attachmentImageInfoCount:u32 "
     "pAttachmentImageInfos:*FramebufferAttachmentImageInfo",
     VK_STRUCTURE_TYPE_FRAMEBUFFER_ATTACHMENTS_CREATE_INFO},
    {"FramebufferCreateInfo",
     "sType:u32 pNext:next flags:u32 renderPass:u64 attachmentCount:u32 "
     "pAttachments:*u64 width:u32 height:u32 layers:u32",
     VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO},
    {"GraphicsPipelineCreateInfo",
     "sType:u32 pNext:next flags:u32 stageCount:u32 "
     "pStages:*PipelineShaderStageCreateInfo pVertexInputState:*PipelineVertexInputStateCreateInfo "
     "pInputAssemblyState:*PipelineInputAssemblyStateCreateInfo "
     "pTessellationState:*PipelineTessellationStateCreateInfo "
     "pViewportState:*PipelineViewportStateCreateInfo "
     "pRasterizationState:*PipelineRasterizationStateCreateInfo "
     "pMultisampleState:*PipelineMultisampleStateCreateInfo "
     "pDepthStencilState:*PipelineDepthStencilStateCreateInfo "
     "pColorBlendState:*PipelineColorBlendStateCreateInfo pDynamicState:*PipelineDynamicStateCreateInfo "
     "layout:u64 renderPass:u64 subpass:u32 basePipelineHandle:u64 basePipelineIndex:i32",
     VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO},
    {"ImageCreateInfo",
     "sType:u32 pNext:next flags:u32 imageType:u32 format:u32 extent:Extent3D "
     "mipLevels:u32 arrayLayers:u32 samples:u32 tiling:u32 usage:u32 sharingMode:u32 "
     "queueFamilyIndexCount:u32 pQueueFamilyIndices:*u32 initialLayout:u32",
     VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO},
    {"ImageFormatListCreateInfo", "sType:u32 pNext:next viewFormatCount:u32 pViewFormats:*u32",
     VK_STRUCTURE_TYPE_IMAGE_FORMAT_LIST_CREATE_INFO},
    {"ImageStencilUsageCreateInfo", "sType:u32 pNext:next stencilUsage:u32",
     VK_STRUCTURE_TYPE_IMAGE_STENCIL_USAGE_CREATE_INFO},
    {"ImageSubresourceLayers", "aspectMask:u32 mipLevel:u32 baseArrayLayer:u32 layerCount:u32"},
    {"ImageSubresourceRange",
     "aspectMask:u32 baseMipLevel:u32 levelCount:u32 baseArrayLayer:u32 "
     "layerCount:u32"},
    {"ImageSwapchainCreateInfoKHR", "sType:u32 pNext:next swapchain:u64",
     VK_STRUCTURE_TYPE_IMAGE_SWAPCHAIN_CREATE_INFO_KHR},
    {"ImageViewCreateInfo",
     "sType:u32 pNext:next flags:u32 image:u64 viewType:u32 format:u32 "
     "components:ComponentMapping subresourceRange:ImageSubresourceRange",
     VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO},
    {"ImageViewUsageCreateInfo", "sType:u32 pNext:next usage:u32",
     VK_STRUCTURE_TYPE_IMAGE_VIEW_USAGE_CREATE_INFO},
    {"MemoryAllocateFlagsInfo", "sType:u32 pNext:next flags:u32 deviceMask:u32",
     VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO},
    {"MemoryAllocateInfo", "sType:u32 pNext:next allocationSize:u64 memoryTypeIndex:u32",
     VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO},
    {"MemoryDedicatedAllocateInfo", "sType:u32 pNext:next image:u64 buffer:u64",
     VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO},
    {"MemoryOpaqueCaptureAddressAllocateInfo", "sType:u32 pNext:next opaqueCaptureAddress:u64",
     VK_STRUCTURE_TYPE_MEMORY_OPAQUE_CAPTURE_ADDRESS_ALLOCATE_INFO},
    {"MemoryPriorityAllocateInfoEXT", "sType:u32 pNext:next priority:f32",
     VK_STRUCTURE_TYPE_MEMORY_PRIORITY_ALLOCATE_INFO_EXT},
    {"MultiDrawIndexedInfoEXT", "firstIndex:u32 indexCount:u32 vertexOffset:i32"},
    {"MultiDrawInfoEXT", "firstVertex:u32 vertexCount:u32"},
    {"Offset2D", "x:i32 y:i32"},
    {"Offset3D", "x:i32 y:i32 z:i32"},
    {"PipelineColorBlendAttachmentState",
     "blendEnable:u32 srcColorBlendFactor:u32 dstColorBlendFactor:u32 "
     "colorBlendOp:u32 srcAlphaBlendFactor:u32 dstAlphaBlendFactor:u32 alphaBlendOp:u32 colorWriteMask:u32"},
    {"PipelineColorBlendStateCreateInfo",
     "sType:u32 pNext:next flags:u32 logicOpEnable:u32 logicOp:u32 "
     "attachmentCount:u32 pAttachments:*PipelineColorBlendAttachmentState blendConstants:*f32",
     VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO},
    {"PipelineColorWriteCreateInfoEXT", "sType:u32 pNext:next attachmentCount:u32 pColorWriteEnables:*u32",
     VK_STRUCTURE_TYPE_PIPELINE_COLOR_WRITE_CREATE_INFO_EXT},
    {"PipelineCreationFeedback", "flags:u32 duration:u64"},
    {"PipelineCreationFeedbackCreateInfo",
     "sType:u32 pNext:next "
     "pPipelineCreationFeedback:*PipelineCreationFeedback pipelineStageCreationFeedbackCount:u32 "
     "pPipelineStageCreationFeedbacks:*PipelineCreationFeedback",
     VK_STRUCTURE_TYPE_PIPELINE_CREATION_FEEDBACK_CREATE_INFO},
    {"PipelineDepthStencilStateCreateInfo",
     "sType:u32 pNext:next flags:u32 depthTestEnable:u32 "
     "depthWriteEnable:u32 depthCompareOp:u32 depthBoundsTestEnable:u32 stencilTestEnable:u32 "
     "front:StencilOpState back:StencilOpState minDepthBounds:f32 maxDepthBounds:f32",
     VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO},
    {"PipelineDynamicStateCreateInfo",
     "sType:u32 pNext:next flags:u32 dynamicStateCount:u32 "
     "pDynamicStates:*u32",
     VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO},
    {"PipelineInputAssemblyStateCreateInfo",
     "sType:u32 pNext:next flags:u32 topology:u32 "
     "primitiveRestartEnable:u32",
     VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO},
    {"PipelineLayoutCreateInfo",
     "sType:u32 pNext:next flags:u32 setLayoutCount:u32 pSetLayouts:*u64 "
     "pushConstantRangeCount:u32 pPushConstantRanges:*PushConstantRange",
     VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO},
    {"PipelineMultisampleStateCreateInfo",
     "sType:u32 pNext:next flags:u32 rasterizationSamples:u32 "
     "sampleShadingEnable:u32 minSampleShading:f32 pSampleMask:*u32 alphaToCoverageEnable:u32 "
     "alphaToOneEnable:u32",
     VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO},
    {"PipelineRasterizationDepthClipStateCreateInfoEXT", "sType:u32 pNext:next flags:u32 depthClipEnable:u32",
     VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT},
    {"PipelineRasterizationLineStateCreateInfoEXT",
     "sType:u32 pNext:next lineRasterizationMode:u32 "
     "stippledLineEnable:u32 lineStippleFactor:u32 lineStipplePattern:u16",
     VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT},
    {"PipelineRasterizationProvokingVertexStateCreateInfoEXT", "sType:u32 pNext:next provokingVertexMode:u32",
     VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT},
    {"PipelineRasterizationStateCreateInfo",
     "sType:u32 pNext:next flags:u32 depthClampEnable:u32 "
     "rasterizerDiscardEnable:u32 polygonMode:u32 cullMode:u32 frontFace:u32 depthBiasEnable:u32 "
     "depthBiasConstantFactor:f32 depthBiasClamp:f32 depthBiasSlopeFactor:f32 lineWidth:f32",
     VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO},
    {"PipelineRasterizationStateStreamCreateInfoEXT",
     "sType:u32 pNext:next flags:u32 "
     "rasterizationStream:u32",
     VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_STREAM_CREATE_INFO_EXT},
    {"PipelineRenderingCreateInfo",
     "sType:u32 pNext:next viewMask:u32 colorAttachmentCount:u32 "
     "pColorAttachmentFormats:*u32 depthAttachmentFormat:u32 stencilAttachmentFormat:u32",
     VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO},
    {"PipelineShaderStageCreateInfo",
     "sType:u32 pNext:next flags:u32 stage:u32 module:u64 pName:str "
     "pSpecializationInfo:*SpecializationInfo",
     VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO},
    {"PipelineShaderStageRequiredSubgroupSizeCreateInfo", "sType:u32 pNext:next requiredSubgroupSize:u32",
     VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO},
    {"PipelineTessellationDomainOriginStateCreateInfo", "sType:u32 pNext:next domainOrigin:u32",
     VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO},
    {"PipelineTessellationStateCreateInfo", "sType:u32 pNext:next flags:u32 patchControlPoints:u32",
     VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO},
    {"PipelineVertexInputDivisorStateCreateInfoEXT",
     "sType:u32 pNext:next vertexBindingDivisorCount:u32 "
     "pVertexBindingDivisors:*VertexInputBindingDivisorDescriptionEXT",
     VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_DIVISOR_STATE_CREATE_INFO_EXT},
    {"PipelineVertexInputStateCreateInfo",
     "sType:u32 pNext:next flags:u32 vertexBindingDescriptionCount:u32 "
     "pVertexBindingDescriptions:*VertexInputBindingDescription vertexAttributeDescriptionCount:u32 "
     "pVertexAttributeDescriptions:*VertexInputAttributeDescription",
     VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO},
    {"PipelineViewportDepthClipControlCreateInfoEXT", "sType:u32 pNext:next negativeOneToOne:u32",
     VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT},
    {"PipelineViewportStateCreateInfo",
     "sType:u32 pNext:next flags:u32 viewportCount:u32 "
     "pViewports:*Viewport scissorCount:u32 pScissors:*Rect2D",
     VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO},
    {"PresentIdKHR", "sType:u32 pNext:next swapchainCount:u32 pPresentIds:*u64",
     VK_STRUCTURE_TYPE_PRESENT_ID_KHR},
    {"PresentInfoKHR",
     "sType:u32 pNext:next waitSemaphoreCount:u32 pWaitSemaphores:*u64 swapchainCount:u32 "
     "pSwapchains:*u64 pImageIndices:*u32 pResults:*u32",
     VK_STRUCTURE_TYPE_PRESENT_INFO_KHR},
    {"PushConstantRange", "stageFlags:u32 offset:u32 size:u32"},
    {"Rect2D", "offset:Offset2D extent:Extent2D"},
    {"RenderPassAttachmentBeginInfo", "sType:u32 pNext:next attachmentCount:u32 pAttachments:*u64",
     VK_STRUCTURE_TYPE_RENDER_PASS_ATTACHMENT_BEGIN_INFO},
    {"RenderPassBeginInfo",
     "sType:u32 pNext:next renderPass:u64 framebuffer:u64 renderArea:Rect2D "
     "clearValueCount:u32 pClearValues:*ClearValue",
     VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO},
    {"RenderPassCreateInfo",
     "sType:u32 pNext:next flags:u32 attachmentCount:u32 "
     "pAttachments:*AttachmentDescription subpassCount:u32 pSubpasses:*SubpassDescription "
     "dependencyCount:u32 pDependencies:*SubpassDependency",
     VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO},
    {"RenderPassCreateInfo2",
     "sType:u32 pNext:next flags:u32 attachmentCount:u32 "
     "pAttachments:*AttachmentDescription2 subpassCount:u32 pSubpasses:*SubpassDescription2 "
     "dependencyCount:u32 pDependencies:*SubpassDependency2 correlatedViewMaskCount:u32 "
     "pCorrelatedViewMasks:*u32",
     VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2},
    {"RenderingAttachmentInfo",
     "sType:u32 pNext:next imageView:u64 imageLayout:u32 resolveMode:u32 "
     "resolveImageView:u64 resolveImageLayout:u32 loadOp:u32 storeOp:u32 clearValue:ClearValue",
     VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO},
    {"RenderingInfo",
     "sType:u32 pNext:next flags:u32 renderArea:Rect2D layerCount:u32 viewMask:u32 "
     "colorAttachmentCount:u32 pColorAttachments:*RenderingAttachmentInfo "
     "pDepthAttachment:*RenderingAttachmentInfo pStencilAttachment:*RenderingAttachmentInfo",
     VK_STRUCTURE_TYPE_RENDERING_INFO},
    {"SamplerBorderColorComponentMappingCreateInfoEXT",
     "sType:u32 pNext:next components:ComponentMapping "
     "srgb:u32",
     VK_STRUCTURE_TYPE_SAMPLER_BORDER_COLOR_COMPONENT_MAPPING_CREATE_INFO_EXT},
    {"SamplerCreateInfo",
     "sType:u32 pNext:next flags:u32 magFilter:u32 minFilter:u32 mipmapMode:u32 "
     "addressModeU:u32 addressModeV:u32 addressModeW:u32 mipLodBias:f32 anisotropyEnable:u32 "
     "maxAnisotropy:f32 compareEnable:u32 compareOp:u32 minLod:f32 maxLod:f32 borderColor:u32 "
     "unnormalizedCoordinates:u32",
     VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO},
    {"SamplerCustomBorderColorCreateInfoEXT", "sType:u32 pNext:next customBorderColor:*u32 format:u32",
     VK_STRUCTURE_TYPE_SAMPLER_CUSTOM_BORDER_COLOR_CREATE_INFO_EXT},
    {"SamplerReductionModeCreateInfo", "sType:u32 pNext:next reductionMode:u32",
     VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO},
    {"SemaphoreSubmitInfo", "sType:u32 pNext:next semaphore:u64 value:u64 stageMask:u64 deviceIndex:u32",
     VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO},
    {"ShaderModuleCreateInfo", "sType:u32 pNext:next flags:u32 codeSize:u64 pCode:*u32",
     VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO},
    {"SpecializationInfo", "mapEntryCount:u32 pMapEntries:*SpecializationMapEntry dataSize:u64 pData:*u8"},
    {"SpecializationMapEntry", "constantID:u32 offset:u32 size:u64"},
    {"StencilOpState",
     "failOp:u32 passOp:u32 depthFailOp:u32 compareOp:u32 compareMask:u32 writeMask:u32 "
     "reference:u32"},
    {"SubmitInfo",
     "sType:u32 pNext:next waitSemaphoreCount:u32 pWaitSemaphores:*u64 pWaitDstStageMask:*u32 "
     "commandBufferCount:u32 pCommandBuffers:*u64 signalSemaphoreCount:u32 pSignalSemaphores:*u64",
     VK_STRUCTURE_TYPE_SUBMIT_INFO},
    {"SubmitInfo2",
     "sType:u32 pNext:next flags:u32 waitSemaphoreInfoCount:u32 "
     "pWaitSemaphoreInfos:*SemaphoreSubmitInfo commandBufferInfoCount:u32 "
     "pCommandBufferInfos:*CommandBufferSubmitInfo signalSemaphoreInfoCount:u32 "
     "pSignalSemaphoreInfos:*SemaphoreSubmitInfo",
     VK_STRUCTURE_TYPE_SUBMIT_INFO_2},
    {"SubpassBeginInfo", "sType:u32 pNext:next contents:u32", VK_STRUCTURE_TYPE_SUBPASS_BEGIN_INFO},
    {"SubpassDependency",
     "srcSubpass:u32 dstSubpass:u32 srcStageMask:u32 dstStageMask:u32 srcAccessMask:u32 "
     "dstAccessMask:u32 dependencyFlags:u32"},
    {"SubpassDependency2",
     "sType:u32 pNext:next srcSubpass:u32 dstSubpass:u32 srcStageMask:u32 "
     "dstStageMask:u32 srcAccessMask:u32 dstAccessMask:u32 dependencyFlags:u32 viewOffset:i32",
     VK_STRUCTURE_TYPE_SUBPASS_DEPENDENCY_2},
    {"SubpassDescription",
     "flags:u32 pipelineBindPoint:u32 inputAttachmentCount:u32 "
     "pInputAttachments:*AttachmentReference colorAttachmentCount:u32 pColorAttachments:*AttachmentReference "
     "pResolveAttachments:*AttachmentReference pDepthStencilAttachment:*AttachmentReference "
     "preserveAttachmentCount:u32 pPreserveAttachments:*u32"},
    {"SubpassDescription2",
     "sType:u32 pNext:next flags:u32 pipelineBindPoint:u32 viewMask:u32 "
     "inputAttachmentCount:u32 pInputAttachments:*AttachmentReference2 colorAttachmentCount:u32 "
     "pColorAttachments:*AttachmentReference2 pResolveAttachments:*AttachmentReference2 "
     "pDepthStencilAttachment:*AttachmentReference2 preserveAttachmentCount:u32 pPreserveAttachments:*u32",
     VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2},
    {"SubpassDescriptionDepthStencilResolve",
     "sType:u32 pNext:next depthResolveMode:u32 "
     "stencilResolveMode:u32 pDepthStencilResolveAttachment:*AttachmentReference2",
     VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE},
    {"SubpassEndInfo", "sType:u32 pNext:next", VK_STRUCTURE_TYPE_SUBPASS_END_INFO},
    {"SwapchainCreateInfoKHR",
     "sType:u32 pNext:next flags:u32 surface:u64 minImageCount:u32 imageFormat:u32 "
     "imageColorSpace:u32 imageExtent:Extent2D imageArrayLayers:u32 imageUsage:u32 imageSharingMode:u32 "
     "queueFamilyIndexCount:u32 pQueueFamilyIndices:*u32 preTransform:u32 compositeAlpha:u32 presentMode:u32 "
     "clipped:u32 oldSwapchain:u64",
     VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR},
    {"TimelineSemaphoreSubmitInfo",
     "sType:u32 pNext:next waitSemaphoreValueCount:u32 "
     "pWaitSemaphoreValues:*u64 signalSemaphoreValueCount:u32 pSignalSemaphoreValues:*u64",
     VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO},
    {"VertexInputAttributeDescription", "location:u32 binding:u32 format:u32 offset:u32"},
    {"VertexInputAttributeDescription2EXT",
     "sType:u32 pNext:next location:u32 binding:u32 format:u32 "
     "offset:u32",
     VK_STRUCTURE_TYPE_VERTEX_INPUT_ATTRIBUTE_DESCRIPTION_2_EXT},
    {"VertexInputBindingDescription", "binding:u32 stride:u32 inputRate:u32"},
    {"VertexInputBindingDescription2EXT",
     "sType:u32 pNext:next binding:u32 stride:u32 inputRate:u32 "
     "divisor:u32",
     VK_STRUCTURE_TYPE_VERTEX_INPUT_BINDING_DESCRIPTION_2_EXT},
    {"VertexInputBindingDivisorDescriptionEXT", "binding:u32 divisor:u32"},
    {"Viewport", "x:f32 y:f32 width:f32 height:f32 minDepth:f32 maxDepth:f32"},
    {"WriteDescriptorSet",
     "sType:u32 pNext:next dstSet:u64 dstBinding:u32 dstArrayElement:u32 "
     "descriptorCount:u32 descriptorType:u32 pImageInfo:*DescriptorImageInfo "
     "pBufferInfo:*DescriptorBufferInfo pTexelBufferView:*u64",
     VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET},
};
// clang-format on

}  // namespace

std::span<const SchemaRow> structure_rows() { return kStructures; }

}  // namespace quadrille::capture
