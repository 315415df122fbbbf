/// Memory, contents of buffers and images, and descriptors.
#include <vulkan/vulkan_core.h>

#include <algorithm>

#include "models/base/error.h"
#include "traces/capture/device.h"
#include "traces/capture/lavapipe_memory.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

/// What lies above depths of 24 bits when they are copied is not defined: stencil values of 0.
void clear_above_depths(std::uint32_t format, std::vector<std::byte>& texels) {
  if (format != VK_FORMAT_D24_UNORM_S8_UINT && format != VK_FORMAT_X8_D24_UNORM_PACK32) return;
  for (std::size_t at = 3; at < texels.size(); at += 4) texels[at] = std::byte{0};
}

}  // namespace

void Device::write(const Block& block) {
  if (block.id == kFillMemory) {
    Memory& memory = memories[block.numbers[0]];
    write_memory(block.numbers[0], memory.mapped + block.numbers[1], block.data);
    if (of_lavapipe_) read_images_of(block.numbers[0]);
  } else if (block.id == kDeviceProperties) {
    of_lavapipe_ = is_lavapipe(block.numbers[3], block.numbers[5]);
  } else if (block.id == kInitBuffer) {
    write_buffer(block.numbers[1], 0, block.data);
  } else if (block.id == kInitImage) {
    write_image(block);
  }
}

