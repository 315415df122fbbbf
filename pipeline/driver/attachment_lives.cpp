#include "pipeline/driver/attachment_lives.h"

#include <algorithm>
#include <map>

#include "models/base/error.h"
#include "traces/attachment_texels.h"

namespace quadrille::pipeline {
namespace {

/// For a message: of an image with one level and one layer, the image alone.
std::string name_of(const traces::CommandStream& stream, const traces::ImagePart& part) {
  const traces::Image& image = stream.images[part.image];
  std::string name = fmt::format("image {} '{}'", part.image, image.name);
  if (image.levels == 1 && image.layers == 1) return name;
  return fmt::format("level {} of layer {} of {}", part.level, part.layer, name);
}

}  // namespace

AttachmentLives::AttachmentLives(const traces::CommandStream& stream) : stream_(stream) {
  std::size_t passes = 0;
  std::map<std::uint32_t, traces::Index> sets;
  const auto attach = [&](const traces::AttachmentUse& use) {
    uses_[use.part()].push_back(
        {passes, true, use.load == traces::LoadOp::kLoad, use.store == traces::StoreOp::kStore});
  };
  for (const traces::Command& command : stream.commands) {
    if (const auto* begin = std::get_if<traces::BeginPass>(&command)) {
      for (const traces::ColorAttachmentUse& color : begin->colors) {
        attach(color);
        if (color.resolve != traces::kNone)
          uses_[color.resolve_part()].push_back({passes, true, false, true});
      }
      if (begin->depth.image != traces::kNone) attach(begin->depth);
    } else if (const auto* bind = std::get_if<traces::BindDescriptorSet>(&command)) {
      sets[bind->set] = bind->descriptors;
    } else if (std::holds_alternative<traces::Draw>(command)) {
      for (const auto& [set, descriptors] : sets)
        for (const traces::TextureDescriptor& t : stream.descriptor_sets[descriptors].textures)
          if (stream.images[t.image].is_attachment()) note_sampled(t, passes);
    } else if (std::holds_alternative<traces::EndPass>(command)) {
      ++passes;
    }
  }
}

void AttachmentLives::note_sampled(const traces::TextureDescriptor& bound, std::size_t pass) {
  for (std::uint32_t layer = bound.layer; layer < bound.layer + bound.layers; ++layer)
    for (std::uint32_t l = 0; l < traces::level_count(stream_, bound); ++l) {
      std::vector<Use>& uses = uses_[{bound.image, bound.first_level + l, layer}];
      if (uses.empty() || uses.back().pass != pass) uses.push_back({pass});
    }
}

bool AttachmentLives::read_after(const traces::ImagePart& part, std::size_t pass) const {
  const auto uses = uses_.find(part);
  if (uses == uses_.end()) return false;
  for (const Use& use : uses->second) {
    if (use.pass > pass) return !use.attached || use.loads;
  }
  return false;
}

void AttachmentLives::check_sampled(const traces::TextureDescriptor& bound, std::size_t pass,
                                    const std::string& program) const {
  if (!stream_.images[bound.image].is_attachment()) return;
  for (std::uint32_t layer = bound.layer; layer < bound.layer + bound.layers; ++layer)
    for (std::uint32_t l = 0; l < traces::level_count(stream_, bound); ++l)
      check_sampled(traces::ImagePart{bound.image, bound.first_level + l, layer}, pass, program);
}

void AttachmentLives::check_sampled(const traces::ImagePart& part, std::size_t pass,
                                    const std::string& program) const {
  bool stored = traces::begins_with_texels(stream_.images[part.image]);
  for (const Use& use : uses_.at(part)) {
    if (!use.attached || use.pass > pass) continue;
    if (use.pass == pass)
      throw user_error("{}: samples {}, which its own pass draws to", program, name_of(stream_, part));
    stored = use.stores;
  }
  if (!stored)
    throw user_error("{}: samples {} before a pass has stored it", program, name_of(stream_, part));
}

}  // namespace quadrille::pipeline
