/// What a Vulkan program needs before it draws: a window of X, a device, a swapchain, and images and shaders
/// of its own. Part of native_frame.cpp.
#pragma once

#define VK_USE_PLATFORM_XCB_KHR
#include <vulkan/vulkan.h>
#include <xcb/xcb.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

constexpr std::uint32_t kWidth = 96, kHeight = 72, kInnerWidth = 48, kInnerHeight = 36;
constexpr VkFormat kColor = VK_FORMAT_B8G8R8A8_UNORM, kDepth = VK_FORMAT_D32_SFLOAT;

inline void check(VkResult result, const char* what) {
  if (result >= 0) return;
  std::fprintf(stderr, "%s: VkResult %d\n", what, result);
  std::exit(1);
}

inline std::vector<std::uint32_t> spirv(const char* source, const char* stage) {
  const std::string base = std::string("/tmp/native_frame.") + stage;
  std::ofstream(base) << source;
  if (std::system(("glslangValidator -V " + base + " -o " + base + ".spv > /dev/null").c_str()) != 0)
    std::exit(1);
  std::ifstream file(base + ".spv", std::ios::binary);
  const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), words.size() * 4);
  return words;
}

struct Image {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
};

class NativeDevice {
 protected:
  NativeDevice() {
    connect();
    choose_device();
    make_swapchain();
  }
  void connect() {
    connection_ = xcb_connect(nullptr, nullptr);
    const xcb_screen_t* screen = xcb_setup_roots_iterator(xcb_get_setup(connection_)).data;
    window_ = xcb_generate_id(connection_);
    xcb_create_window(connection_, screen->root_depth, window_, screen->root, 0, 0, kWidth, kHeight, 0,
                      XCB_WINDOW_CLASS_INPUT_OUTPUT, screen->root_visual, 0, nullptr);
    xcb_map_window(connection_, window_);
    xcb_flush(connection_);
  }
  void choose_device() {
    const std::array instance_extensions{"VK_KHR_surface", "VK_KHR_xcb_surface"};
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo made{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    made.pApplicationInfo = &application;
    made.enabledExtensionCount = instance_extensions.size();
    made.ppEnabledExtensionNames = instance_extensions.data();
    check(vkCreateInstance(&made, nullptr, &instance_), "instance");
    std::uint32_t one = 1;
    check(vkEnumeratePhysicalDevices(instance_, &one, &physical_), "devices");
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan13Features features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    features.synchronization2 = features.dynamicRendering = VK_TRUE;
    VkPhysicalDeviceFeatures plain{};
    plain.multiDrawIndirect = VK_TRUE;
    const char* extension = "VK_KHR_swapchain";
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &extension;
    info.pEnabledFeatures = &plain;
    check(vkCreateDevice(physical_, &info, nullptr, &device_), "device");
    vkGetDeviceQueue(device_, 0, 0, &queue_);
    vkGetPhysicalDeviceMemoryProperties(physical_, &memories_);
  }
  VkDeviceMemory memory(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size};
    while ((needs.memoryTypeBits >> info.memoryTypeIndex & 1u) == 0 ||
           (memories_.memoryTypes[info.memoryTypeIndex].propertyFlags & wanted) != wanted)
      ++info.memoryTypeIndex;
    VkDeviceMemory made = VK_NULL_HANDLE;
    check(vkAllocateMemory(device_, &info, nullptr, &made), "memory");
    return made;
  }
  Image image(VkFormat format, VkSampleCountFlagBits samples, VkImageUsageFlags usage, bool viewed) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {kInnerWidth, kInnerHeight, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = samples;
    info.usage = usage;
    Image made;
    check(vkCreateImage(device_, &info, nullptr, &made.image), "image");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device_, made.image, &needs);
    check(vkBindImageMemory(device_, made.image, memory(needs, 0), 0), "bind image");
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = made.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {aspect(format), 0, 1, 0, 1};
    if (viewed) check(vkCreateImageView(device_, &view, nullptr, &made.view), "view");
    return made;
  }
  static VkImageAspectFlags aspect(VkFormat format) {
    return format == kDepth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
  }
  void make_swapchain() {
    VkXcbSurfaceCreateInfoKHR surface{VK_STRUCTURE_TYPE_XCB_SURFACE_CREATE_INFO_KHR};
    surface.connection = connection_;
    surface.window = window_;
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    check(vkCreateXcbSurfaceKHR(instance_, &surface, nullptr, &info.surface), "surface");
    VkBool32 supported = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(physical_, 0, info.surface, &supported), "support");
    info.minImageCount = 3;
    info.imageFormat = kColor;
    info.imageExtent = {kWidth, kHeight};
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    info.preTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    check(vkCreateSwapchainKHR(device_, &info, nullptr, &swapchain_), "swapchain");
    std::uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device_, swapchain_, &count, nullptr), "images");
    shown_.resize(count);
    check(vkGetSwapchainImagesKHR(device_, swapchain_, &count, shown_.data()), "images");
  }
  VkShaderModule module(const char* source, const char* stage) {
    const std::vector<std::uint32_t> words = spirv(source, stage);
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, words.size() * 4,
                                  words.data()};
    VkShaderModule made = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device_, &info, nullptr, &made), "module");
    return made;
  }
  void barrier(VkImage image, VkImageAspectFlags aspects, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 one{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    one.srcStageMask = one.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    one.srcAccessMask = one.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    one.oldLayout = from;
    one.newLayout = to;
    one.image = image;
    one.subresourceRange = {aspects, 0, 1, 0, 1};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &one;
    vkCmdPipelineBarrier2(commands_, &info);
  }

  xcb_connection_t* connection_ = nullptr;
  xcb_window_t window_ = 0;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkPhysicalDeviceMemoryProperties memories_{};
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  std::vector<VkImage> shown_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
};
