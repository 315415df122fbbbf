/// Names of calls by their numbers, as gfxreconstruct's convert tool names them. [GFXR #call-ids]
#include <array>
#include <map>

#include "traces/capture/schema.h"

namespace quadrille::capture {
namespace {

constexpr std::uint32_t kVulkan = 0x10000;  // the API, in the upper half of a number

/// Calls whose numbers follow each other.
struct Run {
  std::uint32_t first;
  std::string_view names;
};
// clang-format off: names fill their lines
constexpr Run kRuns[] = {
    {0x1000,
     "CreateInstance DestroyInstance EnumeratePhysicalDevices GetPhysicalDeviceFeatures "
     "GetPhysicalDeviceFormatProperties GetPhysicalDeviceImageFormatProperties GetPhysicalDeviceProperties "
     "GetPhysicalDeviceQueueFamilyProperties GetPhysicalDeviceMemoryProperties"},
    {0x100b, "CreateDevice DestroyDevice"},
    {0x1011,
     "GetDeviceQueue QueueSubmit QueueWaitIdle DeviceWaitIdle AllocateMemory FreeMemory MapMemory "
     "UnmapMemory FlushMappedMemoryRanges InvalidateMappedMemoryRanges GetDeviceMemoryCommitment "
     "BindBufferMemory BindImageMemory GetBufferMemoryRequirements GetImageMemoryRequirements "
     "GetImageSparseMemoryRequirements GetPhysicalDeviceSparseImageFormatProperties QueueBindSparse "
     "CreateFence DestroyFence ResetFences GetFenceStatus WaitForFences CreateSemaphore DestroySemaphore "
     "CreateEvent DestroyEvent GetEventStatus SetEvent ResetEvent CreateQueryPool DestroyQueryPool "
     "GetQueryPoolResults CreateBuffer DestroyBuffer CreateBufferView DestroyBufferView CreateImage "
     "DestroyImage GetImageSubresourceLayout CreateImageView DestroyImageView CreateShaderModule "
     "DestroyShaderModule CreatePipelineCache DestroyPipelineCache GetPipelineCacheData MergePipelineCaches "
     "CreateGraphicsPipelines CreateComputePipelines DestroyPipeline CreatePipelineLayout "
     "DestroyPipelineLayout CreateSampler DestroySampler CreateDescriptorSetLayout "
     "DestroyDescriptorSetLayout CreateDescriptorPool DestroyDescriptorPool ResetDescriptorPool "
     "AllocateDescriptorSets FreeDescriptorSets UpdateDescriptorSets CreateFramebuffer DestroyFramebuffer "
     "CreateRenderPass DestroyRenderPass GetRenderAreaGranularity CreateCommandPool DestroyCommandPool "
     "ResetCommandPool AllocateCommandBuffers FreeCommandBuffers BeginCommandBuffer EndCommandBuffer "
     "ResetCommandBuffer CmdBindPipeline CmdSetViewport CmdSetScissor CmdSetLineWidth CmdSetDepthBias "
     "CmdSetBlendConstants CmdSetDepthBounds CmdSetStencilCompareMask CmdSetStencilWriteMask "
     "CmdSetStencilReference CmdBindDescriptorSets CmdBindIndexBuffer CmdBindVertexBuffers CmdDraw "
     "CmdDrawIndexed CmdDrawIndirect CmdDrawIndexedIndirect CmdDispatch CmdDispatchIndirect CmdCopyBuffer "
     "CmdCopyImage CmdBlitImage CmdCopyBufferToImage CmdCopyImageToBuffer CmdUpdateBuffer CmdFillBuffer "
     "CmdClearColorImage CmdClearDepthStencilImage CmdClearAttachments CmdResolveImage CmdSetEvent "
     "CmdResetEvent CmdWaitEvents CmdPipelineBarrier CmdBeginQuery CmdEndQuery CmdResetQueryPool "
     "CmdWriteTimestamp CmdCopyQueryPoolResults CmdPushConstants CmdBeginRenderPass CmdNextSubpass "
     "CmdEndRenderPass CmdExecuteCommands"},
    {0x108a,
     "BindBufferMemory2 BindImageMemory2 GetDeviceGroupPeerMemoryFeatures CmdSetDeviceMask "
     "CmdDispatchBase EnumeratePhysicalDeviceGroups GetImageMemoryRequirements2 GetBufferMemoryRequirements2 "
     "GetImageSparseMemoryRequirements2 GetPhysicalDeviceFeatures2 GetPhysicalDeviceProperties2 "
     "GetPhysicalDeviceFormatProperties2 GetPhysicalDeviceImageFormatProperties2 "
     "GetPhysicalDeviceQueueFamilyProperties2 GetPhysicalDeviceMemoryProperties2 "
     "GetPhysicalDeviceSparseImageFormatProperties2 TrimCommandPool GetDeviceQueue2 "
     "CreateSamplerYcbcrConversion DestroySamplerYcbcrConversion CreateDescriptorUpdateTemplate "
     "DestroyDescriptorUpdateTemplate UpdateDescriptorSetWithTemplate "
     "GetPhysicalDeviceExternalBufferProperties GetPhysicalDeviceExternalFenceProperties "
     "GetPhysicalDeviceExternalSemaphoreProperties GetDescriptorSetLayoutSupport DestroySurfaceKHR "
     "GetPhysicalDeviceSurfaceSupportKHR GetPhysicalDeviceSurfaceCapabilitiesKHR "
     "GetPhysicalDeviceSurfaceFormatsKHR GetPhysicalDeviceSurfacePresentModesKHR CreateSwapchainKHR "
     "DestroySwapchainKHR GetSwapchainImagesKHR AcquireNextImageKHR QueuePresentKHR "
     "GetDeviceGroupPresentCapabilitiesKHR GetDeviceGroupSurfacePresentModesKHR "
     "GetPhysicalDevicePresentRectanglesKHR AcquireNextImage2KHR GetPhysicalDeviceDisplayPropertiesKHR "
     "GetPhysicalDeviceDisplayPlanePropertiesKHR GetDisplayPlaneSupportedDisplaysKHR "
     "GetDisplayModePropertiesKHR CreateDisplayModeKHR GetDisplayPlaneCapabilitiesKHR "
     "CreateDisplayPlaneSurfaceKHR CreateSharedSwapchainsKHR CreateXlibSurfaceKHR "
     "GetPhysicalDeviceXlibPresentationSupportKHR CreateXcbSurfaceKHR "
     "GetPhysicalDeviceXcbPresentationSupportKHR CreateWaylandSurfaceKHR "
     "GetPhysicalDeviceWaylandPresentationSupportKHR"},
    {0x10c3,
     "CreateAndroidSurfaceKHR CreateWin32SurfaceKHR GetPhysicalDeviceWin32PresentationSupportKHR "
     "GetPhysicalDeviceFeatures2KHR GetPhysicalDeviceProperties2KHR GetPhysicalDeviceFormatProperties2KHR "
     "GetPhysicalDeviceImageFormatProperties2KHR GetPhysicalDeviceQueueFamilyProperties2KHR "
     "GetPhysicalDeviceMemoryProperties2KHR GetPhysicalDeviceSparseImageFormatProperties2KHR "
     "GetDeviceGroupPeerMemoryFeaturesKHR CmdSetDeviceMaskKHR CmdDispatchBaseKHR TrimCommandPoolKHR "
     "EnumeratePhysicalDeviceGroupsKHR GetPhysicalDeviceExternalBufferPropertiesKHR GetMemoryWin32HandleKHR "
     "GetMemoryWin32HandlePropertiesKHR GetMemoryFdKHR GetMemoryFdPropertiesKHR "
     "GetPhysicalDeviceExternalSemaphorePropertiesKHR ImportSemaphoreWin32HandleKHR "
     "GetSemaphoreWin32HandleKHR ImportSemaphoreFdKHR GetSemaphoreFdKHR CmdPushDescriptorSetKHR "
     "CmdPushDescriptorSetWithTemplateKHR CreateDescriptorUpdateTemplateKHR "
     "DestroyDescriptorUpdateTemplateKHR UpdateDescriptorSetWithTemplateKHR CreateRenderPass2KHR "
     "CmdBeginRenderPass2KHR CmdNextSubpass2KHR CmdEndRenderPass2KHR GetSwapchainStatusKHR "
     "GetPhysicalDeviceExternalFencePropertiesKHR ImportFenceWin32HandleKHR GetFenceWin32HandleKHR "
     "ImportFenceFdKHR GetFenceFdKHR GetPhysicalDeviceSurfaceCapabilities2KHR "
     "GetPhysicalDeviceSurfaceFormats2KHR GetPhysicalDeviceDisplayProperties2KHR "
     "GetPhysicalDeviceDisplayPlaneProperties2KHR GetDisplayModeProperties2KHR "
     "GetDisplayPlaneCapabilities2KHR GetImageMemoryRequirements2KHR GetBufferMemoryRequirements2KHR "
     "GetImageSparseMemoryRequirements2KHR CreateSamplerYcbcrConversionKHR DestroySamplerYcbcrConversionKHR "
     "BindBufferMemory2KHR BindImageMemory2KHR GetDescriptorSetLayoutSupportKHR CmdDrawIndirectCountKHR "
     "CmdDrawIndexedIndirectCountKHR CreateDebugReportCallbackEXT DestroyDebugReportCallbackEXT "
     "DebugReportMessageEXT DebugMarkerSetObjectTagEXT DebugMarkerSetObjectNameEXT CmdDebugMarkerBeginEXT "
     "CmdDebugMarkerEndEXT CmdDebugMarkerInsertEXT CmdDrawIndirectCountAMD CmdDrawIndexedIndirectCountAMD "
     "GetShaderInfoAMD GetPhysicalDeviceExternalImageFormatPropertiesNV GetMemoryWin32HandleNV "
     "CreateViSurfaceNN CmdBeginConditionalRenderingEXT CmdEndConditionalRenderingEXT"},
    {0x1114,
     "CmdSetViewportWScalingNV ReleaseDisplayEXT AcquireXlibDisplayEXT GetRandROutputDisplayEXT "
     "GetPhysicalDeviceSurfaceCapabilities2EXT DisplayPowerControlEXT RegisterDeviceEventEXT "
     "RegisterDisplayEventEXT GetSwapchainCounterEXT GetRefreshCycleDurationGOOGLE "
     "GetPastPresentationTimingGOOGLE CmdSetDiscardRectangleEXT SetHdrMetadataEXT CreateIOSSurfaceMVK "
     "CreateMacOSSurfaceMVK SetDebugUtilsObjectNameEXT SetDebugUtilsObjectTagEXT "
     "QueueBeginDebugUtilsLabelEXT QueueEndDebugUtilsLabelEXT QueueInsertDebugUtilsLabelEXT "
     "CmdBeginDebugUtilsLabelEXT CmdEndDebugUtilsLabelEXT CmdInsertDebugUtilsLabelEXT "
     "CreateDebugUtilsMessengerEXT DestroyDebugUtilsMessengerEXT SubmitDebugUtilsMessageEXT "
     "GetAndroidHardwareBufferPropertiesANDROID GetMemoryAndroidHardwareBufferANDROID "
     "CmdSetSampleLocationsEXT GetPhysicalDeviceMultisamplePropertiesEXT CreateValidationCacheEXT "
     "DestroyValidationCacheEXT MergeValidationCachesEXT GetValidationCacheDataEXT "
     "GetMemoryHostPointerPropertiesEXT CmdWriteBufferMarkerAMD CmdBindShadingRateImageNV "
     "CmdSetViewportShadingRatePaletteNV CmdSetCoarseSampleOrderNV GetImageDrmFormatModifierPropertiesEXT "
     "CreateAccelerationStructureNV DestroyAccelerationStructureNV "
     "GetAccelerationStructureMemoryRequirementsNV BindAccelerationStructureMemoryNV "
     "CmdBuildAccelerationStructureNV CmdCopyAccelerationStructureNV CmdTraceRaysNV "
     "CreateRayTracingPipelinesNV GetRayTracingShaderGroupHandlesNV GetAccelerationStructureHandleNV "
     "CmdWriteAccelerationStructuresPropertiesNV CompileDeferredNV CmdDrawMeshTasksNV "
     "CmdDrawMeshTasksIndirectNV CmdDrawMeshTasksIndirectCountNV CmdSetExclusiveScissorNV CmdSetCheckpointNV "
     "GetQueueCheckpointDataNV CreateImagePipeSurfaceFUCHSIA CmdBindTransformFeedbackBuffersEXT "
     "CmdBeginTransformFeedbackEXT CmdEndTransformFeedbackEXT CmdBeginQueryIndexedEXT CmdEndQueryIndexedEXT "
     "CmdDrawIndirectByteCountEXT GetPhysicalDeviceCalibrateableTimeDomainsEXT GetCalibratedTimestampsEXT "
     "GetBufferDeviceAddressEXT GetPhysicalDeviceCooperativeMatrixPropertiesNV GetImageViewHandleNVX "
     "CreateMetalSurfaceEXT CreateStreamDescriptorSurfaceGGP SetLocalDimmingAMD "
     "GetPhysicalDeviceSupportedFramebufferMixedSamplesCombinationsNV "
     "GetPhysicalDeviceSurfacePresentModes2EXT AcquireFullScreenExclusiveModeEXT "
     "ReleaseFullScreenExclusiveModeEXT GetDeviceGroupSurfacePresentModes2EXT CreateHeadlessSurfaceEXT "
     "ResetQueryPoolEXT GetPipelineExecutablePropertiesKHR GetPipelineExecutableStatisticsKHR "
     "GetPipelineExecutableInternalRepresentationsKHR InitializePerformanceApiINTEL "
     "UninitializePerformanceApiINTEL CmdSetPerformanceMarkerINTEL CmdSetPerformanceStreamMarkerINTEL "
     "CmdSetPerformanceOverrideINTEL AcquirePerformanceConfigurationINTEL "
     "ReleasePerformanceConfigurationINTEL QueueSetPerformanceConfigurationINTEL "
     "GetPerformanceParameterINTEL CmdSetLineStippleEXT GetSemaphoreCounterValueKHR WaitSemaphoresKHR "
     "SignalSemaphoreKHR EnumeratePhysicalDeviceQueueFamilyPerformanceQueryCountersKHR "
     "GetPhysicalDeviceQueueFamilyPerformanceQueryPassesKHR AcquireProfilingLockKHR ReleaseProfilingLockKHR "
     "GetBufferDeviceAddressKHR GetBufferOpaqueCaptureAddressKHR GetDeviceMemoryOpaqueCaptureAddressKHR "
     "GetPhysicalDeviceToolPropertiesEXT CmdDrawIndirectCount CmdDrawIndexedIndirectCount CreateRenderPass2 "
     "CmdBeginRenderPass2 CmdNextSubpass2 CmdEndRenderPass2 ResetQueryPool GetSemaphoreCounterValue "
     "WaitSemaphores SignalSemaphore GetBufferDeviceAddress GetBufferOpaqueCaptureAddress "
     "GetDeviceMemoryOpaqueCaptureAddress CreateDeferredOperationKHR DestroyDeferredOperationKHR "
     "GetDeferredOperationMaxConcurrencyKHR GetDeferredOperationResultKHR DeferredOperationJoinKHR "
     "CreateAccelerationStructureKHR DestroyAccelerationStructureKHR"},
    {0x1192, "CmdBuildAccelerationStructuresKHR CmdBuildAccelerationStructuresIndirectKHR"},
    {0x1196,
     "CopyAccelerationStructureToMemoryKHR CopyMemoryToAccelerationStructureKHR "
     "WriteAccelerationStructuresPropertiesKHR CmdCopyAccelerationStructureKHR "
     "CmdCopyAccelerationStructureToMemoryKHR CmdCopyMemoryToAccelerationStructureKHR CmdTraceRaysKHR "
     "CreateRayTracingPipelinesKHR GetRayTracingShaderGroupHandlesKHR "
     "CmdWriteAccelerationStructuresPropertiesKHR"},
    {0x1200,
     "GetAccelerationStructureDeviceAddressKHR GetRayTracingCaptureReplayShaderGroupHandlesKHR "
     "CmdTraceRaysIndirectKHR GetDeviceAccelerationStructureCompatibilityKHR "
     "GetGeneratedCommandsMemoryRequirementsNV CmdPreprocessGeneratedCommandsNV "
     "CmdExecuteGeneratedCommandsNV CmdBindPipelineShaderGroupNV CreateIndirectCommandsLayoutNV "
     "DestroyIndirectCommandsLayoutNV GetImageViewAddressNVX CreatePrivateDataSlotEXT "
     "DestroyPrivateDataSlotEXT SetPrivateDataEXT GetPrivateDataEXT CmdSetCullModeEXT CmdSetFrontFaceEXT "
     "CmdSetPrimitiveTopologyEXT CmdSetViewportWithCountEXT CmdSetScissorWithCountEXT "
     "CmdBindVertexBuffers2EXT CmdSetDepthTestEnableEXT CmdSetDepthWriteEnableEXT CmdSetDepthCompareOpEXT "
     "CmdSetDepthBoundsTestEnableEXT CmdSetStencilTestEnableEXT CmdSetStencilOpEXT CreateDirectFBSurfaceEXT "
     "GetPhysicalDeviceDirectFBPresentationSupportEXT CmdCopyBuffer2KHR CmdCopyImage2KHR "
     "CmdCopyBufferToImage2KHR CmdCopyImageToBuffer2KHR CmdBlitImage2KHR CmdResolveImage2KHR "
     "GetAccelerationStructureBuildSizesKHR GetRayTracingShaderGroupStackSizeKHR "
     "CmdSetRayTracingPipelineStackSizeKHR GetPhysicalDeviceFragmentShadingRatesKHR "
     "CmdSetFragmentShadingRateKHR CmdSetFragmentShadingRateEnumNV AcquireWinrtDisplayNV GetWinrtDisplayNV "
     "CmdSetEvent2KHR CmdResetEvent2KHR CmdWaitEvents2KHR CmdPipelineBarrier2KHR CmdWriteTimestamp2KHR "
     "QueueSubmit2KHR CmdWriteBufferMarker2AMD GetQueueCheckpointData2NV CmdSetVertexInputEXT "
     "GetMemoryZirconHandleFUCHSIA GetMemoryZirconHandlePropertiesFUCHSIA ImportSemaphoreZirconHandleFUCHSIA "
     "GetSemaphoreZirconHandleFUCHSIA CmdSetPatchControlPointsEXT CmdSetRasterizerDiscardEnableEXT "
     "CmdSetDepthBiasEnableEXT CmdSetLogicOpEXT CmdSetPrimitiveRestartEnableEXT CreateScreenSurfaceQNX "
     "GetPhysicalDeviceScreenPresentationSupportQNX CmdSetColorWriteEnableEXT AcquireDrmDisplayEXT "
     "GetDrmDisplayEXT CmdDrawMultiEXT CmdDrawMultiIndexedEXT WaitForPresentKHR CmdBindInvocationMaskHUAWEI "
     "GetMemoryRemoteAddressNV GetDeviceBufferMemoryRequirementsKHR GetDeviceImageMemoryRequirementsKHR "
     "GetDeviceImageSparseMemoryRequirementsKHR SetDeviceMemoryPriorityEXT CmdBeginRenderingKHR "
     "CmdEndRenderingKHR GetPhysicalDeviceToolProperties CreatePrivateDataSlot DestroyPrivateDataSlot "
     "SetPrivateData GetPrivateData CmdSetEvent2 CmdResetEvent2 CmdWaitEvents2 CmdPipelineBarrier2 "
     "CmdWriteTimestamp2 QueueSubmit2 CmdCopyBuffer2 CmdCopyImage2 CmdCopyBufferToImage2 "
     "CmdCopyImageToBuffer2 CmdBlitImage2 CmdResolveImage2 CmdBeginRendering CmdEndRendering CmdSetCullMode "
     "CmdSetFrontFace CmdSetPrimitiveTopology CmdSetViewportWithCount CmdSetScissorWithCount "
     "CmdBindVertexBuffers2 CmdSetDepthTestEnable CmdSetDepthWriteEnable CmdSetDepthCompareOp "
     "CmdSetDepthBoundsTestEnable CmdSetStencilTestEnable CmdSetStencilOp CmdSetRasterizerDiscardEnable "
     "CmdSetDepthBiasEnable CmdSetPrimitiveRestartEnable GetDeviceBufferMemoryRequirements "
     "GetDeviceImageMemoryRequirements GetDeviceImageSparseMemoryRequirements "
     "GetDescriptorSetLayoutHostMappingInfoVALVE GetDescriptorSetHostMappingVALVE CmdTraceRaysIndirect2KHR "
     "GetImageSubresourceLayout2EXT"},
    {0x1277,
     "GetShaderModuleIdentifierEXT GetShaderModuleCreateInfoIdentifierEXT "
     "GetFramebufferTilePropertiesQCOM GetDynamicRenderingTilePropertiesQCOM GetDeviceFaultInfoEXT "
     "CreateMicromapEXT DestroyMicromapEXT CmdBuildMicromapsEXT BuildMicromapsEXT CopyMicromapEXT "
     "CopyMicromapToMemoryEXT CopyMemoryToMicromapEXT WriteMicromapsPropertiesEXT CmdCopyMicromapEXT "
     "CmdCopyMicromapToMemoryEXT CmdCopyMemoryToMicromapEXT CmdWriteMicromapsPropertiesEXT "
     "GetDeviceMicromapCompatibilityEXT GetMicromapBuildSizesEXT CmdSetTessellationDomainOriginEXT "
     "CmdSetDepthClampEnableEXT CmdSetPolygonModeEXT CmdSetRasterizationSamplesEXT CmdSetSampleMaskEXT "
     "CmdSetAlphaToCoverageEnableEXT CmdSetAlphaToOneEnableEXT CmdSetLogicOpEnableEXT "
     "CmdSetColorBlendEnableEXT CmdSetColorBlendEquationEXT CmdSetColorWriteMaskEXT "
     "CmdSetRasterizationStreamEXT CmdSetConservativeRasterizationModeEXT "
     "CmdSetExtraPrimitiveOverestimationSizeEXT CmdSetDepthClipEnableEXT CmdSetSampleLocationsEnableEXT "
     "CmdSetColorBlendAdvancedEXT CmdSetProvokingVertexModeEXT CmdSetLineRasterizationModeEXT "
     "CmdSetLineStippleEnableEXT CmdSetDepthClipNegativeOneToOneEXT CmdSetViewportWScalingEnableNV "
     "CmdSetViewportSwizzleNV CmdSetCoverageToColorEnableNV CmdSetCoverageToColorLocationNV "
     "CmdSetCoverageModulationModeNV CmdSetCoverageModulationTableEnableNV CmdSetCoverageModulationTableNV "
     "CmdSetShadingRateImageEnableNV CmdSetRepresentativeFragmentTestEnableNV CmdSetCoverageReductionModeNV "
     "GetPhysicalDeviceOpticalFlowImageFormatsNV CreateOpticalFlowSessionNV DestroyOpticalFlowSessionNV "
     "BindOpticalFlowSessionImageNV CmdOpticalFlowExecuteNV CmdDrawMeshTasksEXT CmdDrawMeshTasksIndirectEXT "
     "CmdDrawMeshTasksIndirectCountEXT ReleaseSwapchainImagesEXT CmdDrawClusterHUAWEI "
     "CmdDrawClusterIndirectHUAWEI"},
};
// clang-format on

std::map<std::uint32_t, std::string_view> numbered_names() {
  std::map<std::uint32_t, std::string_view> names;
  for (const Run& run : kRuns) {
    std::uint32_t number = run.first;
    for (std::size_t at = 0; at < run.names.size();) {
      const std::size_t end = std::min(run.names.find(' ', at), run.names.size());
      names[number++] = run.names.substr(at, end - at);
      at = end + 1;
    }
  }
  return names;
}

}  // namespace

std::string_view call_name(std::uint32_t id) {
  static const std::map<std::uint32_t, std::string_view> kNames = numbered_names();
  const auto found = kNames.find(id & 0xffff);
  return (id & ~0xffffu) != kVulkan || found == kNames.end() ? std::string_view{} : found->second;
}

}  // namespace quadrille::capture
