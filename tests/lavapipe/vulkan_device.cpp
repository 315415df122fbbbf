/// Opening a headless Vulkan device: instance, the physical device to use, its features, and memory.
#include "tests/lavapipe/vulkan_device.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <string_view>

#include "models/base/error.h"
#include "tests/lavapipe/vulkan_features.h"

namespace quadrille::lavapipe {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

/// Names lavapipe's driver manifest to the loader, so that drivers of absent GPUs are not opened. Does
/// nothing if the user chose drivers.
void prefer_lavapipe() {
  if (std::getenv("VK_ICD_FILENAMES") != nullptr || std::getenv("VK_DRIVER_FILES") != nullptr) return;
  for (const char* folder :
       {"/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/usr/share/vulkan/icd.d"}) {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
      if (!entry.path().filename().string().starts_with("lvp_icd")) continue;
      ::setenv("VK_ICD_FILENAMES", entry.path().c_str(), 0);
      return;
    }
  }
}

VKAPI_ATTR VkBool32 VKAPI_CALL collect_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                               VkDebugUtilsMessageTypeFlagsEXT,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  static_cast<std::vector<std::string>*>(user)->emplace_back(data->pMessage);
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(std::vector<std::string>* messages) {
  VkDebugUtilsMessengerCreateInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType =
      VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
  info.pfnUserCallback = collect_message;
  info.pUserData = messages;
  return info;
}

const char* type_name(VkPhysicalDeviceType type) {
  if (type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU) return "discrete GPU";
  if (type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU) return "integrated GPU";
  if (type == VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU) return "virtual GPU";
  if (type == VK_PHYSICAL_DEVICE_TYPE_CPU) return "cpu";
  return "other";
}

DeviceInfo describe(VkPhysicalDevice device) {
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &driver;
  vkGetPhysicalDeviceProperties2(device, &properties);
  const VkPhysicalDeviceLimits& limits = properties.properties.limits;
  VkPhysicalDeviceFeatures features{};
  vkGetPhysicalDeviceFeatures(device, &features);
  const std::uint32_t api = properties.properties.apiVersion;
  return {.name = properties.properties.deviceName,
          .driver = fmt::format("{}: {}", driver.driverName, driver.driverInfo),
          .subpixel_bits = limits.subPixelPrecisionBits,
          .subtexel_bits = limits.subTexelPrecisionBits,
          .mipmap_bits = limits.mipmapPrecisionBits,
          .max_push_constants = limits.maxPushConstantsSize,
          .type = type_name(properties.properties.deviceType),
          .api_version = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(api), VK_API_VERSION_MINOR(api),
                                     VK_API_VERSION_PATCH(api)),
          .pipeline_statistics = features.pipelineStatisticsQuery == VK_TRUE,
          .precise_occlusion = features.occlusionQueryPrecise == VK_TRUE,
          .timestamp_bits = 0,  // of a queue: filled in with its choice
          .timestamp_ns = limits.timestampPeriod};
}

std::string lower(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

/// Among devices as wished, the highest is opened; the first of equals. 0: not as wished.
int rank(const VkPhysicalDeviceProperties& device, const DeviceWish& wish) {
  switch (wish.kind) {
    case DeviceWish::Kind::kLavapipe: return device.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU ? 2 : 1;
    case DeviceWish::Kind::kNamed:
      return lower(device.deviceName).find(lower(wish.name)) == std::string::npos ? 0 : 1;
    case DeviceWish::Kind::kGpu: break;
  }
  if (device.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU) return 4;
  if (device.deviceType == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU) return 3;
  return device.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU ? 0 : 2;
}

}  // namespace

void require(VkResult result, const char* what) {
  if (result != VK_SUCCESS)
    throw user_error("Vulkan: {} failed with VkResult {}", what, static_cast<int>(result));
}

Cleanup::~Cleanup() {
  while (!actions_.empty()) {
    actions_.back()();
    actions_.pop_back();
  }
}

VulkanDevice::VulkanDevice(const DeviceWish& wish) {
  if (wish.kind == DeviceWish::Kind::kLavapipe) prefer_lavapipe();
  create_instance(wish.validate);
  choose_physical_device(wish);
  choose_queue_family();
  create_device();
}

