#include "tests/lavapipe/vulkan_features.h"

#include <cstdint>

#include "tests/lavapipe/vulkan_device.h"

namespace quadrille::lavapipe {
namespace {

std::set<std::string> device_extensions(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  require(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr),
          "vkEnumerateDeviceExtensionProperties");
  std::vector<VkExtensionProperties> found(count);
  require(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, found.data()),
          "vkEnumerateDeviceExtensionProperties");
  std::set<std::string> names;
  for (const auto& extension : found) names.emplace(extension.extensionName);
  return names;
}

/// Which features of the structure the device has.
template <class Structure>
void ask(VkPhysicalDevice physical, Structure& structure) {
  VkPhysicalDeviceFeatures2 query{};
  query.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  query.pNext = &structure;
  vkGetPhysicalDeviceFeatures2(physical, &query);
}

}  // namespace

DeviceFeatures::DeviceFeatures(VkPhysicalDevice physical) {
  const std::set<std::string> present = device_extensions(physical);
  features_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  vulkan13_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  vulkan13_.dynamicRendering = VK_TRUE;
  add_lines(physical, present);
  add_borders(physical, present);
  if (present.contains(VK_EXT_INDEX_TYPE_UINT8_EXTENSION_NAME)) {
    extensions_.push_back(VK_EXT_INDEX_TYPE_UINT8_EXTENSION_NAME);
    u8_indices_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_INDEX_TYPE_UINT8_FEATURES_EXT;
    u8_indices_.indexTypeUint8 = VK_TRUE;
    link(u8_indices_);
  }
  for (const char* const name : {VK_EXT_SHADER_VIEWPORT_INDEX_LAYER_EXTENSION_NAME,
                                 VK_KHR_SAMPLER_MIRROR_CLAMP_TO_EDGE_EXTENSION_NAME})
    if (present.contains(name)) extensions_.push_back(name);
  link(vulkan13_);
  add_core(physical);
}

void DeviceFeatures::add_lines(VkPhysicalDevice physical, const std::set<std::string>& present) {
  if (!present.contains(VK_EXT_LINE_RASTERIZATION_EXTENSION_NAME)) return;
  lines_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_LINE_RASTERIZATION_FEATURES_EXT;
  ask(physical, lines_);
  extensions_.push_back(VK_EXT_LINE_RASTERIZATION_EXTENSION_NAME);
  line_modes_ = lines_.bresenhamLines == VK_TRUE && lines_.rectangularLines == VK_TRUE;
  if (line_modes_) link(lines_);
}

void DeviceFeatures::add_borders(VkPhysicalDevice physical, const std::set<std::string>& present) {
  if (!present.contains(VK_EXT_CUSTOM_BORDER_COLOR_EXTENSION_NAME)) return;
  borders_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CUSTOM_BORDER_COLOR_FEATURES_EXT;
  ask(physical, borders_);
  own_borders_ = borders_.customBorderColors == VK_TRUE && borders_.customBorderColorWithoutFormat == VK_TRUE;
  if (!own_borders_) return;
  extensions_.push_back(VK_EXT_CUSTOM_BORDER_COLOR_EXTENSION_NAME);
  link(borders_);
}

void DeviceFeatures::add_core(VkPhysicalDevice physical) {
  VkPhysicalDeviceFeatures present{};
  vkGetPhysicalDeviceFeatures(physical, &present);
  features_.features.depthClamp = present.depthClamp;
  features_.features.depthBiasClamp = present.depthBiasClamp;
  features_.features.depthBounds = present.depthBounds;
  features_.features.dualSrcBlend = present.dualSrcBlend;
  features_.features.logicOp = present.logicOp;
  features_.features.fillModeNonSolid = present.fillModeNonSolid;
  features_.features.wideLines = present.wideLines;
  features_.features.largePoints = present.largePoints;
  features_.features.shaderClipDistance = present.shaderClipDistance;
  features_.features.shaderCullDistance = present.shaderCullDistance;
  features_.features.sampleRateShading = present.sampleRateShading;
  features_.features.textureCompressionBC = present.textureCompressionBC;
  features_.features.independentBlend = present.independentBlend;  // attachments that are blended otherwise
  features_.features.multiViewport = present.multiViewport;
  features_.features.geometryShader = present.geometryShader;  // gl_PrimitiveID in a fragment shader
  features_.features.imageCubeArray = present.imageCubeArray;
  features_.features.samplerAnisotropy = present.samplerAnisotropy;
  features_.features.shaderImageGatherExtended = present.shaderImageGatherExtended;
  features_.features.robustBufferAccess = present.robustBufferAccess;
  features_.features.shaderSampledImageArrayDynamicIndexing = present.shaderSampledImageArrayDynamicIndexing;
  features_.features.shaderUniformBufferArrayDynamicIndexing =
      present.shaderUniformBufferArrayDynamicIndexing;
  features_.features.shaderStorageBufferArrayDynamicIndexing =
      present.shaderStorageBufferArrayDynamicIndexing;
  features_.features.fragmentStoresAndAtomics = present.fragmentStoresAndAtomics;
  features_.features.vertexPipelineStoresAndAtomics = present.vertexPipelineStoresAndAtomics;
  features_.features.pipelineStatisticsQuery = present.pipelineStatisticsQuery;
  features_.features.occlusionQueryPrecise = present.occlusionQueryPrecise;
}

}  // namespace quadrille::lavapipe
