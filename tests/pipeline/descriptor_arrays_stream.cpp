#include "tests/pipeline/descriptor_arrays_stream.h"

#include "models/base/descriptor_binding.h"
#include "scenes/material/glsl.h"
#include "tests/pipeline/random_source.h"

#include <cstring>
#include <string>

namespace quadrille::pipeline::test {
namespace {

using models::element_binding;
using traces::Index;

constexpr std::uint32_t kWidth = 48, kHeight = 40, kTextures = 5, kSamplers = 3, kBlocks = 4, kBuffers = 2;

constexpr const char* kVertex = R"(#version 450
layout(location = 0) out vec2 at;
layout(set = 1, binding = 7) uniform Move { vec4 by; uint one; } move[4];
void main() {
  vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
  at = corner * 3.0 + move[move[0].one].by.xy;
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
})";

// Bindings 0 and 1 lie closer than the elements of the first array are many.
constexpr const char* kFragment = R"(#version 450
layout(location = 0) in vec2 at;
layout(location = 0) out vec4 o;
layout(set = 0, binding = 0) uniform sampler2D both[5];
layout(set = 0, binding = 1) uniform texture2D pictures[5];
layout(set = 0, binding = 2) uniform sampler samplers[3];
layout(set = 0, binding = 3) uniform sampler2D alone;
layout(set = 1, binding = 7) uniform Move { vec4 by; uint one; } move[4];
//STORAGE
vec4 by_function(uint k) { return texture(both[k], at * 0.5); }
void main() {
  uint one = move[1].one;
  uint square = (uint(gl_FragCoord.x) / 4u + uint(gl_FragCoord.y) / 4u) % 5u;
  vec4 sum = texture(both[2], at) + texture(both[one], at) + texture(alone, at);
  sum += textureLod(both[square], at * 2.0, 0.0);
  sum += texture(sampler2D(pictures[one], samplers[1]), at * 4.0);
  sum += textureLod(sampler2D(pictures[square], samplers[square % 3u]), at * 3.0, 0.0);
  sum += textureGather(both[square], at, 1) * 0.5;
  sum += texelFetch(both[one], ivec2(gl_FragCoord.xy) % 4, 0);
  sum.xy += vec2(textureSize(both[square], 0)) / 64.0;
  sum += move[square % 4u].by + by_function(one);
  for (uint k = 0u; k < 5u; ++k) sum += textureLod(both[k], at + float(k), 0.0) * 0.25;
  //STORE
  o = sum / 12.0;
})";

/// The same with two buffers, of which every square of pixels counts in one.
std::string with_storage(std::string text) {
  const auto put = [&text](const std::string& mark, const std::string& what) {
    text.replace(text.find(mark), mark.size(), what);
  };
  put("//STORAGE", "layout(std430, set = 0, binding = 4) buffer Counts { uint n[64]; } counts[2];");
  put("//STORE",
      "if ((square & 1u) == 0u) atomicAdd(counts[0].n[square], 1u); else atomicAdd(counts[1].n[square], "
      "1u);");
  return text;
}

class Maker {
 public:
  explicit Maker(std::uint64_t seed) : random_(seed) {}

  traces::CommandStream make(bool storage) {
    stream_.name = "descriptor arrays";
    stream_.descriptor_sets.resize(2);
    make_textures();
    make_blocks();
    if (storage) make_buffers();
    const Index vertex = shader(kVertex, traces::ShaderStage::kVertex);
    traces::Pipeline p;
    p.vertex_shader = vertex;
    p.fragment_shader = shader(storage ? with_storage(kFragment) : kFragment, traces::ShaderStage::kFragment);
    stream_.pipelines.push_back(p);
    draw();
    traces::validate(stream_);
    return std::move(stream_);
  }

 private:
  Index shader(const std::string& source, traces::ShaderStage stage) {
    stream_.shaders.push_back({"arrays", stage, scenes::compile_glsl(source, stage, "arrays")});
    return static_cast<Index>(stream_.shaders.size() - 1);
  }

