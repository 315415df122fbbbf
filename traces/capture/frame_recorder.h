/// The GPU's side of a capture: takes what the frame submits, walks the command buffers as a queue would, and
/// writes the command stream of this program.
///
/// Vulkan binds state piece by piece; the stream's pipelines, descriptor sets and buffers are fixed. So each
/// draw is put together from what is bound when it comes, and equal pieces are one object of the stream. What
/// cannot be expressed is counted by its reason, and `unsupported` names it.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "traces/capture/device.h"
#include "traces/capture/raster_state.h"
#include "traces/capture/stream_tables.h"
#include "traces/frame_contents.h"

namespace quadrille::capture {

/// What is bound in a command buffer.
struct BoundState {
  struct VertexBuffer {
    Handle buffer = 0;
    std::uint64_t offset = 0;
    std::optional<std::uint32_t> stride;  ///< where the command says it
  };
  struct Set {
    Handle set = 0;                      ///< whose descriptors count when it is drawn
    Descriptors pushed;                  ///< where none is bound
    std::vector<std::uint32_t> offsets;  ///< dynamic ones, by binding and element
  };
  const PipelineObject* pipeline = nullptr;
  RasterState fixed, dynamic;
  std::map<std::uint32_t, VertexBuffer> vertex_buffers;
  Handle index_buffer = 0;
  std::uint64_t index_offset = 0;
  traces::IndexType index_type = traces::IndexType::kUint16;
  std::map<std::uint32_t, Set> sets;
  std::vector<std::byte> constants;  ///< pushed, from byte 0 on
};

/// The words of a VkClearValue.
[[nodiscard]] std::array<std::uint32_t, 4> clear_bits(const Value& clear);
/// Makes the attachment begin with those bits: of integers, or of floats.
void set_clear(traces::ColorAttachmentUse& use, const std::array<std::uint32_t, 4>& bits, bool integers);

/// Of the two subresources of a copy: are they depths, and not colours? Throws `UserError` for anything else.
[[nodiscard]] bool are_depths(const Value& from, const Value& to);

/// How many dynamic offsets a set of that layout takes.
[[nodiscard]] std::uint64_t dynamic_offsets(const SetLayoutObject& layout);

class FrameRecorder {
 public:
  explicit FrameRecorder(Device& device) : device_(device), tables_(device) {}
  /// QueueSubmit or QueueSubmit2.
  void submit(const Call& call);
  /// QueuePresentKHR: which image is shown.
  void present(const Call& call);
  [[nodiscard]] bool presented() const { return presented_ != 0; }
  /// What could not be expressed, with how often.
  [[nodiscard]] const std::map<std::string, std::size_t>& unsupported() const { return unsupported_; }
  /// What is drawn without being known, a line each.
  [[nodiscard]] const std::set<std::string>& notes() const { return tables_.notes(); }
  /// Makes what the frame, which was taken, has left the contents of the objects of the capture.
  void keep(const traces::FrameContents& contents);
  /// The frame. Its last pass draws to what is shown. Throws `UserError` if there is none.
  [[nodiscard]] traces::CommandStream take();

 private:
  /// An attachment of a pass that is about to begin.
  struct PassTarget {
    Handle view = 0, resolve = 0;
    traces::LoadOp load = traces::LoadOp::kLoad;
    traces::StoreOp store = traces::StoreOp::kStore;
    std::array<std::uint32_t, 4> clear{};  ///< bits
  };
  /// Pixels of a target.
  struct Area {
    std::int32_t x = 0, y = 0;
    std::uint32_t width = 0, height = 0;
  };
  struct StoredPart {
    Handle image = 0;
    std::uint32_t level = 0, layer = 0;
    friend bool operator==(const StoredPart&, const StoredPart&) = default;
  };
  /// An area of one image that is drawn to an area of another.
  struct DrawnCopy {
    StoredPart source, target;
    std::array<float, 4> from{};  ///< corner and size, in texels; a size below zero turns it
    Area to;
    traces::Filter filter = traces::Filter::kNearest;
    bool depths = false;  ///< and not colours
  };
  /// What a triangle over an area writes to.
  struct Fill {
    OwnShader shader = OwnShader::kClear;
    std::uint32_t attachment = 0;
    bool colors = true;  ///< else depths and stencil values alone
  };
  struct DrawRange {
    bool indexed = false;
    std::uint32_t count = 0, first = 0;
    std::int32_t vertex_offset = 0;
    std::uint32_t instances = 1, first_instance = 0;
  };
  struct BoundDescriptor {
    Descriptor is;
    std::uint32_t dynamic_offset = 0;  ///< bytes
  };
  /// Bytes of a memory.
  struct MemoryRange {
    Handle memory = 0;
    std::uint64_t begin = 0, end = 0;
    friend auto operator<=>(const MemoryRange&,
                            const MemoryRange&) = default;  // NOLINT(modernize-use-nullptr)
  };

  void run(Handle command_buffer);
  void run(const Call& call, BoundState& bound);
  bool bind(const Call& call, BoundState& bound);
  bool change_pass(const Call& call);
  bool draw(const Call& call, const BoundState& bound);
  bool draw_indirect(const Call& call, const BoundState& bound);
  bool label(const Call& call);

  void bind_sets(const Value& call, BoundState& bound);
  void bind_vertex_buffers(const Value& call, BoundState& bound);
  void push_constants(const Value& call, BoundState& bound);

