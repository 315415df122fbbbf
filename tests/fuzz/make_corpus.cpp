/// Writes the seeds of the corpus below a folder: small files of every kind that our own code makes. What
/// fuzzing adds to it is committed beside them.
///   make_fuzz_corpus tests/fuzz/corpus
#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <string>

#include "models/base/error.h"
#include "scenes/image/image_io.h"
#include "scenes/material/glsl.h"
#include "scenes/scene.h"
#include "tests/fuzz/targets.h"
#include "tests/scenes/gltf_builder.h"
#include "tests/scenes/gltf_text.h"
#include "tests/traces/capture/small_capture.h"
#include "tests/traces/sample_stream.h"
#include "traces/trace_file.h"
#include "traces/whole_file.h"

extern "C" int sc_main(int, char**) { return 0; }

namespace quadrille::fuzz {
namespace {

namespace fs = std::filesystem;

class Corpus {
 public:
  explicit Corpus(fs::path root) : root_(std::move(root)) {
    for (const Target& t : targets()) fs::create_directories(root_ / t.name);
  }
  void write(const std::string& name, Bytes bytes) const {
    traces::write_whole_file((root_ / name).string(), bytes);
  }
  void write(const std::string& name, std::string_view text) const {
    write(name, std::as_bytes(std::span(text)));
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (root_ / name).string(); }

 private:
  fs::path root_;
};

scenes::Rgba8Image checkers(std::uint32_t width, std::uint32_t height) {
  scenes::Rgba8Image image{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i)
    for (const unsigned v : {i * 37U, i * 11U, 255 - i, 255U - (i % 7)})
      image.pixels.push_back(static_cast<std::uint8_t>(v));
  return image;
}

// ---- scenes ----

/// Buffer views and accessors of one buffer, as JSON.
class BufferText {
 public:
  template <class T>
  int add(const std::vector<T>& values, int component, int count, const std::string& type,
          const std::string& more = "") {
    const auto bytes = std::as_bytes(std::span(values));
    views_ += fmt::format("{}{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}", count_ > 0 ? "," : "",
                          data_.size(), bytes.size());
    accessors_ += fmt::format("{}{{\"bufferView\":{},\"componentType\":{},\"count\":{},\"type\":\"{}\"{}}}",
                              count_ > 0 ? "," : "", count_, component, count, type, more);
    data_.insert(data_.end(), bytes.begin(), bytes.end());
    data_.resize((data_.size() + 3) / 4 * 4);
    return count_++;
  }
  [[nodiscard]] std::string text(bool with_uri) const {
    const std::string uri = with_uri ? ",\"uri\":\"" + scenes::data_uri(data_) + "\"" : "";
    return fmt::format("\"bufferViews\":[{}],\"accessors\":[{}],\"buffers\":[{{\"byteLength\":{}{}}}]",
                       views_, accessors_, data_.size(), uri);
  }
  [[nodiscard]] const Buffer& data() const { return data_; }

