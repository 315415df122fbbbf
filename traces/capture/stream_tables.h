/// The tables of the command stream that is being made: a buffer, image, sampler, shader, pipeline or
/// descriptor set of the capture gets its place when a draw first needs it, and keeps it.
///
/// A buffer whose memory has changed since then gets another place: the stream's buffers hold one content for
/// the whole frame.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "traces/capture/attributes.h"
#include "traces/capture/device.h"
#include "traces/capture/own_shaders.h"
#include "traces/capture/shader_words.h"

namespace quadrille::capture {

/// May a pass draw to the image?
[[nodiscard]] bool may_attach(const ImageObject& image);

class StreamTables {
 public:
  explicit StreamTables(const Device& device) : device_(device) {}
  traces::CommandStream stream;

  [[nodiscard]] traces::Index buffer(Handle handle);
  /// The image as an attachment: it begins with what is known of it, and what passes store follows.
  [[nodiscard]] traces::Index attachment(Handle handle);
  /// What a shader samples through the view: the attachment, if a pass of this frame stored it, else the
  /// texels that the capture brings.
  [[nodiscard]] traces::TextureDescriptor texture(const ViewObject& view);
  [[nodiscard]] traces::Index sampler(Handle handle);
  [[nodiscard]] traces::Index sampler(const traces::Sampler& wanted);
  [[nodiscard]] traces::Index shader(Handle module, const ShaderWish& wish);
  /// A clear's output has the location.
  [[nodiscard]] traces::Index own(OwnShader which, std::uint32_t location = 0);
  [[nodiscard]] const ShaderFacts& facts(traces::Index shader) const { return facts_[shader]; }
  [[nodiscard]] traces::Index pipeline(const traces::Pipeline& wanted);
  [[nodiscard]] traces::Index descriptors(const traces::DescriptorSet& wanted);

  /// A vertex attribute, expanded.
  [[nodiscard]] traces::Index expanded_attribute(Handle handle, const AttributeSource& source);
  /// Indices of a draw whose provoking vertex is the last: a buffer of 32-bit ones. Throws `UserError`.
  [[nodiscard]] traces::Index index_buffer(const std::vector<std::uint32_t>& indices);

  void note_stored(Handle image, std::uint32_t level, std::uint32_t layer) {
    stored_.insert({image, level, layer});
  }
  [[nodiscard]] bool stored_part(Handle image, std::uint32_t level, std::uint32_t layer) const {
    return stored_.contains({image, level, layer});
  }
  /// Does a level of a layer hold something when it is loaded: what a pass stored, or what is known from
  /// before?
  [[nodiscard]] bool holds(Handle image, std::uint32_t level, std::uint32_t layer) const;
  /// A pass loads it, or a draw samples it, as it was before the frame.
  void note_needed(const traces::ImagePart& part);
  /// Lets attachments that nobody needs so begin with nothing.
  void forget_unneeded();
  /// What of the capture stands for an attachment, or a buffer, of the stream. Throws `UserError` for none.
  [[nodiscard]] Handle image_of(traces::Index attachment) const;
  [[nodiscard]] Handle buffer_of(traces::Index buffer) const;
  /// Is any part of it stored?
  [[nodiscard]] bool stored(Handle image) const;
  void note_lacking(traces::Index image, std::string_view what) {
    notes_.insert(stream.images[image].name + std::string(what));
  }
  /// What the capture lacks and is taken to be zeros, a line each.
  [[nodiscard]] const std::set<std::string>& notes() const { return notes_; }

 private:
  [[nodiscard]] traces::Index texels(const ViewObject& view);

  const Device& device_;
  struct PlacedBuffer {
    traces::Index index;
    std::uint64_t version;
  };
  std::map<Handle, PlacedBuffer> buffers_;
  struct PlacedImage {
    traces::Index index;
    std::uint64_t writes;  ///< to the image, when it got its place
  };
  std::map<Handle, PlacedImage> attachments_;
  std::map<traces::Index, Handle> placed_images_, placed_buffers_;
  std::set<traces::Index> needed_;  ///< of attachments, as they were before the frame
  std::map<Handle, traces::Index> samplers_;
  std::map<std::tuple<Handle, std::uint64_t, std::uint32_t, std::pair<std::uint32_t, std::uint32_t>>,
           traces::Index>
      textures_;
  std::map<std::tuple<Handle, std::string, traces::ShaderStage, std::map<std::uint32_t, std::uint32_t>, bool,
                      std::uint32_t, std::map<std::uint32_t, std::uint32_t>>,
           traces::Index>
      shaders_;
  std::vector<ShaderFacts> facts_;  ///< by shader
  /// By the buffer's place in the stream, and the source.
  std::map<std::tuple<traces::Index, std::uint32_t, std::uint64_t, std::uint32_t>, traces::Index> expanded_;
  std::map<std::pair<OwnShader, std::uint32_t>, traces::Index> own_;   ///< by location
  std::set<std::tuple<Handle, std::uint32_t, std::uint32_t>> stored_;  ///< image, level, layer
  std::set<std::string> notes_;
};

}  // namespace quadrille::capture
