/// The Vulkan instance, device and queue, and the few allocations everything else is made of.
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tests/lavapipe/vulkan_renderer.h"

namespace quadrille::lavapipe {

/// Throws `UserError` naming `what` unless `result` is VK_SUCCESS.
void require(VkResult result, const char* what);

/// Runs its actions last to first when destroyed: Vulkan objects die before what they were made from.
class Cleanup {
 public:
  Cleanup() = default;
  ~Cleanup();
  Cleanup(const Cleanup&) = delete;
  Cleanup& operator=(const Cleanup&) = delete;
  void add(std::function<void()> action) { actions_.push_back(std::move(action)); }

 private:
  std::vector<std::function<void()>> actions_;
};

struct HostBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  void* mapped = nullptr;  ///< host-visible and coherent for as long as the buffer lives
};

/// Which of the devices to open.
struct DeviceWish {
  enum class Kind : std::uint8_t {
    kLavapipe,  ///< the software driver before any other, and drivers of GPUs not opened at all
    kGpu,       ///< a GPU, discrete before others; never a software driver
    kNamed      ///< the one with `name` in its name
  };
  Kind kind = Kind::kLavapipe;
  std::string name{};     ///< of `kNamed`: part of a device's name, in any case of letters
  bool validate = false;  ///< under the Khronos validation layer
};

class VulkanDevice {
 public:
  /// Throws `UserError` when there is no driver, no device as wished, or none with Vulkan 1.3.
  explicit VulkanDevice(const DeviceWish& wish);

  [[nodiscard]] VkDevice handle() const { return device_; }
  [[nodiscard]] const DeviceInfo& info() const { return info_; }
  [[nodiscard]] const std::vector<std::string>& messages() const { return messages_; }

  /// Can shaders sample images of this format?
  [[nodiscard]] bool samples(VkFormat format) const;

  /// A buffer of at least `bytes` (and never none) that lives until `owner` ends.
  [[nodiscard]] HostBuffer buffer(Cleanup& owner, VkDeviceSize bytes, VkBufferUsageFlags usage) const;
  /// A buffer in the device's own memory that holds `data`.
  [[nodiscard]] VkBuffer device_buffer(Cleanup& owner, std::span<const std::byte> data,
                                       VkBufferUsageFlags usage) const;
  struct ImageWish {
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D size{};
    std::uint32_t levels = 1, layers = 1, samples = 1;
    VkImageUsageFlags usage = 0;
    VkImageType type = VK_IMAGE_TYPE_2D;
    std::uint32_t depth = 1;
    bool may_be_cube = false;
  };
  /// An image that lives until `owner` ends.
  [[nodiscard]] VkImage image(Cleanup& owner, const ImageWish& wish) const;
  /// A view of some of its levels and layers.
  [[nodiscard]] VkImageView view(Cleanup& owner, VkImage image, VkFormat format, VkImageViewType type,
                                 const VkImageSubresourceRange& range,
                                 const VkComponentMapping& components = {}) const;
  /// A command buffer in the recording state that lives until `owner` ends.
  [[nodiscard]] VkCommandBuffer begin_commands(Cleanup& owner) const;
  /// Submits and waits. `commands` must have been ended.
  void submit(VkCommandBuffer commands) const;

 private:
  void create_instance(bool validate);
  void choose_physical_device(const DeviceWish& wish);
  void choose_queue_family();
  void create_device();
  struct BoundBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
  };
  [[nodiscard]] BoundBuffer create_buffer(Cleanup& owner, VkDeviceSize bytes, VkBufferUsageFlags usage,
                                          VkMemoryPropertyFlags properties) const;
  [[nodiscard]] VkDeviceMemory allocate(Cleanup& owner, const VkMemoryRequirements& needs,
                                        VkMemoryPropertyFlags properties) const;

  Cleanup cleanup_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::uint32_t family_ = 0;
  DeviceInfo info_;
  std::vector<std::string> messages_;
};

}  // namespace quadrille::lavapipe
