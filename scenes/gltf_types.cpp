#include "scenes/gltf_types.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "models/base/error.h"

namespace quadrille::scenes {
namespace {

using Json = nlohmann::json;

enum class Type : std::uint8_t { kAny, kObject, kArray, kIndex, kNumber, kString, kBool, kThree, kFour, kSixteen };

const char* due(Type type) {
  switch (type) {
    case Type::kAny: return "anything";
    case Type::kObject: return "an object";
    case Type::kArray: return "an array";
    case Type::kIndex: return "an integer of 0 or more";
    case Type::kNumber: return "a number";
    case Type::kString: return "a string";
    case Type::kBool: return "true or false";
    case Type::kThree: return "an array of 3 numbers";
    case Type::kFour: return "an array of 4 numbers";
    case Type::kSixteen: return "an array of 16 numbers";
  }
  return "";
}

bool numbers(const Json& value, std::size_t count) {
  return value.is_array() && value.size() == count && std::ranges::all_of(value, [](const Json& v) { return v.is_number(); });
}

bool is(const Json& value, Type type) {
  switch (type) {
    case Type::kAny: return true;
    case Type::kObject: return value.is_object();
    case Type::kArray: return value.is_array();
    case Type::kIndex: return value.is_number_unsigned();
    case Type::kNumber: return value.is_number();
    case Type::kString: return value.is_string();
    case Type::kBool: return value.is_boolean();
    case Type::kThree: return numbers(value, 3);
    case Type::kFour: return numbers(value, 4);
    case Type::kSixteen: return numbers(value, 16);
  }
  return true;
}

/// Members of one type: names by path from the document's root; "[]" is each element of an array, "*" each member of an object. What leads to a member is by
/// that an object, or an array. One with "!" may not be missing where the object around it stands.
struct Rule {
  Type type;
  std::string_view paths;  ///< with a blank between two
};

constexpr std::array kRules{
    Rule{Type::kIndex,
         "scene scenes[].nodes[] nodes[].mesh nodes[].camera nodes[].skin nodes[].children[] meshes[].primitives[].attributes.* "
         "meshes[].primitives[].indices meshes[].primitives[].material meshes[].primitives[].mode meshes[].primitives[].targets[].* "
         "accessors[].bufferView accessors[].byteOffset accessors[].componentType! accessors[].count! accessors[].sparse.count! "
         "accessors[].sparse.indices.bufferView! accessors[].sparse.indices.byteOffset accessors[].sparse.indices.componentType! "
         "accessors[].sparse.values.bufferView! accessors[].sparse.values.byteOffset bufferViews[].buffer! bufferViews[].byteOffset "
         "bufferViews[].byteLength! bufferViews[].byteStride bufferViews[].target textures[].sampler textures[].source "
         "samplers[].magFilter samplers[].minFilter samplers[].wrapS samplers[].wrapT "
         "materials[].pbrMetallicRoughness.baseColorTexture.index! materials[].pbrMetallicRoughness.baseColorTexture.texCoord "
         "materials[].pbrMetallicRoughness.metallicRoughnessTexture.index! "
         "materials[].pbrMetallicRoughness.metallicRoughnessTexture.texCoord materials[].normalTexture.index! "
         "materials[].normalTexture.texCoord materials[].occlusionTexture.index! materials[].occlusionTexture.texCoord "
         "materials[].emissiveTexture.index! materials[].emissiveTexture.texCoord skins[].joints[] skins[].skeleton "
         "skins[].inverseBindMatrices animations[].channels[].sampler! animations[].channels[].target.node animations[].samplers[].input! "
         "animations[].samplers[].output!"},
    Rule{Type::kNumber,
         "nodes[].weights[] meshes[].weights[] accessors[].min[] accessors[].max[] materials[].pbrMetallicRoughness.metallicFactor "
         "materials[].pbrMetallicRoughness.roughnessFactor materials[].normalTexture.scale materials[].occlusionTexture.strength "
         "materials[].alphaCutoff cameras[].perspective.yfov! cameras[].perspective.aspectRatio cameras[].perspective.znear! "
         "cameras[].perspective.zfar cameras[].orthographic.xmag! cameras[].orthographic.ymag! cameras[].orthographic.znear! "
         "cameras[].orthographic.zfar!"},
    Rule{Type::kThree, "nodes[].translation nodes[].scale materials[].emissiveFactor"},
    Rule{Type::kFour, "nodes[].rotation materials[].pbrMetallicRoughness.baseColorFactor"},
    Rule{Type::kSixteen, "nodes[].matrix"},
    Rule{Type::kString,
         "asset.version! asset.minVersion scenes[].name nodes[].name meshes[].name materials[].name materials[].alphaMode "
         "accessors[].type! cameras[].name "
         "cameras[].type! skins[].name animations[].name animations[].channels[].target.path! animations[].samplers[].interpolation "
         "extensionsUsed[] extensionsRequired[]"},
    Rule{Type::kBool, "accessors[].normalized materials[].doubleSided"},
    Rule{Type::kArray, "meshes[].primitives! skins[].joints! animations[].channels! animations[].samplers!"},
    Rule{Type::kObject,
         "asset! meshes[].primitives[].attributes! accessors[].sparse.indices! accessors[].sparse.values! animations[].channels[].target! "
         "nodes[].extensions.* meshes[].primitives[].extensions.* materials[].extensions.* textures[].extensions.* extensions.*"}};

/// What is due at a place of the document, and below it.
struct Due {
  Type type = Type::kAny;
  std::map<std::string_view, Due> members;  ///< of an object
  std::vector<std::string_view> required;   ///< of these
  std::unique_ptr<Due> each;                ///< of an array's elements, or of all members of an object

