#include "scenes/gltf/texture.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"

namespace quadrille::scenes {
namespace {

class TextureReader {
 public:
  TextureReader(const GltfFile& file, const std::string& place) : file_(file), place_(place) {}

  TextureUse read(const TextureMention& mention) const {
    if (mention.index < 0) return {};
    const auto& textures = file_.model.textures;
    if (static_cast<std::size_t>(mention.index) >= textures.size())
      fail(fmt::format("texture {} does not exist (the file has {})", mention.index, textures.size()));
    const tinygltf::Texture& source = textures[static_cast<std::size_t>(mention.index)];
    TextureUse use;
    use.image = image(source, fmt::format("textures[{}]", mention.index));
    if (use.image < 0) return {};
    use.sampler = sampler(source.sampler, mention.index);
    use.uv_set = mention.uv_set;
    if (mention.transform != nullptr) transform(use, *mention.transform);
    if (use.uv_set < 0 || use.uv_set > 1)
      fail(fmt::format("texCoord {} is not supported; sets 0 and 1 are", use.uv_set));
    return use;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw user_error("{}: {}: {}", file_.path, place_, reason);
  }

  /// A texture may lack a source when an extension we do not know provides it; it then has no image.
  int image(const tinygltf::Texture& source, const std::string& place) const {
    const std::size_t images = file_.model.images.size();
    for (const char* name : {"EXT_texture_webp", "MSFT_texture_dds"}) {
      const auto found = source.extensions.find(name);
      if (found != source.extensions.end())
        return GltfObject(file_.path, place + "." + name, found->second).index("source", images);
    }
    if (source.source < 0) {
      if (source.extensions.contains("KHR_texture_basisu"))
        throw user_error("{}: {}: its only image is KHR_texture_basisu's; Basis textures are not supported",
                         file_.path, place);
      return -1;
    }
    if (static_cast<std::size_t>(source.source) >= images)
      throw user_error("{}: {}.source: image {} does not exist (the file has {})", file_.path, place,
                       source.source, images);
    return source.source;
  }

  double finite(double value) const {
    if (!std::isfinite(static_cast<float>(value))) fail("KHR_texture_transform: not a finite number");
    return value;
  }

  double member_number(const tinygltf::Value& value) const {
    if (!value.IsNumber()) fail("KHR_texture_transform: a number is due");
    return finite(value.GetNumberAsDouble());
  }

  glm::dvec2 pair(const tinygltf::Value& extension, const char* name, glm::dvec2 absent) const {
    if (!extension.Has(name)) return absent;
    const tinygltf::Value& value = extension.Get(name);
    if (!value.IsArray() || value.ArrayLen() != 2)
      fail(fmt::format("KHR_texture_transform.{}: two numbers are due", name));
    return {member_number(value.Get(0)), member_number(value.Get(1))};
  }

  /// Offset after rotation after scale; a positive angle turns the image clockwise. [KHR_texture_transform,
  /// its example and its test scene]
  void transform(TextureUse& use, const tinygltf::Value& extension) const {
    const glm::dvec2 offset = pair(extension, "offset", {0, 0}), scale = pair(extension, "scale", {1, 1});
    const double angle = extension.Has("rotation") ? member_number(extension.Get("rotation")) : 0.0;
    const double c = std::cos(angle), s = std::sin(angle);
    use.u_row = glm::vec3(glm::dvec3(c * scale.x, s * scale.y, offset.x));
    use.v_row = glm::vec3(glm::dvec3(-s * scale.x, c * scale.y, offset.y));
    use.transformed = use.u_row != glm::vec3(1, 0, 0) || use.v_row != glm::vec3(0, 1, 0);
    if (extension.Has("texCoord"))
      use.uv_set = static_cast<int>(std::clamp(member_number(extension.Get("texCoord")), -1.0, 1e6));
  }

  traces::Wrap wrap(int value, int sampler_index) const {
    switch (value) {
      case TINYGLTF_TEXTURE_WRAP_REPEAT: return traces::Wrap::kRepeat;
      case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT: return traces::Wrap::kMirroredRepeat;
      case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE: return traces::Wrap::kClampToEdge;
      default:
        throw user_error("{}: samplers[{}]: wrap mode {} is not one of glTF's", file_.path, sampler_index,
                         value);
    }
  }

  void minification(traces::Sampler& s, int filter, int sampler_index) const {
    // keeps min and mag filter apart without mip-mapping [VK1.3 #samplers, on GL_LINEAR and GL_NEAREST]
    constexpr float kBaseLevelOnly = 0.25F;
    using traces::Filter;
    const auto set = [&](Filter min, Filter mip, float max_lod) {
      s.min = min, s.mip = mip, s.max_lod = max_lod;
    };
    constexpr float kAllLevels = 1000;
    switch (filter) {
      case -1:
      case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
        return set(Filter::kLinear, Filter::kLinear, kAllLevels);
      case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
        return set(Filter::kLinear, Filter::kNearest, kAllLevels);
      case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
        return set(Filter::kNearest, Filter::kLinear, kAllLevels);
      case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
        return set(Filter::kNearest, Filter::kNearest, kAllLevels);
      case TINYGLTF_TEXTURE_FILTER_LINEAR: return set(Filter::kLinear, Filter::kNearest, kBaseLevelOnly);
      case TINYGLTF_TEXTURE_FILTER_NEAREST: return set(Filter::kNearest, Filter::kNearest, kBaseLevelOnly);
      default:
        throw user_error("{}: samplers[{}]: minFilter {} is not one of glTF's", file_.path, sampler_index,
                         filter);
    }
  }

  traces::Sampler sampler(int index, int texture_index) const {
    traces::Sampler s;
    if (index < 0) return s;
    if (static_cast<std::size_t>(index) >= file_.model.samplers.size()) {
      throw user_error("{}: textures[{}].sampler: sampler {} does not exist (the file has {})", file_.path,
                       texture_index, index, file_.model.samplers.size());
    }
    const tinygltf::Sampler& source = file_.model.samplers[static_cast<std::size_t>(index)];
    s.wrap_u = wrap(source.wrapS, index);
    s.wrap_v = wrap(source.wrapT, index);
    if (source.magFilter != -1 && source.magFilter != TINYGLTF_TEXTURE_FILTER_LINEAR &&
        source.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST) {
      throw user_error("{}: samplers[{}]: magFilter {} is not one of glTF's", file_.path, index,
                       source.magFilter);
    }
    s.mag = source.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ? traces::Filter::kNearest
                                                                : traces::Filter::kLinear;
    minification(s, source.minFilter, index);
    return s;
  }

  const GltfFile& file_;
  std::string place_;
};

}  // namespace

TextureMention mention_of(const GltfObject& object, const char* name) {
  if (!object.has(name)) return {};
  const GltfObject info = object.object(name);
  TextureMention mention{
      static_cast<int>(std::min<std::uint64_t>(info.required_integer("index"), 0x7fffffff)),
      static_cast<int>(std::min<std::uint64_t>(info.integer("texCoord", 0), 1000)), nullptr};
  if (!info.has("extensions")) return mention;
  const tinygltf::Value& extensions = info.value().Get("extensions");
  if (extensions.IsObject() && extensions.Has("KHR_texture_transform"))
    mention.transform = &extensions.Get("KHR_texture_transform");
  return mention;
}

TextureUse read_texture(const GltfFile& file, const TextureMention& mention, const std::string& place) {
  return TextureReader(file, place).read(mention);
}

}  // namespace quadrille::scenes
