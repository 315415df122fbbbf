/// The descriptor sets of a draw: of what is bound, the descriptors that the two shaders declare.
#include <vulkan/vulkan_core.h>

#include <algorithm>

#include "models/base/descriptor_binding.h"
#include "models/base/error.h"
#include "traces/capture/frame_recorder.h"

namespace quadrille::capture {
namespace {

constexpr std::uint64_t kMaxUniformRange = 65536;

bool is_dynamic(std::uint32_t type) {
  return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC ||
         type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
}
bool is_uniform(std::uint32_t type) {
  return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER || type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
}
bool is_buffer(std::uint32_t type) {
  return is_uniform(type) || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ||
         type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
}

/// Dynamic offsets are in the order of the bindings, and of an array in that of its elements.
/// [VK1.3 #vkCmdBindDescriptorSets]
std::uint64_t dynamic_before(const SetLayoutObject& layout, std::uint32_t binding) {
  std::uint64_t count = 0;
  for (const auto& [number, declared] : layout.bindings)
    if (number < binding && is_dynamic(declared.type)) count += declared.count;
  return count;
}

/// A sampler that belongs to the layout stands in for what was written.
Descriptor with_fixed_sampler(Descriptor made, const SetLayoutObject::Binding& declared,
                              std::uint32_t element) {
  if (element >= declared.samplers.size()) return made;
  made.type = declared.type;
  made.sampler = declared.samplers[element];
  return made;
}

}  // namespace

std::uint64_t dynamic_offsets(const SetLayoutObject& layout) { return dynamic_before(layout, ~0u); }

std::vector<FrameRecorder::BoundDescriptor> FrameRecorder::bound_descriptors(const BoundState::Set& set,
                                                                             std::uint32_t binding,
                                                                             std::uint32_t count) {
  static const SetLayoutObject kNone;
  const SetLayoutObject& layout = set.set != 0 ? device_.layout_of(set.set) : kNone;
  const Descriptors& written = set.set != 0 ? device_.set(set.set) : set.pushed;
  const auto declared = layout.bindings.find(binding);
  const std::uint64_t first = dynamic_before(layout, binding);
  std::vector<BoundDescriptor> all(std::min(count, models::kMaxDescriptorElements));
  const BoundDescriptor* any = nullptr;
  bool found_any = false;
  for (std::uint32_t k = 0; k < all.size(); ++k) {
    if (const auto found = written.find({binding, k}); found != written.end()) {
      all[k].is = found->second;
      found_any = true;
    }
    if (declared != layout.bindings.end()) all[k].is = with_fixed_sampler(all[k].is, declared->second, k);
    if (is_dynamic(all[k].is.type) && first + k < set.offsets.size())
      all[k].dynamic_offset = set.offsets[first + k];
    if (any == nullptr && !all[k].is.empty()) any = &all[k];
  }
  if (any == nullptr) return found_any ? all : std::vector<BoundDescriptor>{};
  const BoundDescriptor stand_in = *any;
  for (BoundDescriptor& one : all)
    if (one.is.empty()) one = stand_in;
  return all;
}

void FrameRecorder::emit_sets(const BoundState& bound, const traces::Pipeline& pipeline) {
  std::map<std::uint32_t, traces::DescriptorSet> made;
  for (const traces::Index shader : {pipeline.vertex_shader, pipeline.fragment_shader}) {
    for (const auto& [place, count] : tables_.facts(shader).bindings) {
      const auto& [set, binding] = place;
      const auto source = bound.sets.find(set);
      if (source == bound.sets.end()) throw user_error("without descriptor set {}", set);
      if (binding > models::kMaxBinding)
        throw user_error("binding {} (at most {} is supported)", binding, models::kMaxBinding);
      const std::vector<BoundDescriptor> elements = bound_descriptors(source->second, binding, count);
      if (elements.empty()) throw user_error("without binding {} of descriptor set {}", binding, set);
      if (tables_.facts(shader).written.contains(place))
        std::ranges::for_each(elements, [this](const auto& one) { note_written(one); });
      for (std::uint32_t k = 0; k < elements.size(); ++k)
        add_descriptor(made[set], models::element_binding(binding, k), elements[k]);
    }
  }
  for (const auto& [set, descriptors] : made)
    emit_change(set, traces::BindDescriptorSet{set, tables_.descriptors(descriptors)});
}

void FrameRecorder::add_descriptor(traces::DescriptorSet& made, std::uint32_t number,
                                   const BoundDescriptor& bound) {
  const auto has = [&](const auto& list) {
    return std::ranges::any_of(list, [&](const auto& one) { return one.binding == number; });
  };
  if (has(made.uniforms) || has(made.textures) || has(made.buffers) || has(made.samplers))
    return;  // both stages name it
  const Descriptor& from = bound.is;
  const bool combined = from.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  if (is_buffer(from.type)) {
    add_buffer(made, number, bound);
  } else if (combined || from.type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE) {
    if (from.view == 0)
      throw user_error("binding {} is an image that is left out", models::binding_text(number));
    const ViewObject& view = object(device_.views, from.view, "image view");
    if (tables_.stored(view.image)) check_view_format(view);
    traces::TextureDescriptor texture = tables_.texture(view);
    texture.binding = number;
    if (combined) texture.sampler = tables_.sampler(from.sampler);
    made.textures.push_back(texture);
  } else if (from.type == VK_DESCRIPTOR_TYPE_SAMPLER) {
    made.samplers.push_back({number, tables_.sampler(from.sampler)});
  } else {
    throw user_error("VkDescriptorType {} is not supported", from.type);
  }
}

void FrameRecorder::add_buffer(traces::DescriptorSet& made, std::uint32_t number,
                               const BoundDescriptor& bound) {
  const Descriptor& from = bound.is;
  if (from.buffer == 0)
    throw user_error("binding {} is a buffer that is left out", models::binding_text(number));
  const std::uint64_t size = object(device_.buffers, from.buffer, "buffer").size;
  const std::uint64_t offset = from.offset + bound.dynamic_offset;
  if (offset > size)
    throw user_error("binding {} begins at byte {} of a buffer of {}", models::binding_text(number), offset,
                     size);
  std::uint64_t range = from.range == VK_WHOLE_SIZE ? size - offset : from.range;
  // Shaders may read the last word of four of a block's last array whole.
  if (is_uniform(from.type)) range = std::min({(range + 15) / 16 * 16, size - offset, kMaxUniformRange});
  const traces::Index buffer = tables_.buffer(from.buffer);
  const auto begin = static_cast<std::uint32_t>(offset), bytes = static_cast<std::uint32_t>(range);
  if (is_uniform(from.type)) made.uniforms.push_back({number, buffer, begin, bytes});
  else made.buffers.push_back({number, buffer, begin, bytes});
}

}  // namespace quadrille::capture
