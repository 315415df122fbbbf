/// The part of the recorder that materials need: uniform blocks, textures with their mip chains, samplers,
/// and the sets that bind them.
#include <algorithm>
#include <cstring>
#include <optional>
#include <set>

#include "models/texture/block/block_format.h"
#include "scenes/data/parallel.h"
#include "scenes/image/mip_chain.h"
#include "scenes/image/texture_file.h"
#include "scenes/material/spirv_bindings.h"
#include "scenes/record/recorder.h"
#include "scenes/view/exposure.h"

namespace quadrille::scenes {
namespace {

/// `Material` of scenes/material/shaders/material.glsl, std140.
struct MaterialBlock {
  glm::vec4 base_color, emissive, factors;
  std::array<glm::vec4, 2 * kBaseTextureSlots> uv_rows;
};

/// What follows it where the material has layers.
struct LayerBlock {
  glm::vec4 specular, clearcoat, sheen, transmission;
  std::array<glm::vec4, 2 * (kTextureSlots - kBaseTextureSlots)> uv_rows;
};

MaterialBlock material_values(const Material& m, float exposure) {
  MaterialBlock block{m.base_color,
                      glm::vec4(exposed(m.emissive, exposure), m.alpha_cutoff),
                      {m.metallic, m.roughness, m.normal_scale, m.occlusion_strength},
                      {}};
  for (std::size_t slot = 0; slot < kBaseTextureSlots; ++slot) {
    block.uv_rows[2 * slot] = glm::vec4(m.textures[slot].u_row, 0);
    block.uv_rows[2 * slot + 1] = glm::vec4(m.textures[slot].v_row, 0);
  }
  return block;
}

LayerBlock layer_values(const Material& m) {
  const MaterialLayers& l = m.layers;
  LayerBlock block{glm::vec4(l.specular_color, l.specular_weight),
                   glm::vec4(l.clearcoat, l.clearcoat_roughness, l.clearcoat_normal_scale, 0),
                   glm::vec4(l.sheen_color, l.sheen_roughness),
                   glm::vec4(l.absorption, l.transmission),
                   {}};
  for (std::size_t slot = kBaseTextureSlots; slot < kTextureSlots; ++slot) {
    const std::size_t row = 2 * (slot - kBaseTextureSlots);
    block.uv_rows[row] = glm::vec4(m.textures[slot].u_row, 0);
    block.uv_rows[row + 1] = glm::vec4(m.textures[slot].v_row, 0);
  }
  return block;
}

template <class T>
std::vector<std::byte> bytes_of(const T& value) {
  std::vector<std::byte> bytes(sizeof(T));
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

bool is_srgb(std::size_t slot) {
  const auto role = static_cast<TextureSlot>(slot);
  return role == TextureSlot::kBaseColor || role == TextureSlot::kEmissive ||
         role == TextureSlot::kSpecularColor || role == TextureSlot::kSheenColor;
}

/// A texture with the levels of its file. Blocks stay blocks, but where they hold signed numbers or halves,
/// or have no format with sRGB where that is due.
traces::Image file_image(const SceneImage& source, bool srgb) {
  const TextureFile& file = *source.file();
  const std::optional<traces::Format> blocks =
      file.code ? models::block_format(*file.code, srgb) : std::nullopt;
  const auto packed = std::make_shared<const traces::UnpackTexels>(
      [file = source.file(), stored = blocks.has_value()](const traces::LevelSink& sink) {
        for (std::uint32_t level = 0; level < file->levels; ++level) {
          if (stored) {
            sink(level, stored_level(*file, level));
            continue;
          }
          const Rgba8Image picture = decoded_level(*file, level);
          sink(level, std::as_bytes(std::span(picture.pixels)));
        }
      });
  const auto format = blocks.value_or(srgb ? traces::Format::kR8G8B8A8Srgb : traces::Format::kR8G8B8A8Unorm);
  return {source.name(), format, file.width, file.height, file.levels, {}, packed};
}

}  // namespace

const Variant& Recorder::variant(const Primitive& primitive) {
  std::array<bool, kSemantics> available{};
  for (std::size_t i = 0; i < kSemantics; ++i) available[i] = primitive.attributes[i] >= 0;
  const bool by_corners = primitive.style.polygon_mode == traces::PolygonMode::kPoint;
  const auto [entry, added] =
      variants_.try_emplace({primitive.material, available, primitive.partial_normals, primitive.topology,
                             by_corners, primitive.style.point_size});
  if (added) {
    const Material& material = scene_.materials[static_cast<std::size_t>(primitive.material)];
    const int colors = material.textures[static_cast<std::size_t>(TextureSlot::kBaseColor)].image;
    const bool file_colors = colors >= 0 && scene_.images[static_cast<std::size_t>(colors)].file() != nullptr;
    entry->second = choose_variant(material, primitive, shaders_.set(), options_.alpha_to_coverage,
                                   options_.samples, file_colors);
    if (shaders_.set() == ShaderSet::kUser && options_.leave_out) leave_out_unread(entry->second);
  }
  return entry->second;
}

/// A shader of the user's is offered every texture of a material; most look at few.
void Recorder::leave_out_unread(Variant& v) {
  std::set<std::uint32_t> read;
  for (const traces::Index shader : {shaders_.vertex(v), shaders_.fragment(v)})
    read.merge(mentioned_bindings(stream_.shaders[shader].spirv, kMaterialSet));
  for (std::size_t slot = 0; slot < kTextureSlots; ++slot)
    v.textures[slot] = v.textures[slot] && read.contains(static_cast<std::uint32_t>(1 + slot));
}

void Recorder::add_textures(const std::vector<TextureKey>& keys) {
  const auto source = [this](const TextureKey& key) -> const SceneImage& {
    return scene_.images[static_cast<std::size_t>(key.image)];
  };
  unpack_images(keys);
  const std::size_t first = stream_.images.size();
  for (const TextureKey& key : keys) {
    if (source(key).file() != nullptr) {
      stream_.images.push_back(file_image(source(key), key.srgb));
      continue;
    }
    const SceneImage::Size size = source(key).size();
    const auto format = key.srgb ? traces::Format::kR8G8B8A8Srgb : traces::Format::kR8G8B8A8Unorm;
    const auto packed = std::make_shared<const traces::UnpackTexels>(
        [pixels = source(key).source(), coding = TexelCoding{key.srgb, key.premultiplied}](
            const traces::LevelSink& sink) { visit_mip_chain(*pixels(), coding, sink); });
    stream_.images.push_back({source(key).name(),
                              format,
                              size.width,
                              size.height,
                              full_chain_levels(size.width, size.height),
                              {},
                              packed});
  }
  if (options_.keep_packed) return;
  parallel_for(keys.size(), [&](std::size_t i) { traces::unpack(stream_.images[first + i]); });
}

void Recorder::unpack_images(const std::vector<TextureKey>& keys) {
  std::set<int> sources;
  for (const TextureKey& key : keys) sources.insert(key.image);
  const std::vector<int> images(sources.begin(), sources.end());
  parallel_for(images.size(), [&](std::size_t i) {
    const SceneImage& image = scene_.images[static_cast<std::size_t>(images[i])];
    if (image.file() == nullptr && (!options_.keep_packed || !image.knows_size())) (void)image.pixels();
  });
}

Recorder::TextureKey Recorder::texture_key(int image, std::size_t slot, const Variant& v) {
  const bool is_color = slot == static_cast<std::size_t>(TextureSlot::kBaseColor);
  return {image, is_srgb(slot), is_color && takes_premultiplied(v)};
}

void Recorder::record_textures() {
  std::set<TextureKey> used;
  for (const Instance& instance : placed_.at.instances) {
    const Primitive& primitive = scene_.primitives[instance.primitive];
    const Variant& v = variant(primitive);
    for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
      if (v.textures[slot])
        used.insert(texture_key(
            scene_.materials[static_cast<std::size_t>(primitive.material)].textures[slot].image, slot, v));
    }
  }
  const std::vector<TextureKey> keys(used.begin(), used.end());
  for (const TextureKey& key : keys) images_.insert(key.image);
  add_textures(keys);
  for (std::size_t i = 0; i < keys.size(); ++i) textures_[keys[i]] = static_cast<traces::Index>(i);
  if (options_.leave_out) return;
  std::vector<TextureKey> unread;
  for (int i = 0; i < static_cast<int>(scene_.images.size()); ++i) {
    if (!images_.contains(i)) unread.push_back({i, false, false});
  }
  add_textures(unread);
}

traces::Index Recorder::sampler(const traces::Sampler& wanted) {
  const auto found = std::ranges::find(stream_.samplers, wanted);
  if (found == stream_.samplers.end()) {
    stream_.samplers.push_back(wanted);
    return static_cast<traces::Index>(stream_.samplers.size() - 1);
  }
  return static_cast<traces::Index>(found - stream_.samplers.begin());
}

traces::Index Recorder::material_block(int material) {
  const auto [entry, added] =
      material_blocks_.try_emplace(material, static_cast<traces::Index>(stream_.buffers.size()));
  if (added) {
    const Material& m = scene_.materials[static_cast<std::size_t>(material)];
    std::vector<std::byte> block = bytes_of(material_values(m, exposure_));
    const std::vector<std::byte> layers =
        m.layers.any() ? bytes_of(layer_values(m)) : std::vector<std::byte>();
    block.insert(block.end(), layers.begin(), layers.end());
    stream_.buffers.push_back({"material " + m.name, std::move(block)});
  }
  return entry->second;
}

traces::Index Recorder::material_set(int material, const Variant& v) {
  const auto [entry, added] = material_sets_.try_emplace(
      {material, v.textures}, static_cast<traces::Index>(stream_.descriptor_sets.size()));
  if (!added) return entry->second;
  const traces::Index block = material_block(material);
  traces::DescriptorSet set{{{0, block, 0, static_cast<std::uint32_t>(stream_.buffers[block].data.size())}},
                            {}};
  for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
    if (!v.textures[slot]) continue;
    const TextureUse& use = scene_.materials[static_cast<std::size_t>(material)].textures[slot];
    set.textures.push_back({static_cast<std::uint32_t>(1 + slot),
                            textures_.at(texture_key(use.image, slot, v)), sampler(use.sampler)});
  }
  stream_.descriptor_sets.push_back(std::move(set));
  return entry->second;
}

}  // namespace quadrille::scenes
