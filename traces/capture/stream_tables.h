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

class StreamTables {
 public:
  explicit StreamTables(const Device& device) : device_(device) {}
  traces::CommandStream stream;

  [[nodiscard]] traces::Index buffer(Handle handle);
  /// The image as an attachment: it holds nothing until a pass stores it.
  [[nodiscard]] traces::Index attachment(Handle handle);
  /// What a shader samples through the view: the attachment, if a pass of this frame stored it, else the
  /// texels that the capture brings.
  [[nodiscard]] traces::TextureDescriptor texture(const ViewObject& view);
  [[nodiscard]] traces::Index sampler(Handle handle);
  [[nodiscard]] traces::Index sampler(const traces::Sampler& wanted);
  [[nodiscard]] traces::Index shader(Handle module, const ShaderWish& wish);
  [[nodiscard]] traces::Index own(OwnShader which);
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
  /// The buffer holds what passes drew: no draw may use it.
  void note_read_back(Handle buffer) { read_back_.insert(buffer); }
  /// A texture of the texels that the capture brings of the image, whatever passes have stored in it.
  [[nodiscard]] traces::TextureDescriptor own_texels(const ViewObject& view);
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
  std::map<Handle, traces::Index> attachments_, samplers_;
  std::map<std::tuple<Handle, std::uint64_t, std::uint32_t, std::pair<std::uint32_t, std::uint32_t>>,
           traces::Index>
      textures_;
  std::map<std::tuple<Handle, std::string, traces::ShaderStage, std::map<std::uint32_t, std::uint32_t>, bool,
                      std::uint32_t>,
           traces::Index>
      shaders_;
  std::vector<ShaderFacts> facts_;  ///< by shader
  /// By the buffer's place in the stream, and the source.
  std::map<std::tuple<traces::Index, std::uint32_t, std::uint64_t, std::uint32_t>, traces::Index> expanded_;
  std::map<OwnShader, traces::Index> own_;
  std::set<std::tuple<Handle, std::uint32_t, std::uint32_t>> stored_;  ///< image, level, layer
  std::set<Handle> read_back_;
  std::set<std::string> notes_;
};

}  // namespace quadrille::capture
