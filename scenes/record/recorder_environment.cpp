/// The environment of a frame: its map, which materials reflect, and the background that it makes.
#include <string>
#include <utility>

#include "scenes/data/environment_map.h"
#include "scenes/environment/lobe.h"
#include "scenes/material/glsl.h"
#include "scenes/material/shader_sources.h"
#include "scenes/record/recorder.h"

namespace quadrille::scenes {
namespace {

// Bindings of the frame's set (scenes/material/shaders/environment.glsl).
constexpr std::uint32_t kBlockBinding = 1, kMapBinding = 2, kTableBinding = 3;

traces::Sampler smooth() {
  traces::Sampler s;
  s.wrap_u = s.wrap_v = traces::Wrap::kClampToEdge;
  return s;
}

traces::Image map_image(const EnvironmentMap& map) {
  traces::Image image{
      "environment", traces::Format::kR16G16B16A16Float, map.size, map.size, map.levels, map.texels, nullptr};
  image.layers = models::kCubeFaces;
  return image;
}

}  // namespace

void Recorder::add_environment(traces::DescriptorSet& set) {
  const auto add_texture = [&](std::uint32_t binding, traces::Image image, traces::ViewKind view) {
    traces::TextureDescriptor texture;
    texture.binding = binding;
    texture.image = static_cast<traces::Index>(stream_.images.size());
    texture.sampler = sampler(smooth());
    texture.view = view;
    texture.layers = image.layers;
    stream_.images.push_back(std::move(image));
    set.textures.push_back(texture);
  };
  const auto block = static_cast<traces::Index>(stream_.buffers.size());
  stream_.buffers.push_back({"environment", environment_block(*environment_, view_, exposure_)});
  set.uniforms.push_back(
      {kBlockBinding, block, 0, static_cast<std::uint32_t>(stream_.buffers.back().data.size())});
  add_texture(kMapBinding, map_image(*environment_), traces::ViewKind::kCube);
  add_texture(kTableBinding,
              {"specular lobe", traces::Format::kR16G16Float, kLobeTableSide, kLobeTableSide, 1, lobe_table(),
               nullptr},
              traces::ViewKind::k2D);
}

void Recorder::record_background() {
  using traces::ShaderStage;
  const auto shader = [&](ShaderStage stage, const std::string& name, std::string_view text) {
    const std::string whole = "#version 450\n" + std::string(kEnvironmentGlsl) + std::string(text);
    std::vector<std::string> defines{"ENVIRONMENT"};
    if (environment_->turn != glm::mat3(1)) defines.emplace_back("ENVIRONMENT_TURNED");
    stream_.shaders.push_back({name, stage, compile_glsl(whole, stage, name, defines)});
    ++more_shaders_;
    return static_cast<traces::Index>(stream_.shaders.size() - 1);
  };
  traces::Pipeline p;
  p.name = "background";
  p.vertex_shader = shader(ShaderStage::kVertex, "background.vert", kBackgroundVert);
  p.fragment_shader = shader(ShaderStage::kFragment, "background.frag", kBackgroundFrag);
  p.depth = {has_depth(), false, traces::CompareOp::kLessOrEqual};
  bind_once(traces::BindPipeline{static_cast<traces::Index>(stream_.pipelines.size())}, kPipelineSlot);
  stream_.pipelines.push_back(std::move(p));
  traces::Draw draw;
  draw.count = 3;
  draw.label = "background";
  stream_.commands.emplace_back(draw);
}

}  // namespace quadrille::scenes
