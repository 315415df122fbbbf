/// Calls that make objects, by name.
#include "traces/capture/device.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstring>

#include "models/base/error.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

// What a capture may make us keep: of one allocation, and sides of an image.
constexpr std::uint64_t kMaxMemory = std::uint64_t{1} << 32;
constexpr std::uint32_t kMaxSide = 16384, kMaxLayers = 2048, kMaxLevels = 15;
constexpr std::size_t kMaxSwapchainImages = 64;

std::string_view creation(std::string_view name) {
  return name.starts_with("Create") ? name.substr(6) : std::string_view{};
}

}  // namespace

void Device::apply(const KeptCall& call) {
  const Value& p = call->parameters;
  const std::string_view name = call->name;
  if (name.starts_with("Cmd")) {
    command_buffers[p["commandBuffer"].u64()].calls.push_back(call);
  } else if (name == "BeginCommandBuffer" || name == "ResetCommandBuffer") {
    command_buffers[p["commandBuffer"].u64()] = {};
  } else if (name == "AllocateMemory") {
    const std::uint64_t size = p["pAllocateInfo"]["allocationSize"].u64();
    if (size > kMaxMemory) throw user_error("{} bytes of memory; at most {} are possible", size, kMaxMemory);
    memories[p["pMemory"].u64()].size = size;
  } else if (name == "MapMemory") {
    memories[p["memory"].u64()].mapped = p["offset"].u64();
  } else if (name == "BindBufferMemory") {
    BufferObject& buffer = buffers[p["buffer"].u64()];
    buffer.memory = p["memory"].u64();
    buffer.offset = p["memoryOffset"].u64();
  } else if (name == "BindBufferMemory2") {
    for (std::size_t i = 0; i < p["pBindInfos"].size(); ++i) {
      const Value& info = p["pBindInfos"].at(i);
      BufferObject& buffer = buffers[info["buffer"].u64()];
      buffer.memory = info["memory"].u64();
      buffer.offset = info["memoryOffset"].u64();
    }
  } else if (name == "BindImageMemory") {
    bind_image(p);
  } else if (name == "BindImageMemory2") {
    for (std::size_t i = 0; i < p["pBindInfos"].size(); ++i) bind_image(p["pBindInfos"].at(i));
  } else if (name == "GetSwapchainImagesKHR") {
    name_swapchain_images(p);
  } else if (name == "AllocateDescriptorSets") {
    allocate_sets(p);
  } else if (name == "UpdateDescriptorSets") {
    update_sets(p);
  } else if (name == "UpdateDescriptorSetWithTemplate") {
    update(set(p["descriptorSet"].u64()),
           object(templates, p["descriptorUpdateTemplate"].u64(), "update template"), p["pData"]);
  } else {
    make(call);
  }
}

void Device::bind_image(const Value& info) {
  const auto found = images.find(info["image"].u64());
  if (found == images.end()) return;
  found->second.memory = info["memory"].u64();
  found->second.offset = info["memoryOffset"].u64();
  images_in_memory_.emplace(found->second.memory, found->first);
}

void Device::make(const KeptCall& call) {
  const Value& p = call->parameters;
  const std::string_view what = creation(call->name);
  if (what == "Buffer") buffers[p["pBuffer"].u64()].size = p["pCreateInfo"]["size"].u64();
  if (what == "Image") make_image(p);
  if (what == "ImageView") make_view(p);
  if (what == "Sampler") make_sampler(p);
  if (what == "ShaderModule") {
    const std::span<const std::byte> code = p["pCreateInfo"]["pCode"].bytes();
    std::vector<std::uint32_t>& words = modules[p["pShaderModule"].u64()];
    words.resize(code.size() / sizeof(std::uint32_t));
    if (!words.empty()) std::memcpy(words.data(), code.data(), words.size() * sizeof(std::uint32_t));
  }
  if (what == "DescriptorSetLayout") make_set_layout(p);
  if (what == "DescriptorUpdateTemplate") make_template(p);
  if (what == "RenderPass" || what == "RenderPass2") make_render_pass(p);
  if (what == "Framebuffer") {
    const Value& views_of = p["pCreateInfo"]["pAttachments"];
    std::vector<Handle>& made = framebuffers[p["pFramebuffer"].u64()];
    for (std::size_t i = 0; i < views_of.size(); ++i) made.push_back(views_of.u64(i));
  }
  if (what == "SwapchainKHR") make_swapchain(p);
  if (what == "GraphicsPipelines") make_pipelines(call);
}

void Device::pass_by(std::string_view name, std::span<const std::byte> parameters) {
  if (!name.starts_with("Cmd") || changes_no_picture(name) || parameters.size() < sizeof(Handle)) return;
  Handle buffer = 0;  // the first parameter of every command
  std::memcpy(&buffer, parameters.data(), sizeof(buffer));
  ++command_buffers[buffer].unsupported["vk" + std::string(name)];
}

void Device::make_image(const Value& call) {
  const Value& info = call["pCreateInfo"];
  ImageObject image;
  image.flags = info["flags"].u32();
  image.type = info["imageType"].u32();
  image.format = info["format"].u32();
  image.width = info["extent"]["width"].u32();
  image.height = info["extent"]["height"].u32();
  image.depth = info["extent"]["depth"].u32();
  image.levels = info["mipLevels"].u32();
  image.layers = info["arrayLayers"].u32();
  image.samples = info["samples"].u32();
  image.usage = info["usage"].u32();
  const bool sides = image.width - 1 < kMaxSide && image.height - 1 < kMaxSide && image.depth - 1 < kMaxSide;
  if (!sides || image.levels - 1 >= kMaxLevels || image.layers - 1 >= kMaxLayers)
    throw user_error("an image of {}x{}x{} with {} levels and {} layers", image.width, image.height,
                     image.depth, image.levels, image.layers);
  image.texels.resize(image.levels);
  images[call["pImage"].u64()] = std::move(image);
}