void Device::write_memory(Handle handle, std::uint64_t offset, std::span<const std::byte> bytes) {
  const auto found = memories.find(handle);
  if (found == memories.end()) throw user_error("memory {} was never allocated", handle);
  Memory& memory = found->second;
  if (offset > memory.size || bytes.size() > memory.size - offset)
    throw user_error("bytes {}+{} are written to memory {} of {}", offset, bytes.size(), handle, memory.size);
  if (offset + bytes.size() > 2 * kMaxObjectBytes)
    throw user_error("memory {} is written up to byte {}; at most {} are possible", handle,
                     offset + bytes.size(), 2 * kMaxObjectBytes);
  if (memory.bytes.size() < offset + bytes.size()) memory.bytes.resize(offset + bytes.size());
  std::ranges::copy(bytes, memory.bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  ++memory.writes;
}

void Device::read_images_of(Handle memory) {
  const std::vector<std::byte>& bytes = memories.at(memory).bytes;
  const auto [first, last] = images_in_memory_.equal_range(memory);
  for (auto bound = first; bound != last; ++bound) {
    const auto found = images.find(bound->second);
    if (found == images.end()) continue;
    ImageObject& image = found->second;
    const bool known = std::ranges::any_of(image.texels, [](const auto& level) { return !level.empty(); });
    if ((known && !image.from_memory) || image.memory != memory || image.offset > bytes.size()) continue;
    std::vector<std::vector<std::byte>> texels =
        texels_in_memory(image, std::span(bytes).subspan(image.offset));
    if (texels.empty()) continue;
    for (std::vector<std::byte>& level : texels) clear_above_depths(image.format, level);
    if (texels == image.texels) continue;
    image.texels = std::move(texels);
    image.from_memory = true;
    ++image.writes;
  }
}

void Device::write_buffer(Handle handle, std::uint64_t offset, std::span<const std::byte> bytes) {
  const BufferObject& buffer = object(buffers, handle, "buffer");
  if (offset > buffer.size || bytes.size() > buffer.size - offset)
    throw user_error("bytes {}+{} are written to buffer {} of {}", offset, bytes.size(), handle, buffer.size);
  write_memory(buffer.memory, buffer.offset + offset, bytes);
}

std::vector<std::byte> Device::contents(const BufferObject& buffer) const {
  const Memory& memory = object(memories, buffer.memory, "memory");
  if (buffer.offset > memory.size || buffer.size > memory.size - buffer.offset)
    throw user_error("a buffer of bytes {}+{} is bound to memory {} of {}", buffer.offset, buffer.size,
                     buffer.memory, memory.size);
  if (buffer.size > kMaxObjectBytes)
    throw user_error("a buffer of {} bytes; at most {} are possible", buffer.size, kMaxObjectBytes);
  std::vector<std::byte> bytes(buffer.size);
  const std::uint64_t end = std::min<std::uint64_t>(memory.bytes.size(), buffer.offset + buffer.size);
  if (end > buffer.offset)
    std::copy(memory.bytes.begin() + static_cast<std::ptrdiff_t>(buffer.offset),
              memory.bytes.begin() + static_cast<std::ptrdiff_t>(end), bytes.begin());
  return bytes;
}

std::uint64_t Device::version(const BufferObject& buffer) const {
  return object(memories, buffer.memory, "memory").writes;
}

/// Levels follow each other, of each its layers. A second aspect of the same image replaces nothing of the
/// first: depth comes first, and stencil values of earlier frames are not kept.
void Device::write_image(const Block& block) {
  const Handle handle = block.numbers[1];
  const auto found = images.find(handle);
  if (found == images.end()) throw user_error("image {} was never created", handle);
  ImageObject& image = found->second;
  const auto aspect = static_cast<std::uint32_t>(block.numbers[3]);
  if ((aspect & (VK_IMAGE_ASPECT_COLOR_BIT | VK_IMAGE_ASPECT_DEPTH_BIT)) == 0) return;
  std::span<const std::byte> rest = block.data;
  image.from_memory = false;
  for (std::size_t level = 0; level + 6 < block.numbers.size(); ++level) {
    const std::uint64_t bytes = block.numbers[6 + level];
    if (level >= image.levels || bytes > rest.size())
      throw user_error("contents of image {}: level {} of {} has {} bytes where {} remain", handle, level,
                       image.levels, bytes, rest.size());
    image.texels[level].assign(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(bytes));
    clear_above_depths(image.format, image.texels[level]);
    rest = rest.subspan(bytes);
  }
  ++image.writes;
}

void Device::keep_drawn(Handle handle, std::uint32_t level, std::uint32_t layer,
                        std::span<const std::byte> texels) {
  ImageObject& image = images.at(handle);
  std::vector<std::byte>& all = image.texels.at(level);
  const std::size_t begin = texels.size() * layer;
  if (all.size() < begin + texels.size()) all.resize(begin + texels.size());
  image.from_memory = false;
  std::ranges::copy(texels, all.begin() + static_cast<std::ptrdiff_t>(begin));
  ++image.writes;
}

Descriptors& Device::set(Handle handle) {
  const auto found = sets.find(handle);
  if (found == sets.end()) throw user_error("descriptor set {} was never allocated", handle);
  return found->second.descriptors;
}

const SetLayoutObject& Device::layout_of(Handle handle) {
  const auto found = sets.find(handle);
  if (found == sets.end()) throw user_error("descriptor set {} was never allocated", handle);
  return object(set_layouts, found->second.layout, "descriptor set layout");
}

void Device::allocate_sets(const Value& call) {
  const Value& layouts = call["pAllocateInfo"]["pSetLayouts"];
  for (std::size_t i = 0; i < layouts.size() && i < call["pDescriptorSets"].size(); ++i)
    sets[call["pDescriptorSets"].u64(i)] = {layouts.u64(i), {}};
}

namespace {

bool of_images(std::uint32_t type) {
  return type == VK_DESCRIPTOR_TYPE_SAMPLER || type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER ||
         type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE || type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE ||
         type == VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT;
}
bool of_texels(std::uint32_t type) {
  return type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
}

/// Of the lists of a write or of a template's data, elements from `first` on.
Descriptor descriptor(std::uint32_t type, const Value& lists, std::size_t element) {
  Descriptor made;
  made.type = type;
  if (of_images(type)) {
    const Value& image = lists["pImageInfo"].at(element);
    made.sampler = image["sampler"].u64();
    made.view = image["imageView"].u64();
  } else if (of_texels(type)) {
    made.view = lists["pTexelBufferView"].u64(element);
  } else {
    const Value& buffer = lists["pBufferInfo"].at(element);
    made.buffer = buffer["buffer"].u64();
    made.offset = buffer["offset"].u64();
    made.range = buffer["range"].u64();
  }
  return made;
}

constexpr std::uint32_t kMaxDescriptors = 65536;  // of a write [G: far beyond what any frame writes]

}  // namespace

void Device::update(Descriptors& descriptors, const Value& write) {
  const std::uint32_t count = write["descriptorCount"].u32(), type = write["descriptorType"].u32();
  if (count > kMaxDescriptors) throw user_error("{} descriptors are written at once", count);
  for (std::uint32_t i = 0; i < count; ++i)
    descriptors[{write["dstBinding"].u32(), write["dstArrayElement"].u32() + i}] = descriptor(type, write, i);
}

/// The data holds all images, then all buffers, then all views of texels, each in the order of the entries.
void Device::update(Descriptors& descriptors, const TemplateObject& made, const Value& data) {
  std::size_t images_taken = 0, buffers_taken = 0, texels_taken = 0;
  for (const TemplateObject::Entry& entry : made.entries) {
    std::size_t& taken = of_images(entry.type)   ? images_taken
                         : of_texels(entry.type) ? texels_taken
                                                 : buffers_taken;
    if (entry.count > kMaxDescriptors) throw user_error("{} descriptors are written at once", entry.count);
    for (std::uint32_t i = 0; i < entry.count; ++i)
      descriptors[{entry.binding, entry.element + i}] = descriptor(entry.type, data, taken++);
  }
}

void Device::update_sets(const Value& call) {
  const Value& writes = call["pDescriptorWrites"];
  for (std::size_t i = 0; i < writes.size(); ++i) update(set(writes.at(i)["dstSet"].u64()), writes.at(i));
  const Value& copies = call["pDescriptorCopies"];
  for (std::size_t i = 0; i < copies.size(); ++i) copy_descriptors(copies.at(i));
}

void Device::copy_descriptors(const Value& copy) {
  const std::uint32_t count = copy["descriptorCount"].u32();
  if (count > kMaxDescriptors) throw user_error("{} descriptors are copied at once", count);
  const Descriptors from = set(copy["srcSet"].u64());
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto found = from.find({copy["srcBinding"].u32(), copy["srcArrayElement"].u32() + i});
    if (found != from.end())
      set(copy["dstSet"].u64())[{copy["dstBinding"].u32(), copy["dstArrayElement"].u32() + i}] =
          found->second;
  }
}

}  // namespace quadrille::capture