 private:
  Buffer data_;
  std::string views_, accessors_;
  int count_ = 0;
};

constexpr int kUbyte = 5121, kUshort = 5123, kFloat = 5126;

/// A square of two triangles with every attribute, skin, morph target and animation; `material` and `more`
/// are put in as they are.
std::string rich_scene(const Corpus& corpus, bool with_uri, Buffer* data) {
  BufferText b;
  const std::vector<float> corners{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  b.add(corners, kFloat, 4, "VEC3", R"(,"min":[-1,-1,0],"max":[1,1,0])");
  b.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, 4, "VEC3");
  b.add(std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, kFloat, 4, "VEC4");
  b.add(std::vector<std::uint16_t>{0, 0, 65535, 0, 65535, 65535, 0, 65535}, kUshort, 4, "VEC2",
        R"(,"normalized":true)");
  b.add(std::vector<std::uint8_t>(16, 200), kUbyte, 4, "VEC4", R"(,"normalized":true)");
  b.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, kUshort, 6, "SCALAR");
  b.add(std::vector<std::uint8_t>(16, 0), kUbyte, 4, "VEC4");
  b.add(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kFloat, 4, "VEC4");
  b.add(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, kFloat, 1, "MAT4");
  b.add(std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, kFloat, 4, "VEC3",
        R"(,"min":[0,0,0],"max":[0,0,1])");
  b.add(std::vector<float>{0, 1}, kFloat, 2, "SCALAR", R"(,"min":[0],"max":[1])");
  b.add(std::vector<float>{0, 0, 0, 1, 0, 0.7F, 0, 0.7F}, kFloat, 2, "VEC4");
  b.add(std::vector<float>{0, 1}, kFloat, 2, "SCALAR");
  if (data != nullptr) *data = b.data();
  scenes::save_png(corpus.path("image/checkers.png"), checkers(4, 4));
  const std::string png =
      scenes::data_uri(traces::read_whole_file(corpus.path("image/checkers.png"), 1 << 20))
          .replace(5, 24, "image/png");
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,2,3]}],
"extensionsUsed":["KHR_texture_transform","KHR_lights_punctual","KHR_materials_emissive_strength","KHR_materials_unlit"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":9,"range":50,"spot":{"outerConeAngle":0.5}},{"type":"point"}]}},
"nodes":[{"mesh":0,"skin":0,"children":[1],"rotation":[0,0.1,0,0.99],"scale":[1,2,1]},{"name":"joint","translation":[0,0,0.5]},
{"camera":0,"translation":[0,0,4],"extensions":{"KHR_lights_punctual":{"light":0}}},{"mesh":1,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,1,0,-1,1]}],
"cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1,"zfar":50}},
{"type":"orthographic","orthographic":{"xmag":2,"ymag":2,"znear":0,"zfar":9}}],
"skins":[{"joints":[1],"inverseBindMatrices":8}],
"animations":[{"channels":[{"sampler":0,"target":{"node":1,"path":"rotation"}},{"sampler":1,"target":{"node":0,"path":"weights"}}],
"samplers":[{"input":10,"output":11},{"input":10,"output":12,"interpolation":"STEP"}]}],
"meshes":[{"weights":[0.5],"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TANGENT":2,"TEXCOORD_0":3,"COLOR_0":4,"JOINTS_0":6,"WEIGHTS_0":7},
"indices":5,"material":0,"targets":[{"POSITION":9}]}]},{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":3},"mode":5,"material":1}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"offset":[0.1,0],"rotation":0.3,
"scale":[2,2]}}},"metallicRoughnessTexture":{"index":1},"baseColorFactor":[1,0.9,0.8,1]},"normalTexture":{"index":1,"scale":0.7},
"occlusionTexture":{"index":1},"emissiveTexture":{"index":0},"emissiveFactor":[0.1,0.2,0.3],
"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":2}},"alphaMode":"MASK","doubleSided":true},
{"alphaMode":"BLEND","extensions":{"KHR_materials_unlit":{}},"pbrMetallicRoughness":{"baseColorFactor":[0.2,0.4,0.9,0.5]}}],
"textures":[{"source":0,"sampler":0},{"source":0}],"samplers":[{"magFilter":9728,"minFilter":9987,"wrapS":33071,"wrapT":33648}],
"images":[{"uri":")" +
         png + "\"}]," + b.text(with_uri) + "}";
}

Buffer binary_gltf(std::string text, Buffer data) {
  text.resize((text.size() + 3) / 4 * 4, ' ');
  data.resize((data.size() + 3) / 4 * 4);
  Buffer out;
  const auto append = [&out](Bytes bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); };
  const auto word = [&append](std::size_t value) {
    const auto v = static_cast<std::uint32_t>(value);
    append(std::as_bytes(std::span(&v, 1)));
  };
  for (const std::size_t value : {std::size_t{0x46546c67}, std::size_t{2}, 28 + text.size() + data.size(),
                                  text.size(), std::size_t{0x4e4f534a}})
    word(value);
  append(std::as_bytes(std::span(text)));
  word(data.size());
  word(0x004e4942);
  append(data);
  return out;
}

