/// The features and extensions that frames use, as far as a device has them.
#pragma once

#include <vulkan/vulkan.h>

#include <set>
#include <string>
#include <vector>

namespace quadrille::lavapipe {

class DeviceFeatures {
 public:
  explicit DeviceFeatures(VkPhysicalDevice physical);
  DeviceFeatures(const DeviceFeatures&) = delete;
  DeviceFeatures& operator=(const DeviceFeatures&) = delete;

  /// VkPhysicalDeviceFeatures2 and what follows it, for the creation of a device.
  [[nodiscard]] const void* chain() const { return &features_; }
  [[nodiscard]] const std::vector<const char*>& extensions() const { return extensions_; }
  [[nodiscard]] bool line_modes() const { return line_modes_; }    ///< how lines become pixels can be chosen
  [[nodiscard]] bool own_borders() const { return own_borders_; }  ///< borders may have any colour

 private:
  void add_lines(VkPhysicalDevice physical, const std::set<std::string>& present);
  void add_borders(VkPhysicalDevice physical, const std::set<std::string>& present);
  void add_core(VkPhysicalDevice physical);
  /// Puts a structure at the front of the chain behind the first.
  template <class Structure>
  void link(Structure& structure) {
    structure.pNext = features_.pNext;
    features_.pNext = &structure;
  }

  VkPhysicalDeviceFeatures2 features_{};
  VkPhysicalDeviceVulkan13Features vulkan13_{};
  VkPhysicalDeviceIndexTypeUint8FeaturesEXT u8_indices_{};
  VkPhysicalDeviceLineRasterizationFeaturesEXT lines_{};
  VkPhysicalDeviceCustomBorderColorFeaturesEXT borders_{};
  std::vector<const char*> extensions_;
  bool line_modes_ = false, own_borders_ = false;
};

}  // namespace quadrille::lavapipe