  void add(std::string_view path, Type leaf) {
    if (path.empty()) {
      type = leaf;
      return;
    }
    if (path.starts_with("[]")) {
      type = Type::kArray;
      return below().add(path.substr(path.starts_with("[].") ? 3 : 2), leaf);
    }
    type = Type::kObject;
    if (path == "*") return below().add("", leaf);
    const std::size_t end = std::min(path.find_first_of(".[!"), path.size());
    const std::string_view name = path.substr(0, end), rest = path.substr(end);
    if (rest == "!") required.push_back(name);
    members[name].add(rest == "!" ? "" : rest.substr(rest.starts_with('.') ? 1 : 0), leaf);
  }

 private:
  Due& below() {
    if (!each) each = std::make_unique<Due>();
    return *each;
  }
};

Due due_of_rules() {
  Due root;
  for (const Rule& rule : kRules) {
    for (std::size_t from = 0; from < rule.paths.size();) {
      const std::size_t to = std::min(rule.paths.find(' ', from), rule.paths.size());
      root.add(rule.paths.substr(from, to - from), rule.type);
      from = to + 1;
    }
  }
  return root;
}

/// Where the walk is; spelled only when something is wrong there.
struct Place {
  const Place* above = nullptr;
  std::string_view member;
  std::size_t index = 0;

  [[nodiscard]] std::string text() const {
    if (above == nullptr) return "";
    const std::string before = above->text();
    if (member.empty()) return fmt::format("{}[{}]", before, index);
    return before.empty() ? std::string(member) : fmt::format("{}.{}", before, member);
  }
};

class Check {
 public:
  explicit Check(const std::string& path) : path_(path) {}

  void value(const Json& value, const Due& wanted, const Place& place) const {
    if (!is(value, wanted.type)) fail(place, wanted.type);
    if (value.is_array() && wanted.each) {
      for (std::size_t i = 0; i < value.size(); ++i) this->value(value[i], *wanted.each, {&place, {}, i});
    }
    if (value.is_object()) members(value, wanted, place);
  }

 private:
  void members(const Json& object, const Due& wanted, const Place& place) const {
    for (auto item = object.begin(); item != object.end(); ++item) {
      const auto known = wanted.members.find(item.key());
      if (known != wanted.members.end()) value(*item, known->second, {&place, item.key(), 0});
      else if (wanted.each) value(*item, *wanted.each, {&place, item.key(), 0});
    }
    for (const std::string_view name : wanted.required) {
      if (!object.contains(name)) fail({&place, name, 0}, wanted.members.at(name).type, "is missing; ");
    }
  }

  [[noreturn]] void fail(const Place& place, Type type, const char* missing = "") const {
    throw user_error("{}: {}: {}{} is due", path_, place.text(), missing, due(type));
  }

  const std::string& path_;
};

}  // namespace

void check_types(const std::string& path, const nlohmann::json& root) {
  static const Due kDue = due_of_rules();
  Check(path).value(root, kDue, {});
}

}  // namespace quadrille::scenes