void Device::make_view(const Value& call) {
  const Value& info = call["pCreateInfo"];
  const Value& range = info["subresourceRange"];
  ViewObject view;
  view.image = info["image"].u64();
  view.type = info["viewType"].u32();
  view.format = info["format"].u32();
  view.aspect = range["aspectMask"].u32();
  view.level = range["baseMipLevel"].u32();
  view.layer = range["baseArrayLayer"].u32();
  const ImageObject& image = object(images, view.image, "image");
  const auto rest = [](const Value& count, std::uint32_t all, std::uint32_t first) {
    if (first >= all) throw user_error("{} begins at {} of {}", "a view", first, all);
    return count.u32() == VK_REMAINING_MIP_LEVELS ? all - first : count.u32();
  };
  view.levels = rest(range["levelCount"], image.levels, view.level);
  view.layers = rest(range["layerCount"], image.layers, view.layer);
  if (view.levels == 0 || view.levels > image.levels - view.level || view.layers == 0 ||
      view.layers > image.layers - view.layer)
    throw user_error("a view of levels {}+{} and layers {}+{} of an image that has {} and {}", view.level,
                     view.levels, view.layer, view.layers, image.levels, image.layers);
  const Value& components = info["components"];
  for (std::size_t c = 0; c < 4; ++c) view.swizzle[c] = components[std::array{"r", "g", "b", "a"}[c]].u32();
  views[call["pView"].u64()] = view;
}

void Device::make_sampler(const Value& call) {
  samplers[call["pSampler"].u64()] = sampler_of(call["pCreateInfo"]);
}

void Device::make_set_layout(const Value& call) {
  SetLayoutObject layout;
  const Value& bindings = call["pCreateInfo"]["pBindings"];
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    const Value& from = bindings.at(i);
    SetLayoutObject::Binding& to = layout.bindings[from["binding"].u32()];
    to.type = from["descriptorType"].u32();
    to.count = from["descriptorCount"].u32();
    for (std::size_t s = 0; s < from["pImmutableSamplers"].size(); ++s)
      to.samplers.push_back(from["pImmutableSamplers"].u64(s));
  }
  set_layouts[call["pSetLayout"].u64()] = std::move(layout);
}

void Device::make_template(const Value& call) {
  const Value& info = call["pCreateInfo"];
  TemplateObject made;
  made.set = info["set"].u32();
  const Value& entries = info["pDescriptorUpdateEntries"];
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Value& e = entries.at(i);
    made.entries.push_back({e["dstBinding"].u32(), e["dstArrayElement"].u32(), e["descriptorCount"].u32(),
                            e["descriptorType"].u32()});
  }
  templates[call["pDescriptorUpdateTemplate"].u64()] = std::move(made);
}

void Device::make_render_pass(const Value& call) {
  const Value& info = call["pCreateInfo"];
  RenderPassObject pass;
  for (std::size_t i = 0; i < info["pAttachments"].size(); ++i) {
    const Value& a = info["pAttachments"].at(i);
    pass.attachments.push_back(
        {a["loadOp"].u32(), a["storeOp"].u32(), a["stencilLoadOp"].u32(), a["stencilStoreOp"].u32()});
  }
  pass.subpasses = info["pSubpasses"].size();
  const Value& subpass = info["pSubpasses"].at(0);
  const auto number = [](const Value& reference) { return reference["attachment"].u32(); };
  for (std::size_t i = 0; i < subpass["pColorAttachments"].size(); ++i)
    pass.colors.push_back(number(subpass["pColorAttachments"].at(i)));
  for (std::size_t i = 0; i < subpass["pResolveAttachments"].size(); ++i)
    pass.resolves.push_back(number(subpass["pResolveAttachments"].at(i)));
  if (!subpass["pDepthStencilAttachment"].null()) pass.depth = number(subpass["pDepthStencilAttachment"]);
  render_passes[call["pRenderPass"].u64()] = std::move(pass);
}

void Device::make_pipelines(const KeptCall& call) {
  const Value& infos = call->parameters["pCreateInfos"];
  for (std::size_t i = 0; i < infos.size(); ++i)
    pipelines[call->parameters["pPipelines"].u64(i)] = {call, i, &infos.at(i)};
}

void Device::make_swapchain(const Value& call) {
  const Value& info = call["pCreateInfo"];
  SwapchainObject& made = swapchains[call["pSwapchain"].u64()];
  made.format = info["imageFormat"].u32();
  made.width = info["imageExtent"]["width"].u32();
  made.height = info["imageExtent"]["height"].u32();
  made.usage = info["imageUsage"].u32();
}

void Device::name_swapchain_images(const Value& call) {
  const Value& handles = call["pSwapchainImages"];
  const auto found = swapchains.find(call["swapchain"].u64());
  if (found == swapchains.end() || handles.null()) return;
  if (handles.size() > kMaxSwapchainImages)
    throw user_error("{} images of a swapchain; at most {} are possible", handles.size(),
                     kMaxSwapchainImages);
  SwapchainObject& chain = found->second;
  chain.images.clear();
  for (std::size_t i = 0; i < handles.size(); ++i) {
    ImageObject image;
    image.format = chain.format;
    image.type = VK_IMAGE_TYPE_2D;
    image.width = chain.width;
    image.height = chain.height;
    image.usage = chain.usage;
    image.texels.resize(1);
    images[handles.u64(i)] = std::move(image);
    chain.images.push_back(handles.u64(i));
  }
}

}  // namespace quadrille::capture