void write_scenes(const Corpus& corpus) {
  corpus.write("scene/triangle.gltf", scenes::triangle_gltf());
  corpus.write("scene/strip.gltf", scenes::triangle_gltf(R"(,"mode":5)"));
  corpus.write("scene/fan.gltf", scenes::triangle_gltf(R"(,"mode":6)"));
  corpus.write("scene/points.gltf", scenes::triangle_gltf(R"(,"mode":0)"));
  corpus.write("scene/scale.gltf", scenes::triangle_gltf("", "", R"(,"scale":[1e30,1e-30,0])"));
  corpus.write("scene/empty.gltf", R"({"asset":{"version":"2.0"}})");
  corpus.write(
      "scene/loop.gltf",
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}]})");
  scenes::ArmOptions two_sets;
  two_sets.second_set = two_sets.wide_joints = true;
  two_sets.weight_bits = 16;
  corpus.write("scene/skin.gltf", scenes::arm_gltf());
  corpus.write("scene/skin_two_sets.gltf", scenes::arm_gltf(two_sets));
  corpus.write("scene/morph.gltf", scenes::morph_gltf(4, "[0.5,0,1,0]"));
  corpus.write("scene/rich.gltf", rich_scene(corpus, true, nullptr));
  Buffer data;
  const std::string text = rich_scene(corpus, false, &data);
  corpus.write("scene/rich.glb", binary_gltf(text, data));
}

// ---- the others ----

std::vector<std::uint32_t> glsl(traces::ShaderStage stage, std::string_view text) {
  return scenes::compile_glsl(text, stage, "seed");
}

void write_spirv(const Corpus& corpus, const std::string& scene) {
  const auto write = [&](const std::string& name, const std::vector<std::uint32_t>& words) {
    corpus.write("spirv/" + name + ".spv", std::as_bytes(std::span(words)));
  };
  constexpr std::string_view kHead =
      "#version 450\nlayout(location=0) in vec4 a; layout(location=1) in vec4 b; layout(location=2) flat in "
      "ivec4 i;\n"
      "layout(location=0) out vec4 color;\nlayout(set=1, binding=0) uniform sampler2D t;\n"
      "layout(set=0, binding=1, std140) uniform U { mat4 m; vec4 l[4]; int n; } u;\nlayout(push_constant) "
      "uniform P { vec4 p; } c;\n";
  const auto fragment = [&](const std::string& name, const std::string& body) {
    write(name, glsl(traces::ShaderStage::kFragment, std::string(kHead) + body));
  };
  fragment("plain", "void main() { color = a; }");
  fragment("loop",
           "void main() { vec4 s = a; for (int k = 0; k < i.x; ++k) { if (s.x > 3.0) break; if (s.y < 0.0) "
           "continue; s = s * b + u.l[k & "
           "3]; } color = s; }");
  fragment("switch",
           "void main() { vec4 s = a; switch (i.y) { case 0: s *= 2.0; case 1: s -= b; break; default: s = "
           "normalize(s); } color = u.m * s; }");
  fragment("texture",
           "void main() { if (a.x < 0.5) discard; color = texture(t, a.xy, 0.5) + textureLod(t, b.xy, 2.0) * "
           "vec4(textureSize(t, 0), 0, 1) "
           "+ c.p; }");
  fragment("calls",
           "float f(float x) { return x > 0.0 ? sqrt(x) : exp2(x); }\nvoid main() { float r[4]; for (int k = "
           "0; k < 4; ++k) r[k] = "
           "f(a[k]); color = vec4(r[i.x & 3], dFdx(a.y), fwidth(b.x), pow(a.x, b.x)); }");
  fragment("depth",
           "void main() { gl_FragDepth = gl_FragCoord.z * 0.5; color = gl_FrontFacing ? a : mix(a, b, "
           "bvec4(i)); }");
  fragment("endless",
           "void main() { vec4 s = a; while (true) { s += b; if (s.x > 1e30) break; } color = s; }");
  fragment("integers",
           "void main() { uvec4 k = uvec4(i); k = (k << 3u) ^ (k >> 1u) | bitfieldReverse(k); color = vec4(k "
           "% 7u) * vec4(i / 3) * "
           "uintBitsToFloat(k.x & 0x3fffffffu); }");
  write("vertex", glsl(traces::ShaderStage::kVertex,
                       "#version 450\nlayout(location=0) in vec3 p; layout(location=1) in vec4 q; "
                       "layout(location=0) out vec4 v;\n"
                       "layout(set=0, binding=0) uniform U { mat4 m; } u;\nvoid main() { v = q * "
                       "float(gl_VertexIndex + gl_InstanceIndex); "
                       "gl_Position = u.m * vec4(p, 1); }"));
  scenes::SceneOptions options;
  options.width = options.height = 8;
  for (const traces::Shader& shader : scenes::load_scene(scene, options).shaders)
    if (shader.spirv.size() < 4000)
      write(shader.stage == traces::ShaderStage::kVertex ? "material_vertex" : "material_fragment",
            shader.spirv);
}