void VulkanDevice::create_instance(bool validate) {
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pApplicationName = "quadrille_lavapipe";
  application.apiVersion = VK_API_VERSION_1_3;
  const VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(&messages_);
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  if (validate) {
    info.pNext = &messenger;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &extension;
  }
  const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
    throw user_error(
        "Vulkan: no driver found; a GPU's comes with its vendor's packages, lavapipe, in software, with "
        "mesa-vulkan-drivers");
  if (result == VK_ERROR_LAYER_NOT_PRESENT)
    throw user_error("Vulkan: no validation layer; it is in the package vulkan-validationlayers");
  require(result, "vkCreateInstance");
  cleanup_.add([this] { vkDestroyInstance(instance_, nullptr); });
  if (!validate) return;
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
  const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
  VkDebugUtilsMessengerEXT handle = VK_NULL_HANDLE;
  require(create(instance_, &messenger, nullptr, &handle), "vkCreateDebugUtilsMessengerEXT");
  cleanup_.add([this, destroy, handle] { destroy(instance_, handle, nullptr); });
}

void VulkanDevice::choose_physical_device(const DeviceWish& wish) {
  std::uint32_t count = 0;
  require(vkEnumeratePhysicalDevices(instance_, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> devices(count);
  require(vkEnumeratePhysicalDevices(instance_, &count, devices.data()), "vkEnumeratePhysicalDevices");
  int best = 0;
  std::vector<std::string> names;
  for (const VkPhysicalDevice device : devices) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device, &properties);
    if (properties.apiVersion < VK_API_VERSION_1_3) continue;
    names.push_back(fmt::format("'{}'", properties.deviceName));
    const int its_rank = rank(properties, wish);
    if (its_rank > best) {
      best = its_rank;
      physical_ = device;
    }
  }
  if (names.empty()) throw user_error("Vulkan: none of {} device(s) offers Vulkan 1.3", count);
  if (physical_ == VK_NULL_HANDLE) {
    const std::string wished =
        wish.kind == DeviceWish::Kind::kNamed ? fmt::format("device named '{}'", wish.name) : "GPU";
    throw user_error("Vulkan: no {}; there are: {}", wished, fmt::join(names, ", "));
  }
  info_ = describe(physical_);
}

void VulkanDevice::choose_queue_family() {
  family_ = 0;
  std::uint32_t families = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &families, nullptr);
  std::vector<VkQueueFamilyProperties> queues(families);
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &families, queues.data());
  while (family_ < families && (queues[family_].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) ++family_;
  if (family_ == families) throw user_error("Vulkan: {} has no graphics queue", info_.name);
  info_.timestamp_bits = queues[family_].timestampValidBits;
}

void VulkanDevice::create_device() {
  const DeviceFeatures features(physical_);
  info_.line_modes = features.line_modes();
  info_.own_borders = features.own_borders();
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = family_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = features.chain();
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<std::uint32_t>(features.extensions().size());
  info.ppEnabledExtensionNames = features.extensions().data();
  require(vkCreateDevice(physical_, &info, nullptr, &device_), "vkCreateDevice");
  cleanup_.add([this] { vkDestroyDevice(device_, nullptr); });
  vkGetDeviceQueue(device_, family_, 0, &queue_);

  VkCommandPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.queueFamilyIndex = family_;
  require(vkCreateCommandPool(device_, &pool, nullptr, &pool_), "vkCreateCommandPool");
  cleanup_.add([this] { vkDestroyCommandPool(device_, pool_, nullptr); });
}

VkDeviceMemory VulkanDevice::allocate(Cleanup& owner, const VkMemoryRequirements& needs,
                                      VkMemoryPropertyFlags properties) const {
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
  std::uint32_t type = 0;
  while (type < memory.memoryTypeCount &&
         ((needs.memoryTypeBits >> type & 1u) == 0 ||
          (memory.memoryTypes[type].propertyFlags & properties) != properties))
    ++type;
  if (type == memory.memoryTypeCount)
    throw user_error("Vulkan: {} has no memory type with properties {:#x}", info_.name, properties);
  VkMemoryAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  info.allocationSize = needs.size;
  info.memoryTypeIndex = type;
  VkDeviceMemory handle = VK_NULL_HANDLE;
  require(vkAllocateMemory(device_, &info, nullptr, &handle), "vkAllocateMemory");
  owner.add([this, handle] { vkFreeMemory(device_, handle, nullptr); });
  return handle;
}

