#include "scenes/material/shader_library.h"

#include <cstdio>
#include <cstring>
#include <filesystem>

#include "models/base/error.h"
#include "scenes/material/glsl.h"
#include "scenes/material/shader_pack.h"
#include "scenes/material/shader_sources.h"
#include "scenes/material/spirv_entry.h"
#include "traces/whole_file.h"

/// The file that scenes/material/make_shader_pack.cpp wrote, put into the program by the assembler.
extern "C" const std::uint32_t quadrille_shader_pack[];

namespace quadrille::scenes {
namespace {

constexpr std::uint64_t kMaxShaderBytes = 1 << 24;

std::vector<std::uint32_t> spirv_words(const std::vector<std::byte>& bytes, const std::string& path) {
  if (bytes.size() < 20 || bytes.size() % 4 != 0)
    throw user_error("{}: not SPIR-V ({} bytes)", path, bytes.size());
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), bytes.size());
  if (words[0] != 0x07230203) throw user_error("{}: not SPIR-V (its first word is {:#010x})", path, words[0]);
  return words;
}

}  // namespace

ShaderLibrary::Source ShaderLibrary::read_source(traces::ShaderStage stage, const std::string& path) {
  const std::vector<std::byte> bytes = traces::read_whole_file(path, kMaxShaderBytes);
  if (std::filesystem::path(path).extension() == ".spv") {
    Source source{path, {}, spirv_words(bytes, path)};
    std::string note;
    call_entry_point_main(source.spirv, stage, path, note);
    if (!note.empty()) std::fprintf(stderr, "%s\n", note.c_str());
    return source;
  }
  return {path, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), {}};
}

ShaderLibrary::ShaderLibrary(const SceneOptions& options, std::vector<std::string> frame_defines,
                             std::vector<traces::Shader>& shaders)
    : leave_out_(options.leave_out), frame_defines_(std::move(frame_defines)), shaders_(shaders) {
  set_ = shader_set(options);
  const auto source = [this](traces::ShaderStage stage, const std::string& path) {
    return path.empty() ? Source{std::string(material_shader_name(stage, set_)), {}, {}, true}
                        : read_source(stage, path);
  };
  vertex_ = source(traces::ShaderStage::kVertex, options.vertex_shader);
  if (options.visibility)
    fragment_ = {"visibility.frag",
                 std::string(kInterfaceGlsl) + std::string(kMaterialGlsl) + std::string(kVisibilityFrag),
                 {}};
  else fragment_ = source(traces::ShaderStage::kFragment, options.fragment_shader);
}

std::vector<std::string> ShaderLibrary::defines(traces::ShaderStage stage, const Source& source,
                                                const Variant& variant) const {
  if (source.material) return material_shader_defines(stage, variant, frame_defines_);
  std::vector<std::string> all = frame_defines_;
  all.insert(all.end(), variant.defines.begin(), variant.defines.end());
  if (variant.instanced && stage == traces::ShaderStage::kVertex) all.emplace_back("INSTANCED");
  return all;
}

std::vector<std::uint32_t> ShaderLibrary::spirv(traces::ShaderStage stage, const Source& source,
                                                const std::vector<std::string>& defines) {
  if (!source.spirv.empty()) return source.spirv;
  static const ShaderPack pack(quadrille_shader_pack);
  if (source.material && leave_out_) {
    const std::span<const std::uint32_t> ready = pack.find(shader_key(stage, defines));
    if (!ready.empty()) return {ready.begin(), ready.end()};
  }
  ++compiled_;
  return compile_glsl(source.material ? material_shader_glsl(stage, set_) : source.glsl, stage, source.name,
                      defines);
}

traces::Index ShaderLibrary::shader(traces::ShaderStage stage, const Variant& variant) {
  const Source& source = stage == traces::ShaderStage::kVertex ? vertex_ : fragment_;
  const std::vector<std::string> wanted = defines(stage, source, variant);
  const std::string key = source.spirv.empty() ? shader_key(stage, wanted) : std::string();
  const auto [entry, added] = known_.try_emplace({stage, key}, static_cast<traces::Index>(shaders_.size()));
  if (added) shaders_.push_back({source.name, stage, spirv(stage, source, wanted)});
  return entry->second;
}

}  // namespace quadrille::scenes
