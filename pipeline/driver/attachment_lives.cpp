#include "pipeline/driver/attachment_lives.h"

#include <algorithm>
#include <map>

#include "models/base/error.h"

namespace quadrille::pipeline {

AttachmentLives::AttachmentLives(const traces::CommandStream& stream)
    : stream_(stream), uses_(stream.images.size()) {
  std::size_t passes = 0;
  std::map<std::uint32_t, traces::Index> sets;
  const auto attach = [&](const traces::AttachmentUse& use) {
    uses_[use.image].push_back(
        {passes, true, use.load == traces::LoadOp::kLoad, use.store == traces::StoreOp::kStore});
  };
  for (const traces::Command& command : stream.commands) {
    if (const auto* begin = std::get_if<traces::BeginPass>(&command)) {
      for (const traces::ColorAttachmentUse& color : begin->colors) {
        attach(color);
        if (color.resolve != traces::kNone) uses_[color.resolve].push_back({passes, true, false, true});
      }
      if (begin->depth.image != traces::kNone) attach(begin->depth);
    } else if (const auto* bind = std::get_if<traces::BindDescriptorSet>(&command)) {
      sets[bind->set] = bind->descriptors;
    } else if (std::holds_alternative<traces::Draw>(command)) {
      for (const auto& [set, descriptors] : sets) {
        for (const traces::TextureDescriptor& t : stream.descriptor_sets[descriptors].textures) {
          if (!stream.images[t.image].is_attachment()) continue;
          std::vector<Use>& uses = uses_[t.image];
          if (uses.empty() || uses.back().pass != passes) uses.push_back({passes});
        }
      }
    } else if (std::holds_alternative<traces::EndPass>(command)) {
      ++passes;
    }
  }
}

bool AttachmentLives::read_after(traces::Index image, std::size_t pass) const {
  for (const Use& use : uses_[image]) {
    if (use.pass > pass) return !use.attached || use.loads;
  }
  return false;
}

void AttachmentLives::check_sampled(traces::Index image, std::size_t pass, const std::string& program) const {
  const traces::Image& i = stream_.images[image];
  if (!i.is_attachment()) return;
  bool stored = false;
  for (const Use& use : uses_[image]) {
    if (!use.attached || use.pass > pass) continue;
    if (use.pass == pass)
      throw user_error("{}: samples image {} '{}', which its own pass draws to", program, image, i.name);
    stored = use.stores;
  }
  if (!stored)
    throw user_error("{}: samples image {} '{}' before a pass has stored it", program, image, i.name);
}

}  // namespace quadrille::pipeline
