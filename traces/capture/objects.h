/// The objects of Vulkan that a frame's commands name, as their creating calls describe them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "models/base/error.h"
#include "traces/capture/value.h"
#include "traces/command_stream.h"

namespace quadrille::capture {

using Handle = std::uint64_t;

/// A call that is kept: for a command buffer, or as the description of an object.
struct Call {
  std::uint64_t block = 0;
  std::string_view name;
  Value parameters;
  std::shared_ptr<std::vector<std::byte>> held;  ///< what the parameters span
};
using KeptCall = std::shared_ptr<const Call>;

struct Memory {
  std::vector<std::byte> bytes;
  std::uint64_t size = 0;    ///< `bytes` grows to it when something is written
  std::uint64_t mapped = 0;  ///< where the mapped range begins
  std::uint64_t writes = 0;  ///< so far
};
struct BufferObject {
  std::uint64_t size = 0;
  Handle memory = 0;
  std::uint64_t offset = 0;  ///< in it
};
struct ImageObject {
  std::uint32_t format = 0, type = 0, width = 1, height = 1, depth = 1, levels = 1, layers = 1, samples = 1,
                usage = 0, flags = 0;
  /// A level's texels, its layers one after the other; empty where nothing is known.
  std::vector<std::vector<std::byte>> texels;
  std::uint64_t writes = 0;  ///< so far
  Handle memory = 0;
  std::uint64_t offset = 0;  ///< in it
  bool from_memory = false;  ///< the texels are what its memory held, and nothing else
};
struct ViewObject {
  Handle image = 0;
  std::uint32_t type = 0, format = 0, aspect = 0, level = 0, levels = 1, layer = 0, layers = 1;
  std::array<std::uint32_t, 4> swizzle{};  ///< VkComponentSwizzle of red, green, blue and alpha
};
struct SamplerObject {
  traces::Sampler state;
  std::string unsupported;  ///< what it asks for that the texture unit lacks; empty: nothing
};
struct SetLayoutObject {
  struct Binding {
    std::uint32_t type = 0, count = 0;
    std::vector<Handle> samplers;  ///< that cannot be changed
  };
  std::map<std::uint32_t, Binding> bindings;
};
struct Descriptor {
  std::uint32_t type = 0;
  Handle sampler = 0, view = 0, buffer = 0;
  std::uint64_t offset = 0, range = 0;
  /// Never written, or written as nothing. Type 0 is that of a sampler without a texture.
  [[nodiscard]] bool empty() const { return view == 0 && buffer == 0 && (type != 0 || sampler == 0); }
};
/// By binding and element.
using Descriptors = std::map<std::pair<std::uint32_t, std::uint32_t>, Descriptor>;
struct SetObject {
  Handle layout = 0;
  Descriptors descriptors;
};
struct TemplateObject {
  struct Entry {
    std::uint32_t binding = 0, element = 0, count = 0, type = 0;
  };
  std::vector<Entry> entries;
  std::uint32_t set = 0;  ///< of a template that pushes
};
struct PassAttachment {
  std::uint32_t load = 0, store = 0, stencil_load = 0, stencil_store = 0;
};
/// The one subpass that is supported.
struct RenderPassObject {
  static constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<PassAttachment> attachments;
  std::vector<std::uint32_t> colors, resolves;  ///< numbers of attachments
  std::uint32_t depth = kUnused;
  std::size_t subpasses = 1;
};
struct SwapchainObject {
  std::uint32_t format = 0, width = 0, height = 0, usage = 0;
  std::vector<Handle> images;
};
struct PipelineObject {
  KeptCall call;           ///< CreateGraphicsPipelines
  std::size_t number = 0;  ///< of its pipelines
  const Value* state = nullptr;
};

struct CommandBufferObject {
  std::vector<KeptCall> calls;
  /// Calls that this program does not know how to carry out, by name.
  std::map<std::string, std::size_t> unsupported;
};

/// Of an object that a call names. Throws `UserError` for one that was never created.
template <class Key, class T>
[[nodiscard]] const T& object(const std::map<Key, T>& table, Handle handle, const char* what) {
  const auto found = table.find(static_cast<Key>(handle));
  if (found == table.end()) throw user_error("{} {} was never created", what, handle);
  return found->second;
}

}  // namespace quadrille::capture
