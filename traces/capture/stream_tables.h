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

#include "traces/capture/device.h"
#include "traces/capture/shader_words.h"

namespace quadrille::capture {

class StreamTables {
 public:
  explicit StreamTables(const Device& device) : device_(device) {}
  traces::CommandStream stream;

  [[nodiscard]] traces::Index buffer(Handle handle);
  /// The image as an attachment: it holds nothing until a pass stores it.
  [[nodiscard]] traces::Index attachment(Handle image);
  /// What a shader samples through the view: the attachment, if a pass of this frame stored it, else the
  /// texels that the capture brings.
  [[nodiscard]] traces::TextureDescriptor texture(Handle view);
  [[nodiscard]] traces::Index sampler(Handle handle);
  [[nodiscard]] traces::Index shader(Handle module, const ShaderWish& wish);
  [[nodiscard]] const ShaderFacts& facts(traces::Index shader) const { return facts_[shader]; }
  [[nodiscard]] traces::Index pipeline(const traces::Pipeline& wanted);
  [[nodiscard]] traces::Index descriptors(const traces::DescriptorSet& wanted);

  void note_stored(Handle image) { stored_.insert(image); }
  [[nodiscard]] bool stored(Handle image) const { return stored_.contains(image); }

 private:
  [[nodiscard]] traces::Index texels(Handle image, const ViewObject& view);

  const Device& device_;
  struct PlacedBuffer {
    traces::Index index;
    std::uint64_t version;
  };
  std::map<Handle, PlacedBuffer> buffers_;
  std::map<Handle, traces::Index> attachments_, samplers_;
  std::map<std::tuple<Handle, std::uint64_t, std::uint32_t, std::array<std::uint32_t, 4>, std::uint32_t>,
           traces::Index>
      textures_;
  std::map<std::tuple<Handle, std::string, traces::ShaderStage, std::map<std::uint32_t, std::uint32_t>, bool>,
           traces::Index>
      shaders_;
  std::vector<ShaderFacts> facts_;  ///< by shader
  std::set<Handle> stored_;
};

}  // namespace quadrille::capture
