/// The program's side of a capture: takes the calls that make objects and write memory, in order, and keeps
/// what the commands need of them. Command buffers are kept as they are recorded; who submits them
/// (frame_recorder.h) carries them out.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string_view>

#include "traces/capture/capture_file.h"
#include "traces/capture/objects.h"

namespace quadrille::capture {

/// No buffer, piece of memory or level of an image of a capture may be larger: a few bytes of a file can name
/// any size.
inline constexpr std::uint64_t kMaxObjectBytes = std::uint64_t{1} << 29;

class Device {
 public:
  /// Carries out a call that makes or changes an object, records one of a command buffer, and passes by what
  /// changes no picture. Throws `UserError`.
  void apply(const KeptCall& call);
  /// A call that is not in the tables, by name: counted where it stands in a command buffer.
  void pass_by(std::string_view name, std::span<const std::byte> parameters);
  /// Memory, and contents of buffers and images. Throws `UserError`.
  void write(const Block& block);

  /// The bytes of a buffer's memory: those that were ever written, the others are zeros.
  [[nodiscard]] std::vector<std::byte> contents(const BufferObject& buffer) const;
  /// Changes whenever the memory of the buffer does.
  [[nodiscard]] std::uint64_t version(const BufferObject& buffer) const;
  void copy_buffer(Handle source, Handle target, const Value& region);
  void fill_buffer(const Value& call);
  void copy_to_image(Handle source, Handle target, const Value& region);
  void copy_image(Handle source, Handle target, const Value& region);
  /// Of colours that are no integers. `filter`: VkFilter.
  void blit_image(Handle source, Handle target, const Value& region, std::uint32_t filter);
  /// A frame has left that in a level of a layer of an image, as its attachment's format stores it.
  void keep_drawn(Handle handle, std::uint32_t level, std::uint32_t layer, std::span<const std::byte> texels);
  void write_buffer(Handle handle, std::uint64_t offset, std::span<const std::byte> bytes);

  [[nodiscard]] Descriptors& set(Handle handle);
  [[nodiscard]] const SetLayoutObject& layout_of(Handle handle);
  void update(Descriptors& descriptors, const Value& write);
  void update(Descriptors& descriptors, const TemplateObject& made, const Value& data);

  std::map<Handle, Memory> memories;
  std::map<Handle, BufferObject> buffers;
  std::map<Handle, ImageObject> images;
  std::map<Handle, ViewObject> views;
  std::map<Handle, SamplerObject> samplers;
  std::map<Handle, std::vector<std::uint32_t>> modules;
  std::map<Handle, SetLayoutObject> set_layouts;
  std::map<Handle, SetObject> sets;
  std::map<Handle, TemplateObject> templates;
  std::map<Handle, RenderPassObject> render_passes;
  std::map<Handle, std::vector<Handle>> framebuffers;  ///< their views
  std::map<Handle, SwapchainObject> swapchains;
  std::map<Handle, PipelineObject> pipelines;
  std::map<Handle, CommandBufferObject> command_buffers;
  std::set<Handle> read_back;  ///< buffers that hold what passes drew: no draw may use them

 private:
  void make(const KeptCall& call);
  void make_image(const Value& call);
  void make_view(const Value& call);
  void make_sampler(const Value& call);
  void make_set_layout(const Value& call);
  void make_template(const Value& call);
  void make_render_pass(const Value& call);
  void make_pipelines(const KeptCall& call);
  void make_swapchain(const Value& call);
  void name_swapchain_images(const Value& call);
  void allocate_sets(const Value& call);
  void update_sets(const Value& call);
  void copy_descriptors(const Value& copy);
  void write_memory(Handle handle, std::uint64_t offset, std::span<const std::byte> bytes);
  void bind_image(const Value& info);
  /// Images of which nothing is known but their memory hold what that holds, if the driver was lavapipe.
  void read_images_of(Handle memory);
  void write_image(const Block& block);
  bool of_lavapipe_ = false;
  std::multimap<Handle, Handle> images_in_memory_;
};

}  // namespace quadrille::capture