void write_traces(const Corpus& corpus, const std::string& scene) {
  corpus.write("trace/small.qtrace", traces::encode_trace(traces::small_stream()));
  traces::CommandStream queried = traces::small_stream();
  traces::query_everything(queried);
  corpus.write("trace/queries.qtrace", traces::encode_trace(queried));
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    const Buffer file = traces::encode_trace(traces::random_stream(seed));
    if (file.size() < 20000) corpus.write(fmt::format("trace/random{}.qtrace", seed), file);
  }
  scenes::SceneOptions options;
  options.width = options.height = 8;
  corpus.write("trace/triangle.qtrace",
               traces::encode_trace(scenes::load_scene("builtin:triangle", options)));
  corpus.write("trace/rich.qtrace", traces::encode_trace(scenes::load_scene(scene, options)));
  options.transparency = {traces::Transparency::kKbuffer, 3};
  corpus.write("trace/kept.qtrace", traces::encode_trace(scenes::load_scene("builtin:glass", options)));
}

void write_captures(const Corpus& corpus) {
  using capture::Packing;
  corpus.write("capture/plain", capture::small_capture());
  corpus.write("capture/lz4", capture::small_capture({.packing = Packing::kLz4}));
  corpus.write("capture/zstd", capture::small_capture({.packing = Packing::kZstd}));
  corpus.write("capture/loads", capture::small_capture({.negative_one_to_one = true, .loads = true}));
  const nlohmann::json fill{{"dstBuffer", capture::kVertices}, {"dstOffset", 4}, {"size", 8}, {"data", 7}};
  const nlohmann::json clear{
      {"image", capture::kShown},
      {"pColor", nlohmann::json::array({0, 1, 2, 3})},
      {"pRanges", nlohmann::json::array({{{"aspectMask", 1}, {"levelCount", 1}, {"layerCount", 1}}})}};
  corpus.write("capture/copies",
               capture::small_capture(
                   {.loads = true, .before = {{"CmdFillBuffer", fill}, {"CmdClearColorImage", clear}}}));
}

void write_images(const Corpus& corpus) {
  scenes::save_png(corpus.path("image/one.png"), checkers(1, 1));
  scenes::save_png(corpus.path("image/wide.png"), checkers(33, 2));
  scenes::save_exr(corpus.path("image/three.exr"), {3, 2, 3, std::vector<float>(18, 0.5F)});
  scenes::save_exr(corpus.path("image/depth.exr"), {5, 4, 1, std::vector<float>(20, 0.25F)});
  corpus.write("image/empty", "");
}

void write_machines(const Corpus& corpus) {
  corpus.write("machine/small.toml",
               "name = \"small\"\n[gpu]\ncores = 1\nclock_mhz = 1e3\n[link.core_to_rop]\ndepth = 2\n");
  corpus.write("machine/dotted.toml",
               "gpu.cores = 2\nlink.client_to_l2 = {depth = 4, latency = 9}\ntexture.cache_lines=0x40\n");
  corpus.write(
      "machine/settings",
      "gpu.cores=4\ngpu.clock_mhz=1.5e3\nrop.cache_lines=32\nlink.rop_to_depth.latency=1000000\n=\n.=.\n");
  corpus.write("machine/wrong.toml", "[gpu]\ncores = \"two\"\nclock = 1\n[[depth]]\nx = 1979-05-27\n");
  corpus.write("machine/numbers.toml",
               "[gpu]\ncores = -1\nclock_mhz = nan\nmemory_mhz = inf\nmemory_mib = 9223372036854775807\n");
}

void write_all(const Corpus& corpus) {
  write_scenes(corpus);
  write_spirv(corpus, corpus.path("scene/rich.gltf"));
  write_traces(corpus, corpus.path("scene/rich.gltf"));
  write_captures(corpus);
  write_images(corpus);
  write_machines(corpus);
}

}  // namespace
}  // namespace quadrille::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: make_fuzz_corpus FOLDER\n");
    return 2;
  }
  try {
    quadrille::fuzz::write_all(quadrille::fuzz::Corpus(argv[1]));
    return 0;
  } catch (const quadrille::UserError& error) {
    fmt::print(stderr, "make_fuzz_corpus: {}\n", error.what());
    return 2;
  }
}