  void begin_rendering(const Value& info);
  void begin_render_pass(const Value& info);
  void begin_pass(const std::vector<PassTarget>& colors, const PassTarget& depth);
  void begin_pass_in(std::vector<PassTarget> colors, PassTarget depth, const Value& area);
  void end_pass();
  void note_begin();
  void clear_attachments(const Value& call);
  void clear_at_begin(const Value& attachment);
  [[nodiscard]] traces::Index color_place(const Value& attachment) const;
  void clear_area(const Value& attachment, const Area& area);
  void clear_color_area(std::uint32_t attachment, const std::array<std::uint32_t, 4>& bits, const Area& area);
  void clear_depth_area(std::uint32_t aspect, const std::array<std::uint32_t, 4>& bits, const Area& area);
  [[nodiscard]] static Area area_of(const Value& rect);
  void blit(const Value& call);
  void blit_region(Handle source, Handle target, const Value& region, std::uint32_t filter);
  void draw_layers(DrawnCopy copy, std::uint32_t layers, const char* label);
  void draw_copy(const DrawnCopy& copy, const char* label);
  void draw_texture(const traces::TextureDescriptor& texture, const AreaConstants& constants,
                    const DrawnCopy& copy, const char* label);
  void clear_image(const Value& call);
  bool copy(const Call& call);
  bool copy_pixels(std::string_view name, const Value& info);
  void copy_images(const Value& call);
  void copy_drawn(Handle source, Handle target, const Value& region);
  void resolve(const Value& call);
  void resolve_layer(const StoredPart& source, const StoredPart& target);
  /// The attachment that the part lies in. Throws `UserError` for a part that there is not, or one of colours
  /// where depths are wanted.
  [[nodiscard]] traces::Index attachment_of(const StoredPart& part, bool depths);
  void begin_blit(const StoredPart& target, bool depths);
  void fill(traces::Pipeline pipeline, const Fill& what, const AreaConstants& constants, const Area& area,
            const char* label);
  void attach(traces::AttachmentUse& use, const PassTarget& target);
  /// An attachment is seen through a view: of another format it is not supported, and taken in its own.
  void check_view_format(const ViewObject& view);

  void draw_one(const BoundState& bound, const DrawRange& range);
  /// Bytes that are arguments of draws. Throws `UserError` where they are not known.
  [[nodiscard]] std::vector<std::uint32_t> arguments(Handle buffer, std::uint64_t offset,
                                                     std::uint64_t bytes) const;
  void note_written(const BoundDescriptor& bound);
  /// Gives the draw indices of its own where its provoking vertex is the last, and that can be seen.
  void turn_primitives(const BoundState& bound, traces::Pipeline& pipeline, traces::Draw& draw);
  [[nodiscard]] traces::Pipeline pipeline_of(const BoundState& bound, const RasterState& state,
                                             std::uint32_t first_instance);
  [[nodiscard]] traces::Index stage_of(const Value& stage, bool negative_one_to_one,
                                       std::uint32_t first_instance);
  void place_colors(traces::Pipeline& pipeline, const RasterState& state) const;
  /// Gives attributes that have to be expanded a binding of their own.
  void expand_attributes(const BoundState& bound, const RasterState& state, traces::Pipeline& pipeline);
  /// Of a binding, that many elements. Those of an array that were never written, which the program may not
  /// use, are like the first that was; none, if none was.
  [[nodiscard]] std::vector<BoundDescriptor> bound_descriptors(const BoundState::Set& set,
                                                               std::uint32_t binding, std::uint32_t count);
  void emit_sets(const BoundState& bound, const traces::Pipeline& pipeline);
  /// `number`: of models/base/descriptor_binding.h.
  void add_descriptor(traces::DescriptorSet& made, std::uint32_t number, const BoundDescriptor& bound);
  void add_buffer(traces::DescriptorSet& made, std::uint32_t number, const BoundDescriptor& bound);
  void emit_buffers(const BoundState& bound, const traces::Pipeline& pipeline);
  void emit_window(const RasterState& state);
  /// A pass of the stream begins with viewports and scissors of its own.
  void forget_windows() {
    std::erase_if(emitted_, [](const auto& entry) {
      return std::holds_alternative<traces::SetViewport>(entry.second) ||
             std::holds_alternative<traces::SetScissor>(entry.second);
    });
  }
  /// Adds the command if it changes what is bound in the stream.
  template <class C>
  void emit_change(std::uint32_t place, const C& command) {
    const traces::Command wrapped = command;
    const auto [entry, added] = emitted_.try_emplace({wrapped.index(), place}, wrapped);
    if (!added && entry->second == wrapped) return;
    entry->second = wrapped;
    tables_.stream.commands.push_back(wrapped);
  }

  Device& device_;
  StreamTables tables_;
  std::map<std::string, std::size_t> unsupported_;
  std::map<std::pair<std::size_t, std::uint32_t>, traces::Command> emitted_;  ///< by kind and place
  std::vector<std::string> labels_;

  traces::BeginPass pass_;
  /// By location of a shader's output: the number of the pass's colour attachment, or `kNone` where the
  /// program leaves that out. The stream's passes have no holes.
  std::vector<traces::Index> color_places_;
  std::vector<StoredPart> pass_stores_;  ///< that this pass leaves contents in
  /// Attachments that this pass would load, and whose contents the capture does not bring.
  std::set<traces::Index> pass_lacks_;
  std::size_t begin_at_ = 0;  ///< of its command
  bool in_pass_ = false, drew_ = false;
  int depth_ = 0;  ///< of command buffers that execute others
  std::uint32_t pass_width_ = 0, pass_height_ = 0;
  Handle last_shown_ = 0;  ///< image of the latest pass's first colour
  Handle presented_ = 0;
  std::set<MemoryRange> written_;  ///< storage buffers that draws of this frame may have written
};

}  // namespace quadrille::capture
