/// Parameters of the calls that this program acts upon, in their order. [VK registry]
#include "traces/capture/schema.h"

namespace quadrille::capture {
namespace {

// clang-format off: a row an entry
constexpr SchemaRow kCalls[] = {
    {"AllocateMemory",
     "device:u64 pAllocateInfo:*MemoryAllocateInfo pAllocator:*AllocationCallbacks "
     "pMemory:*u64 return:u32"},
    {"MapMemory", "device:u64 memory:u64 offset:u64 size:u64 flags:u32 ppData:*u64 return:u32"},
    {"UnmapMemory", "device:u64 memory:u64"},
    {"BindBufferMemory", "device:u64 buffer:u64 memory:u64 memoryOffset:u64 return:u32"},
    {"BindBufferMemory2", "device:u64 bindInfoCount:u32 pBindInfos:*BindBufferMemoryInfo return:u32"},
    {"BindImageMemory", "device:u64 image:u64 memory:u64 memoryOffset:u64 return:u32"},
    {"BindImageMemory2", "device:u64 bindInfoCount:u32 pBindInfos:*BindImageMemoryInfo return:u32"},
    {"CreateBuffer",
     "device:u64 pCreateInfo:*BufferCreateInfo pAllocator:*AllocationCallbacks pBuffer:*u64 "
     "return:u32"},
    {"CreateBufferView",
     "device:u64 pCreateInfo:*BufferViewCreateInfo pAllocator:*AllocationCallbacks "
     "pView:*u64 return:u32"},
    {"CreateImage",
     "device:u64 pCreateInfo:*ImageCreateInfo pAllocator:*AllocationCallbacks pImage:*u64 "
     "return:u32"},
    {"CreateImageView",
     "device:u64 pCreateInfo:*ImageViewCreateInfo pAllocator:*AllocationCallbacks "
     "pView:*u64 return:u32"},
    {"CreateSampler",
     "device:u64 pCreateInfo:*SamplerCreateInfo pAllocator:*AllocationCallbacks "
     "pSampler:*u64 return:u32"},
    {"CreateShaderModule",
     "device:u64 pCreateInfo:*ShaderModuleCreateInfo pAllocator:*AllocationCallbacks "
     "pShaderModule:*u64 return:u32"},
    {"CreateDescriptorSetLayout",
     "device:u64 pCreateInfo:*DescriptorSetLayoutCreateInfo "
     "pAllocator:*AllocationCallbacks pSetLayout:*u64 return:u32"},
    {"CreatePipelineLayout",
     "device:u64 pCreateInfo:*PipelineLayoutCreateInfo "
     "pAllocator:*AllocationCallbacks pPipelineLayout:*u64 return:u32"},
    {"CreateDescriptorUpdateTemplate",
     "device:u64 pCreateInfo:*DescriptorUpdateTemplateCreateInfo "
     "pAllocator:*AllocationCallbacks pDescriptorUpdateTemplate:*u64 return:u32"},
    {"AllocateDescriptorSets",
     "device:u64 pAllocateInfo:*DescriptorSetAllocateInfo pDescriptorSets:*u64 "
     "return:u32"},
    {"UpdateDescriptorSets",
     "device:u64 descriptorWriteCount:u32 pDescriptorWrites:*WriteDescriptorSet "
     "descriptorCopyCount:u32 pDescriptorCopies:*CopyDescriptorSet"},
    {"UpdateDescriptorSetWithTemplate",
     "device:u64 descriptorSet:u64 descriptorUpdateTemplate:u64 "
     "pData:template"},
    {"CreateRenderPass",
     "device:u64 pCreateInfo:*RenderPassCreateInfo pAllocator:*AllocationCallbacks "
     "pRenderPass:*u64 return:u32"},
    {"CreateRenderPass2",
     "device:u64 pCreateInfo:*RenderPassCreateInfo2 pAllocator:*AllocationCallbacks "
     "pRenderPass:*u64 return:u32"},
    {"CreateFramebuffer",
     "device:u64 pCreateInfo:*FramebufferCreateInfo pAllocator:*AllocationCallbacks "
     "pFramebuffer:*u64 return:u32"},
    {"CreateGraphicsPipelines",
     "device:u64 pipelineCache:u64 createInfoCount:u32 "
     "pCreateInfos:*GraphicsPipelineCreateInfo pAllocator:*AllocationCallbacks pPipelines:*u64 return:u32"},
    {"CreateSwapchainKHR",
     "device:u64 pCreateInfo:*SwapchainCreateInfoKHR pAllocator:*AllocationCallbacks "
     "pSwapchain:*u64 return:u32"},
    {"GetSwapchainImagesKHR",
     "device:u64 swapchain:u64 pSwapchainImageCount:*u32 pSwapchainImages:*u64 "
     "return:u32"},
    {"QueuePresentKHR", "queue:u64 pPresentInfo:*PresentInfoKHR return:u32"},
    {"BeginCommandBuffer", "commandBuffer:u64 pBeginInfo:*CommandBufferBeginInfo return:u32"},
    {"EndCommandBuffer", "commandBuffer:u64 return:u32"},
    {"ResetCommandBuffer", "commandBuffer:u64 flags:u32 return:u32"},
    {"QueueSubmit", "queue:u64 submitCount:u32 pSubmits:*SubmitInfo fence:u64 return:u32"},
    {"QueueSubmit2", "queue:u64 submitCount:u32 pSubmits:*SubmitInfo2 fence:u64 return:u32"},
    {"CmdBeginRenderPass", "commandBuffer:u64 pRenderPassBegin:*RenderPassBeginInfo contents:u32"},
    {"CmdBeginRenderPass2",
     "commandBuffer:u64 pRenderPassBegin:*RenderPassBeginInfo "
     "pSubpassBeginInfo:*SubpassBeginInfo"},
    {"CmdNextSubpass", "commandBuffer:u64 contents:u32"},
    {"CmdEndRenderPass", "commandBuffer:u64"},
    {"CmdEndRenderPass2", "commandBuffer:u64 pSubpassEndInfo:*SubpassEndInfo"},
    {"CmdBeginRendering", "commandBuffer:u64 pRenderingInfo:*RenderingInfo"},
    {"CmdEndRendering", "commandBuffer:u64"},
    {"CmdExecuteCommands", "commandBuffer:u64 commandBufferCount:u32 pCommandBuffers:*u64"},
    {"CmdBindPipeline", "commandBuffer:u64 pipelineBindPoint:u32 pipeline:u64"},
    {"CmdBindDescriptorSets",
     "commandBuffer:u64 pipelineBindPoint:u32 layout:u64 firstSet:u32 "
     "descriptorSetCount:u32 pDescriptorSets:*u64 dynamicOffsetCount:u32 pDynamicOffsets:*u32"},
    {"CmdPushDescriptorSetKHR",
     "commandBuffer:u64 pipelineBindPoint:u32 layout:u64 set:u32 "
     "descriptorWriteCount:u32 pDescriptorWrites:*WriteDescriptorSet"},
    {"CmdPushDescriptorSetWithTemplateKHR",
     "commandBuffer:u64 descriptorUpdateTemplate:u64 layout:u64 "
     "set:u32 pData:template"},
    {"CmdPushConstants", "commandBuffer:u64 layout:u64 stageFlags:u32 offset:u32 size:u32 pValues:*u8"},
    {"CmdBindVertexBuffers",
     "commandBuffer:u64 firstBinding:u32 bindingCount:u32 pBuffers:*u64 "
     "pOffsets:*u64"},
    {"CmdBindVertexBuffers2",
     "commandBuffer:u64 firstBinding:u32 bindingCount:u32 pBuffers:*u64 "
     "pOffsets:*u64 pSizes:*u64 pStrides:*u64"},
    {"CmdBindIndexBuffer", "commandBuffer:u64 buffer:u64 offset:u64 indexType:u32"},
    {"CmdSetVertexInputEXT",
     "commandBuffer:u64 vertexBindingDescriptionCount:u32 "
     "pVertexBindingDescriptions:*VertexInputBindingDescription2EXT vertexAttributeDescriptionCount:u32 "
     "pVertexAttributeDescriptions:*VertexInputAttributeDescription2EXT"},
    {"CmdDraw", "commandBuffer:u64 vertexCount:u32 instanceCount:u32 firstVertex:u32 firstInstance:u32"},
    {"CmdDrawIndexed",
     "commandBuffer:u64 indexCount:u32 instanceCount:u32 firstIndex:u32 vertexOffset:i32 "
     "firstInstance:u32"},
    {"CmdDrawIndirect", "commandBuffer:u64 buffer:u64 offset:u64 drawCount:u32 stride:u32"},
    {"CmdDrawIndexedIndirect", "commandBuffer:u64 buffer:u64 offset:u64 drawCount:u32 stride:u32"},
    {"CmdDrawIndirectCount",
     "commandBuffer:u64 buffer:u64 offset:u64 countBuffer:u64 countBufferOffset:u64 maxDrawCount:u32 "
     "stride:u32"},
    {"CmdDrawIndexedIndirectCount",
     "commandBuffer:u64 buffer:u64 offset:u64 countBuffer:u64 countBufferOffset:u64 maxDrawCount:u32 "
     "stride:u32"},
    {"CmdDrawMultiEXT",
     "commandBuffer:u64 drawCount:u32 pVertexInfo:*MultiDrawInfoEXT instanceCount:u32 "
     "firstInstance:u32 stride:u32"},
    {"CmdDrawMultiIndexedEXT",
     "commandBuffer:u64 drawCount:u32 pIndexInfo:*MultiDrawIndexedInfoEXT "
     "instanceCount:u32 firstInstance:u32 stride:u32 pVertexOffset:*i32"},
    {"CmdClearAttachments",
     "commandBuffer:u64 attachmentCount:u32 pAttachments:*ClearAttachment "
     "rectCount:u32 pRects:*ClearRect"},
    {"CmdClearColorImage",
     "commandBuffer:u64 image:u64 imageLayout:u32 pColor:*u32 rangeCount:u32 "
     "pRanges:*ImageSubresourceRange"},
    {"CmdClearDepthStencilImage",
     "commandBuffer:u64 image:u64 imageLayout:u32 "
     "pDepthStencil:*ClearDepthStencilValue rangeCount:u32 pRanges:*ImageSubresourceRange"},
    {"CmdUpdateBuffer", "commandBuffer:u64 dstBuffer:u64 dstOffset:u64 dataSize:u64 pData:*u8"},
    {"CmdFillBuffer", "commandBuffer:u64 dstBuffer:u64 dstOffset:u64 size:u64 data:u32"},
    {"CmdSetViewport", "commandBuffer:u64 firstViewport:u32 viewportCount:u32 pViewports:*Viewport"},
    {"CmdSetScissor", "commandBuffer:u64 firstScissor:u32 scissorCount:u32 pScissors:*Rect2D"},
    {"CmdSetViewportWithCount", "commandBuffer:u64 viewportCount:u32 pViewports:*Viewport"},
    {"CmdSetScissorWithCount", "commandBuffer:u64 scissorCount:u32 pScissors:*Rect2D"},
    {"CmdSetLineWidth", "commandBuffer:u64 lineWidth:f32"},
    {"CmdSetDepthBias",
     "commandBuffer:u64 depthBiasConstantFactor:f32 depthBiasClamp:f32 "
     "depthBiasSlopeFactor:f32"},
    {"CmdSetBlendConstants", "commandBuffer:u64 blendConstants:*f32"},
    {"CmdSetDepthBounds", "commandBuffer:u64 minDepthBounds:f32 maxDepthBounds:f32"},
    {"CmdSetStencilCompareMask", "commandBuffer:u64 faceMask:u32 compareMask:u32"},
    {"CmdSetStencilWriteMask", "commandBuffer:u64 faceMask:u32 writeMask:u32"},
    {"CmdSetStencilReference", "commandBuffer:u64 faceMask:u32 reference:u32"},
    {"CmdSetStencilOp", "commandBuffer:u64 faceMask:u32 failOp:u32 passOp:u32 depthFailOp:u32 compareOp:u32"},
    {"CmdSetStencilTestEnable", "commandBuffer:u64 stencilTestEnable:u32"},
    {"CmdSetCullMode", "commandBuffer:u64 cullMode:u32"},
    {"CmdSetFrontFace", "commandBuffer:u64 frontFace:u32"},
    {"CmdSetPrimitiveTopology", "commandBuffer:u64 primitiveTopology:u32"},
    {"CmdSetDepthTestEnable", "commandBuffer:u64 depthTestEnable:u32"},
    {"CmdSetDepthWriteEnable", "commandBuffer:u64 depthWriteEnable:u32"},
    {"CmdSetDepthCompareOp", "commandBuffer:u64 depthCompareOp:u32"},
    {"CmdSetDepthBoundsTestEnable", "commandBuffer:u64 depthBoundsTestEnable:u32"},
    {"CmdSetRasterizerDiscardEnable", "commandBuffer:u64 rasterizerDiscardEnable:u32"},
    {"CmdSetDepthBiasEnable", "commandBuffer:u64 depthBiasEnable:u32"},
    {"CmdSetPrimitiveRestartEnable", "commandBuffer:u64 primitiveRestartEnable:u32"},
    {"CmdSetLogicOpEXT", "commandBuffer:u64 logicOp:u32"},
    {"CmdSetPolygonModeEXT", "commandBuffer:u64 polygonMode:u32"},
    {"CmdSetDepthClampEnableEXT", "commandBuffer:u64 depthClampEnable:u32"},
    {"CmdSetDepthClipEnableEXT", "commandBuffer:u64 depthClipEnable:u32"},
    {"CmdSetDepthClipNegativeOneToOneEXT", "commandBuffer:u64 negativeOneToOne:u32"},
    {"CmdSetLogicOpEnableEXT", "commandBuffer:u64 logicOpEnable:u32"},
    {"CmdSetColorBlendEnableEXT",
     "commandBuffer:u64 firstAttachment:u32 attachmentCount:u32 "
     "pColorBlendEnables:*u32"},
    {"CmdSetColorBlendEquationEXT",
     "commandBuffer:u64 firstAttachment:u32 attachmentCount:u32 "
     "pColorBlendEquations:*ColorBlendEquationEXT"},
    {"CmdSetColorWriteMaskEXT",
     "commandBuffer:u64 firstAttachment:u32 attachmentCount:u32 "
     "pColorWriteMasks:*u32"},
    {"CmdSetColorWriteEnableEXT", "commandBuffer:u64 attachmentCount:u32 pColorWriteEnables:*u32"},
    {"CmdSetRasterizationSamplesEXT", "commandBuffer:u64 rasterizationSamples:u32"},
    {"CmdSetSampleMaskEXT", "commandBuffer:u64 samples:u32 pSampleMask:*u32"},
    {"CmdSetAlphaToCoverageEnableEXT", "commandBuffer:u64 alphaToCoverageEnable:u32"},
    {"CmdSetAlphaToOneEnableEXT", "commandBuffer:u64 alphaToOneEnable:u32"},
    {"CmdSetLineRasterizationModeEXT", "commandBuffer:u64 lineRasterizationMode:u32"},
    {"CmdSetLineStippleEnableEXT", "commandBuffer:u64 stippledLineEnable:u32"},
    {"CmdSetProvokingVertexModeEXT", "commandBuffer:u64 provokingVertexMode:u32"},
    {"CmdBeginDebugUtilsLabelEXT", "commandBuffer:u64 pLabelInfo:*DebugUtilsLabelEXT"},
    {"CmdEndDebugUtilsLabelEXT", "commandBuffer:u64"},
    {"CmdInsertDebugUtilsLabelEXT", "commandBuffer:u64 pLabelInfo:*DebugUtilsLabelEXT"},
};
// clang-format on

}  // namespace

std::span<const SchemaRow> call_rows() { return kCalls; }

}  // namespace quadrille::capture
