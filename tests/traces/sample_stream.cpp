#include "tests/traces/sample_stream.h"

#include <algorithm>
#include <bit>
#include <random>

namespace quadrille::traces {
namespace {

constexpr std::uint32_t kSpirvMagic = 0x07230203;

class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}
  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(engine_() % end); }
  bool coin() { return below(2) == 1; }
  float unit() { return static_cast<float>(below(1u << 20)) / (1u << 20); }
  template <class E>
  E choice(E last) {
    return static_cast<E>(below(static_cast<std::uint32_t>(last) + 1));
  }
  std::vector<std::byte> bytes(std::size_t count) {
    std::vector<std::byte> data(count);
    for (std::byte& b : data) b = static_cast<std::byte>(below(256));
    return data;
  }
  std::string name() { return std::string(below(9), static_cast<char>('a' + below(26))); }

 private:
  std::mt19937 engine_;
};

Image random_image(Dice& dice) {
  Image image{dice.name(),
              dice.coin() ? Format::kR8G8B8A8Unorm : Format::kR8G8B8A8Srgb,
              1 + dice.below(9),
              1 + dice.below(9),
              1,
              {},
              nullptr};
  image.levels =
      1 + dice.below(static_cast<std::uint32_t>(std::bit_width(std::max(image.width, image.height))));
  std::size_t bytes = 0;
  for (std::uint32_t i = 0; i < image.levels; ++i)
    bytes += std::size_t{4} * std::max(1u, image.width >> i) * std::max(1u, image.height >> i);
  image.texels = dice.bytes(bytes);
  return image;
}

Pipeline random_pipeline(Dice& dice) {
  Pipeline p;
  p.name = dice.name();
  p.vertex_shader = 0;
  p.fragment_shader = 1;
  p.bindings = {{0, 12, false}, {3, 8, true}};
  p.attributes = {{0, 0, Format::kR32G32B32Float, 0}, {7, 3, Format::kR16G16B16A16Unorm, 0}};
  p.topology = dice.choice(Topology::kLineStrip);
  p.primitive_restart = !models::is_list(p.topology) && dice.coin();
  p.polygon_mode = dice.choice(PolygonMode::kPoint);
  p.line_mode = dice.choice(LineMode::kSmooth);
  p.line_width = 1.0f + static_cast<float>(dice.below(63));
  p.cull = dice.choice(CullMode::kBack);
  p.front = dice.choice(FrontFace::kClockwise);
  p.depth_clamp = dice.coin();
  p.depth = {dice.coin(), dice.coin(), dice.choice(CompareOp::kAlways)};
  p.blend[0] = {dice.coin(),
                dice.choice(BlendFactor::kOneMinusDstAlpha),
                dice.choice(BlendFactor::kOneMinusDstAlpha),
                dice.choice(BlendFactor::kOneMinusDstAlpha),
                dice.choice(BlendFactor::kOneMinusDstAlpha),
                dice.choice(BlendOp::kMax),
                dice.choice(BlendOp::kMax),
                static_cast<std::uint8_t>(dice.below(16))};
  p.viewports = 1 + dice.below(2);
  p.sample_shading = dice.coin();
  p.alpha_to_coverage = dice.coin();
  p.sample_mask = dice.coin() ? dice.below(256) : ~0u;
  return p;
}

/// The pass draws to other images, of several samples a pixel, and resolves the colours to its own.
void add_samples(CommandStream& s, BeginPass& pass, std::uint32_t samples) {
  const auto add = [&](Index like, ImageUsage usage) {
    Image image = s.images[like];
    image.usage = usage;
    image.samples = samples;
    s.images.push_back(std::move(image));
    return static_cast<Index>(s.images.size() - 1);
  };
  pass.colors[0].resolve = pass.colors[0].image;
  pass.colors[0].resolve_layer = pass.colors[0].layer;
  pass.colors[0].image = add(pass.colors[0].image, kColorAttachment);
  pass.depth.image = add(pass.depth.image, kDepthAttachment);
}