VulkanDevice::BoundBuffer VulkanDevice::create_buffer(Cleanup& owner, VkDeviceSize bytes,
                                                      VkBufferUsageFlags usage,
                                                      VkMemoryPropertyFlags properties) const {
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes == 0 ? 4 : bytes;
  info.usage = usage;
  BoundBuffer result;
  require(vkCreateBuffer(device_, &info, nullptr, &result.buffer), "vkCreateBuffer");
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device_, result.buffer, &needs);
  result.memory = allocate(owner, needs, properties);
  owner.add([this, handle = result.buffer] { vkDestroyBuffer(device_, handle, nullptr); });
  require(vkBindBufferMemory(device_, result.buffer, result.memory, 0), "vkBindBufferMemory");
  return result;
}

HostBuffer VulkanDevice::buffer(Cleanup& owner, VkDeviceSize bytes, VkBufferUsageFlags usage) const {
  const BoundBuffer made = create_buffer(
      owner, bytes, usage, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  HostBuffer result{made.buffer, nullptr};
  require(vkMapMemory(device_, made.memory, 0, VK_WHOLE_SIZE, 0, &result.mapped), "vkMapMemory");
  return result;
}

VkBuffer VulkanDevice::device_buffer(Cleanup& owner, std::span<const std::byte> data,
                                     VkBufferUsageFlags usage) const {
  const BoundBuffer made = create_buffer(owner, data.size(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                         VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  if (data.empty()) return made.buffer;
  Cleanup upload;
  const HostBuffer staging = buffer(upload, data.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  std::memcpy(staging.mapped, data.data(), data.size());
  const VkCommandBuffer commands = begin_commands(upload);
  const VkBufferCopy whole{0, 0, data.size()};
  vkCmdCopyBuffer(commands, staging.buffer, made.buffer, 1, &whole);
  VkMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1,
                       &barrier, 0, nullptr, 0, nullptr);
  require(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  submit(commands);
  return made.buffer;
}

VkImage VulkanDevice::image(Cleanup& owner, const ImageWish& wish) const {
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.flags = wish.may_be_cube ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0;
  info.imageType = wish.type;
  info.format = wish.format;
  info.extent = {wish.size.width, wish.size.height, wish.depth};
  info.mipLevels = wish.levels;
  info.arrayLayers = wish.layers;
  info.samples = static_cast<VkSampleCountFlagBits>(wish.samples);  // the bits are the counts
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = wish.usage;
  VkImage result = VK_NULL_HANDLE;
  require(vkCreateImage(device_, &info, nullptr, &result), "vkCreateImage");
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device_, result, &needs);
  const VkDeviceMemory memory = allocate(owner, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  owner.add([this, result] { vkDestroyImage(device_, result, nullptr); });
  require(vkBindImageMemory(device_, result, memory, 0), "vkBindImageMemory");
  return result;
}

bool VulkanDevice::samples(VkFormat format) const {
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(physical_, format, &properties);
  return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT) != 0;
}

VkImageView VulkanDevice::view(Cleanup& owner, VkImage image, VkFormat format, VkImageViewType type,
                               const VkImageSubresourceRange& range,
                               const VkComponentMapping& components) const {
  VkImageViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  info.image = image;
  info.viewType = type;
  info.format = format;
  info.subresourceRange = range;
  info.components = components;
  VkImageView result = VK_NULL_HANDLE;
  require(vkCreateImageView(device_, &info, nullptr, &result), "vkCreateImageView");
  owner.add([this, result] { vkDestroyImageView(device_, result, nullptr); });
  return result;
}

VkCommandBuffer VulkanDevice::begin_commands(Cleanup& owner) const {
  VkCommandBufferAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  info.commandPool = pool_;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  require(vkAllocateCommandBuffers(device_, &info, &commands), "vkAllocateCommandBuffers");
  owner.add([this, commands] { vkFreeCommandBuffers(device_, pool_, 1, &commands); });
  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  require(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  return commands;
}

void VulkanDevice::submit(VkCommandBuffer commands) const {
  VkSubmitInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  require(vkQueueSubmit(queue_, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
  require(vkQueueWaitIdle(queue_), "vkQueueWaitIdle");
}

}  // namespace quadrille::lavapipe