  /// Each of another size.
  Index texture(std::uint32_t number) {
    traces::Image image;
    image.name = "texture " + std::to_string(number);
    image.width = 4u << number % 3;
    image.height = 4u << (number + 1) % 3;
    image.texels.resize(std::size_t{4} * image.width * image.height);
    for (std::byte& byte : image.texels) byte = static_cast<std::byte>(random_.integer(0, 255));
    stream_.images.push_back(std::move(image));
    return static_cast<Index>(stream_.images.size() - 1);
  }

  void make_textures() {
    traces::Sampler nearest, linear, mirrored;
    nearest.mag = nearest.min = models::Filter::kNearest;
    linear.mag = linear.min = models::Filter::kLinear;
    mirrored = linear;
    mirrored.wrap_u = models::Wrap::kMirroredRepeat;
    mirrored.wrap_v = models::Wrap::kClampToEdge;
    stream_.samplers = {nearest, linear, mirrored};
    traces::DescriptorSet& set = stream_.descriptor_sets[0];
    for (std::uint32_t k = 0; k < kTextures; ++k) {
      traces::TextureDescriptor t;
      t.binding = element_binding(0, k);
      t.image = texture(k);
      t.sampler = k % 2 + 1;
      set.textures.push_back(t);
      t.binding = element_binding(1, kTextures - 1 - k);
      t.sampler = traces::kNone;
      set.textures.push_back(t);
    }
    for (std::uint32_t k = 0; k < kSamplers; ++k) set.samplers.push_back({element_binding(2, k), k});
    traces::TextureDescriptor alone;
    alone.binding = 3;
    alone.image = texture(kTextures);
    alone.sampler = 1;
    set.textures.push_back(alone);
  }

  void make_blocks() {
    constexpr std::uint32_t kStride = 256;
    std::vector<std::byte> bytes(std::size_t{kBlocks} * kStride);
    for (std::uint32_t k = 0; k < kBlocks; ++k) {
      const float by[4] = {random_.real(-1, 1), random_.real(-1, 1), random_.real(0, 1), 1};
      const std::uint32_t one = 1 + k % 3;
      std::memcpy(&bytes[std::size_t{k} * kStride], by, sizeof by);
      std::memcpy(&bytes[std::size_t{k} * kStride + 16], &one, 4);
      stream_.descriptor_sets[1].uniforms.push_back({element_binding(7, k), 0, k * kStride, 32});
    }
    stream_.buffers.push_back({"blocks", std::move(bytes)});
  }

  void make_buffers() {
    for (std::uint32_t k = 0; k < kBuffers; ++k) {
      stream_.descriptor_sets[0].buffers.push_back(
          {element_binding(4, k), static_cast<Index>(stream_.buffers.size()), 0, 256});
      stream_.buffers.push_back({"counts", std::vector<std::byte>(256)});
    }
  }

  void draw() {
    auto& c = stream_.commands;
    c.emplace_back(traces::make_pass(stream_, {kWidth, kHeight}));
    c.emplace_back(traces::SetViewport{0, 0, kWidth, kHeight, 0, 1});
    c.emplace_back(traces::SetScissor{0, 0, kWidth, kHeight});
    c.emplace_back(traces::BindPipeline{0});
    c.emplace_back(traces::BindDescriptorSet{0, 0});
    c.emplace_back(traces::BindDescriptorSet{1, 1});
    traces::Draw draw;
    draw.count = 3;
    c.emplace_back(draw);
    c.emplace_back(traces::EndPass{});
  }

  RandomSource random_;
  traces::CommandStream stream_;
};

}  // namespace

traces::CommandStream descriptor_arrays_stream(std::uint64_t seed, bool storage) {
  return Maker(seed).make(storage);
}

}  // namespace quadrille::pipeline::test