void random_commands(Dice& dice, CommandStream& s) {
  auto& c = s.commands;
  BeginPass pass = make_pass(s,
                             {1 + dice.below(16384), 1 + dice.below(16384),
                              dice.coin() ? Format::kR8G8B8A8Srgb : Format::kA2B10G10R10Unorm},
                             {dice.unit(), dice.unit(), dice.unit(), dice.unit()}, dice.unit());
  pass.colors[0].load = dice.coin() ? LoadOp::kClear : LoadOp::kDontCare;
  const std::uint32_t layers = 1 + dice.below(3);
  s.images[pass.colors[0].image].layers = layers;
  pass.colors[0].layer = dice.below(layers);
  for (std::uint32_t& word : pass.colors[0].clear_integers) word = dice.below(256);
  pass.depth.store = dice.choice(StoreOp::kDiscard);
  s.images[pass.colors[0].image].usage |= kSampled;
  if (dice.coin()) add_samples(s, pass, 2u << dice.below(3));
  c.emplace_back(pass);
  c.emplace_back(
      SetViewport{-dice.unit(), dice.unit(), 1 + dice.unit(), -1 - dice.unit(), dice.unit(), dice.unit()});
  c.emplace_back(SetScissor{0, 0, 1, 1});
  c.emplace_back(SetViewport{dice.unit(), dice.unit(), 1 + dice.unit(), 1, 0, dice.unit(), 1});
  c.emplace_back(SetScissor{0, 0, 1, 0, 1});
  c.emplace_back(BindVertexBuffer{0, 0, 4 * dice.below(4)});
  c.emplace_back(BindVertexBuffer{3, 0, 0});
  const auto type = dice.choice(IndexType::kUint32);
  c.emplace_back(BindIndexBuffer{1, type == IndexType::kUint8 ? dice.below(4) : 4, type});
  const bool queried = dice.coin();
  if (queried)
    s.query_pools = {{dice.name(), QueryType::kOcclusion, 0, 6 + dice.below(9)},
                     {dice.name(), QueryType::kPipelineStatistics, kAllStatistics & ~dice.below(7), 6}};
  for (std::uint32_t i = 0; i < 1 + dice.below(6); ++i) {
    c.emplace_back(BindPipeline{dice.below(static_cast<std::uint32_t>(s.pipelines.size()))});
    c.emplace_back(BindDescriptorSet{dice.below(4), 0});
    c.emplace_back(PushConstants{4 * dice.below(8), dice.bytes(4 + 4 * dice.below(8))});
    const bool indexed = dice.coin();
    const std::uint32_t pool = dice.below(2);
    if (queried) c.emplace_back(BeginQuery{pool, i, pool == 0 && dice.coin()});
    c.emplace_back(Draw{indexed, dice.below(7), dice.below(3),
                        indexed ? static_cast<std::int32_t>(dice.below(3)) : 0, dice.below(3), dice.below(2),
                        dice.name()});
    if (queried) c.emplace_back(EndQuery{pool, i});
  }
  c.emplace_back(EndPass{});
}

}  // namespace

CommandStream small_stream() {
  CommandStream s;
  s.name = "small";
  s.buffers = {{"vertices", std::vector<std::byte>(36)},
               {"indices", {std::byte{0}, std::byte{1}, std::byte{2}}},
               {"uniforms", std::vector<std::byte>(64)}};
  s.images = {{"white", Format::kR8G8B8A8Srgb, 2, 1, 2, std::vector<std::byte>(12, std::byte{255}), nullptr}};
  s.samplers = {Sampler{}};
  s.shaders = {{"v", ShaderStage::kVertex, {kSpirvMagic, 0, 0, 0, 0}},
               {"f", ShaderStage::kFragment, {kSpirvMagic, 0, 0, 0, 0}}};
  Pipeline p;
  p.name = "p";
  p.vertex_shader = 0;
  p.fragment_shader = 1;
  p.bindings = {{0, 12, false}};
  p.attributes = {{0, 0, Format::kR32G32B32Float, 0}};
  p.depth = {true, true, CompareOp::kLess};
  s.pipelines = {p};
  s.descriptor_sets = {{{{0, 2, 16, 48}}, {{1, 0, 0}}}};
  const BeginPass pass = make_pass(s, {64, 32});
  s.commands = {pass,
                SetViewport{0, 0, 64, 32, 0, 1},
                SetScissor{0, 0, 64, 32},
                BindPipeline{0},
                BindDescriptorSet{0, 0},
                BindVertexBuffer{0, 0, 0},
                BindIndexBuffer{1, 0, IndexType::kUint8},
                PushConstants{0, std::vector<std::byte>(16)},
                Draw{true, 3, 0, 0, 1, 0, "indexed"},
                Draw{false, 3, 0, 0, 1, 0, "plain"},
                EndPass{}};
  return s;
}

CommandStream random_stream(std::uint32_t seed) {
  Dice dice(seed);
  CommandStream s;
  s.name = dice.name();
  s.buffers = {{dice.name(), dice.bytes(512)},
               {dice.name(), std::vector<std::byte>(64)},
               {dice.name(), dice.bytes(256)}};
  for (std::size_t i = 0; i < 64; ++i)
    s.buffers[1].data[i] = static_cast<std::byte>(i % 4 == 0 ? dice.below(16) : 0);
  for (std::uint32_t i = 0; i < 1 + dice.below(3); ++i) s.images.push_back(random_image(dice));
  s.samplers = {{dice.choice(Filter::kLinear),
                 dice.choice(Filter::kLinear),
                 dice.choice(Filter::kLinear),
                 dice.choice(models::kLastWrap),
                 dice.choice(models::kLastWrap),
                 dice.unit(),
                 dice.unit(),
                 1 + dice.unit(),
                 dice.choice(models::kLastBorder),
                 dice.choice(models::kLastWrap),
                 dice.choice(CompareOp::kAlways),
                 1 + dice.unit(),
                 true,
                 {dice.below(9), dice.below(9), dice.below(9), dice.below(9)}}};
  s.shaders = {{dice.name(), ShaderStage::kVertex, {kSpirvMagic, dice.below(9), 0, 0, dice.below(9)}},
               {"f", ShaderStage::kFragment, {kSpirvMagic, 1, 2, 3, 4}}};
  for (std::uint32_t i = 0; i < 1 + dice.below(4); ++i) s.pipelines.push_back(random_pipeline(dice));
  s.descriptor_sets = {
      {{{dice.below(4), 2, 16 * dice.below(4), 1 + dice.below(192)}}, {{4 + dice.below(9), 0, 0}}}};
  random_commands(dice, s);
  return s;
}

}  // namespace quadrille::traces
