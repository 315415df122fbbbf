/// glTF is JSON, in a binary file with a chunk of data behind it: changes are made to its values and members,
/// so that the text stays JSON.
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/fuzz/dice.h"
#include "tests/fuzz/targets.h"

namespace quadrille::fuzz {
namespace {

using Json = nlohmann::ordered_json;

/// of a binary file with the header of its first chunk [glTF2.0 #binary-gltf-layout]
constexpr std::size_t kHeader = 20;
constexpr std::array kMembers{"accessors",
                              "alphaCutoff",
                              "alphaMode",
                              "animations",
                              "attributes",
                              "bufferView",
                              "bufferViews",
                              "buffers",
                              "byteLength",
                              "byteOffset",
                              "byteStride",
                              "camera",
                              "cameras",
                              "channels",
                              "children",
                              "componentType",
                              "count",
                              "doubleSided",
                              "emissiveFactor",
                              "extensions",
                              "extensionsRequired",
                              "extensionsUsed",
                              "images",
                              "indices",
                              "input",
                              "interpolation",
                              "inverseBindMatrices",
                              "JOINTS_0",
                              "joints",
                              "light",
                              "lights",
                              "material",
                              "materials",
                              "matrix",
                              "max",
                              "mesh",
                              "meshes",
                              "mimeType",
                              "min",
                              "mode",
                              "name",
                              "node",
                              "nodes",
                              "normalized",
                              "normalTexture",
                              "orthographic",
                              "output",
                              "path",
                              "pbrMetallicRoughness",
                              "perspective",
                              "POSITION",
                              "primitives",
                              "rotation",
                              "sampler",
                              "samplers",
                              "scale",
                              "scene",
                              "scenes",
                              "skeleton",
                              "skin",
                              "skins",
                              "source",
                              "sparse",
                              "target",
                              "targets",
                              "texCoord",
                              "texture",
                              "textures",
                              "translation",
                              "type",
                              "uri",
                              "values",
                              "weights",
                              "WEIGHTS_0",
                              "wrapS",
                              "yfov",
                              "zfar",
                              "znear",
                              "asset",
                              "version",
                              "KHR_texture_transform",
                              "KHR_materials_unlit",
                              "KHR_lights_punctual",
                              "KHR_mesh_quantization",
                              "KHR_materials_emissive_strength",
                              "KHR_materials_ior",
                              "KHR_materials_specular",
                              "KHR_materials_clearcoat",
                              "KHR_materials_transmission",
                              "KHR_materials_sheen",
                              "EXT_mesh_gpu_instancing",
                              "EXT_meshopt_compression",
                              "KHR_draco_mesh_compression",
                              "KHR_texture_basisu",
                              "KHR_materials_variants"};
constexpr std::array kNumbers{0.0,          1.0,          -1.0,         2.0,           3.0,    4.0,
                              5.0,          255.0,        5120.0,       5121.0,        5123.0, 5125.0,
                              5126.0,       9729.0,       33071.0,      1e-40,         1e30,   1e308,
                              2147483647.0, 2147483648.0, 4294967295.0, -2147483648.0, 1.8e19, 0.5};
constexpr std::array kStrings{"",           "SCALAR",    "VEC2",      "VEC3",        "VEC4",
                              "MAT4",       "MASK",      "BLEND",     "perspective", "data:;base64,",
                              "data:,",     "LINEAR",    "STEP",      "CUBICSPLINE", "translation",
                              "weights",    "2.0",       "image/png", "TRIANGLES",   "ATTRIBUTES",
                              "OCTAHEDRAL", "/dev/null", "."};

/// All values below and including `root`; what holds other values comes before them.
void collect(Json& root, std::vector<Json*>& out) {
  out.push_back(&root);
  if (!root.is_structured() || out.size() > 4000) return;
  for (Json& child : root) collect(child, out);
}

Json some_value(const std::vector<Json*>& all, Dice& dice) {
  switch (dice.below(7)) {
    case 0: return dice.pick(kNumbers);
    case 1: return dice.pick(kStrings);
    case 2: return static_cast<std::int64_t>(dice.below(12)) - 2;
    case 3: return Json::array();
    case 4: return Json::object();
    case 5: return dice.one_in(2);
    default: return *dice.pick(all);
  }
}

void change_number(Json& value, Dice& dice) {
  if (dice.one_in(3)) {
    value = dice.pick(kNumbers);
  } else if (value.is_number_integer()) {
    value = value.get<std::int64_t>() + static_cast<std::int64_t>(dice.below(5)) - 2;
  } else {
    value = value.get<double>() * static_cast<double>(dice.below(9)) - 2;
  }
}

void change_object(Json& object, const std::vector<Json*>& all, Dice& dice) {
  if (!object.empty() && dice.one_in(3)) {
    auto victim = object.begin();
    std::advance(victim, static_cast<std::ptrdiff_t>(dice.below(object.size())));
    const Json kept = victim.value();
    const std::string key = victim.key();
    object.erase(key);
    if (dice.one_in(2)) object[dice.pick(kMembers)] = kept;
    return;
  }
  object[dice.pick(kMembers)] = some_value(all, dice);
}

void change_array(Json& array, const std::vector<Json*>& all, Dice& dice) {
  if (array.empty() || dice.one_in(3)) {
    array.push_back(some_value(all, dice));
  } else if (dice.one_in(2)) {
    array.erase(dice.below(array.size()));
  } else {
    array.push_back(Json(array[dice.below(array.size())]));
  }
}

void change(Json& root, Dice& dice) {
  std::vector<Json*> all;
  collect(root, all);
  Json& value = *dice.pick(all);
  if (&value != &root && dice.one_in(8)) {
    value = some_value(all, dice);
  } else if (value.is_number()) {
    change_number(value, dice);
  } else if (value.is_object()) {
    change_object(value, all, dice);
  } else if (value.is_array()) {
    change_array(value, all, dice);
  } else if (&value != &root) {
    value = some_value(all, dice);
  }
}

bool is_binary(Bytes bytes) { return bytes.size() > kHeader && std::memcmp(bytes.data(), "glTF", 4) == 0; }

Buffer with_text(Bytes old, std::string text, std::size_t old_length) {
  if (!is_binary(old)) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
  }
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const Bytes rest = old.subspan(kHeader + old_length);
  Buffer out(old.begin(), old.begin() + kHeader);
  const auto total = static_cast<std::uint32_t>(kHeader + text.size() + rest.size()),
             length = static_cast<std::uint32_t>(text.size());
  std::memcpy(out.data() + 8, &total, 4);
  std::memcpy(out.data() + 12, &length, 4);
  const auto bytes = std::as_bytes(std::span(text));
  out.insert(out.end(), bytes.begin(), bytes.end());
  out.insert(out.end(), rest.begin(), rest.end());
  return out;
}

}  // namespace

Buffer mutate_scene(Bytes bytes, const RawMutation& raw, unsigned seed) {
  Dice dice(seed);
  std::size_t begin = 0, length = bytes.size();
  if (is_binary(bytes)) {
    std::uint32_t stated = 0;
    std::memcpy(&stated, bytes.data() + 12, 4);
    begin = kHeader;
    length = std::min<std::size_t>(stated, bytes.size() - kHeader);
  }
  const std::string text(reinterpret_cast<const char*>(bytes.data()) + begin, length);
  Json root = Json::parse(text, nullptr, false);
  if (root.is_discarded() || dice.one_in(16)) return mutate_raw(bytes, raw, seed);
  for (std::size_t n = 1 + dice.below(3); n > 0; --n) change(root, dice);
  return with_text(bytes, root.dump(-1, ' ', false, Json::error_handler_t::replace), length);
}

}  // namespace quadrille::fuzz
