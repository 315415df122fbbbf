/// Gives the passes of a stream several samples a pixel.
#include <algorithm>

#include "models/base/error.h"
#include "traces/command_stream.h"

namespace quadrille::traces {
namespace {

class SampleAdder {
 public:
  SampleAdder(CommandStream& stream, std::uint32_t samples) : stream_(stream), samples_(samples) {}

  void run() {
    if (samples_ == 1) return;
    for (const Image& image : stream_.images)
      if (image.samples > 1) throw user_error("it has images of {} samples a pixel already", image.samples);
    bool last_changed = false;
    for (Command& command : stream_.commands) {
      auto* const pass = std::get_if<BeginPass>(&command);
      if (pass == nullptr) continue;
      last_changed = may_change(*pass);
      if (last_changed) change(*pass);
    }
    if (!last_changed)
      throw user_error(
          "its last pass loads an attachment, or others read its depth: it cannot have {} samples "
          "a pixel",
          samples_);
  }

 private:
  [[nodiscard]] bool may_change(const BeginPass& pass) const {
    const bool loads =
        std::ranges::any_of(pass.colors, [](const AttachmentUse& use) { return use.load == LoadOp::kLoad; });
    if (loads || pass.depth.load == LoadOp::kLoad) return false;
    return pass.depth.image == kNone || !others_read(pass.depth.image);
  }
  /// Some pass loads the depth, or a set may name it.
  [[nodiscard]] bool others_read(Index depth) const {
    if ((stream_.images[depth].usage & kSampled) != 0) return true;
    return std::ranges::any_of(stream_.commands, [&](const Command& command) {
      const auto* const pass = std::get_if<BeginPass>(&command);
      return pass != nullptr && pass->depth.image == depth && pass->depth.load == LoadOp::kLoad;
    });
  }

  void change(BeginPass& pass) {
    for (ColorAttachmentUse& color : pass.colors) {
      color.resolve = color.image;
      color.resolve_level = color.level, color.resolve_layer = color.layer;
      attach(color, kColorAttachment);
      color.store = StoreOp::kDiscard;
    }
    if (pass.depth.image != kNone) attach(pass.depth, kDepthAttachment);
  }

  /// Puts an image of several samples in the place of what is drawn to.
  void attach(AttachmentUse& use, ImageUsage usage) {
    Image image = stream_.images[use.image];
    image.name += ", samples";
    image.width = level_width(image, use.level);
    image.height = level_height(stream_.images[use.image], use.level);
    image.levels = image.layers = 1;
    image.kind = ImageKind::k2D;
    image.usage = usage;
    image.texels.clear();
    image.samples = samples_;
    stream_.images.push_back(std::move(image));
    use.image = static_cast<Index>(stream_.images.size() - 1);
    use.level = use.layer = 0;
  }

  CommandStream& stream_;
  std::uint32_t samples_;
};

}  // namespace

void use_samples(CommandStream& stream, std::uint32_t samples) { SampleAdder(stream, samples).run(); }

void use_sample_shading(CommandStream& stream) {
  for (Pipeline& pipeline : stream.pipelines) pipeline.sample_shading = true;
}

void use_anisotropy(CommandStream& stream, float samples) {
  for (Sampler& sampler : stream.samplers)
    if (sampler.mag == Filter::kLinear && sampler.min == Filter::kLinear && sampler.mip == Filter::kLinear)
      sampler.max_anisotropy = samples;
}

}  // namespace quadrille::traces
