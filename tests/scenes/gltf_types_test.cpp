/// JSON of wrong types, and members that are missing: refused with the place, whatever stands around them.
#include "scenes/gltf/types.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "models/base/error.h"
#include "tests/scenes/gltf_text.h"

using namespace quadrille;
using namespace quadrille::scenes;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

/// A document with a member of every kind that the loader reads.
Json everything() {
  return Json::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "extensionsUsed": ["KHR_x"],
    "extensions": {"KHR_x": {}, "KHR_lights_punctual": {"lights": [{"type": "spot", "color": [1, 1, 1], "intensity": 2, "range": 9,
                   "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}}]}},
    "scenes": [{"name": "s", "nodes": [0]}],
    "nodes": [{"name": "n", "mesh": 0, "camera": 0, "skin": 0, "children": [1], "translation": [0, 0, 0], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1],
               "weights": [0.5], "extensions": {"KHR_x": {}, "KHR_lights_punctual": {"light": 0}}},
              {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}],
    "meshes": [{"name": "m", "weights": [0], "primitives": [{"attributes": {"POSITION": 0}, "indices": 0, "material": 0, "mode": 4,
                "targets": [{"POSITION": 0}], "extensions": {"KHR_x": {}}}]}],
    "materials": [{"name": "m", "alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": true, "emissiveFactor": [0, 0, 0],
                   "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 1,
                     "baseColorTexture": {"index": 0, "texCoord": 0}, "metallicRoughnessTexture": {"index": 0, "texCoord": 0}},
                   "normalTexture": {"index": 0, "texCoord": 0, "scale": 1}, "occlusionTexture": {"index": 0, "texCoord": 0, "strength": 1},
                   "emissiveTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_x": {}, "KHR_texture_transform":
                     {"offset": [0, 0], "scale": [1, 1], "rotation": 0, "texCoord": 1}}},
                   "extensions": {"KHR_x": {}, "KHR_materials_ior": {"ior": 1.5}, "KHR_materials_sheen": {"sheenColorFactor": [0, 0, 0]},
                     "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0, "scale": 1}}}}],
    "textures": [{"sampler": 0, "source": 0, "extensions": {"KHR_x": {}, "EXT_texture_webp": {"source": 0}}}],
    "images": [{"name": "i", "uri": "a.png", "bufferView": 0}], "buffers": [{"uri": "a.bin", "extensions": {"KHR_x": {}}}],
    "samplers": [{"magFilter": 9729, "minFilter": 9729, "wrapS": 10497, "wrapT": 10497}],
    "cameras": [{"name": "c", "type": "perspective", "perspective": {"yfov": 1, "aspectRatio": 1, "znear": 0.1, "zfar": 10}},
                {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}}],
    "accessors": [{"bufferView": 0, "byteOffset": 0, "componentType": 5126, "count": 3, "type": "VEC3", "normalized": false, "min": [0, 0, 0],
                   "max": [1, 1, 1], "sparse": {"count": 1, "indices": {"bufferView": 0, "byteOffset": 0, "componentType": 5123},
                   "values": {"bufferView": 0, "byteOffset": 0}}}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36, "byteStride": 12, "target": 34962}],
    "skins": [{"name": "k", "joints": [0], "skeleton": 0, "inverseBindMatrices": 0}],
    "animations": [{"name": "a", "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}],
                    "samplers": [{"input": 0, "output": 0, "interpolation": "STEP"}]}]
  })");
}

std::string result(const Json& document) {
  try {
    check_types("f.gltf", document);
  } catch (const UserError& error) { return error.what(); }
  return "passed";
}

/// The place of a JSON pointer as messages spell it: /a/0/b becomes a[0].b.
std::string spelled(const std::string& pointer) {
  std::string text;
  for (std::size_t from = 1; from <= pointer.size();) {
    const std::size_t to = std::min(pointer.find('/', from), pointer.size());
    const std::string part = pointer.substr(from, to - from);
    text += part.find_first_not_of("0123456789") == std::string::npos ? "[" + part + "]"
                                                                      : (text.empty() ? "" : ".") + part;
    from = to + 1;
  }
  return text;
}

}  // namespace

TEST_CASE("gltf types: a document with every member passes, with members that nobody knows as well") {
  Json document = everything();
  REQUIRE(result(document) == "passed");
  document["nodes"][0]["extras"] = 7;
  document["materials"][0]["glow"] = Json::array({"a", 1});
  document["accessors"][0]["sparse"]["note"] = nullptr;
  REQUIRE(result(document) == "passed");
}

TEST_CASE("gltf types: every member of every depth is refused by its place when its type is another") {
  const Json document = everything();
  const Json wrong = Json::parse(R"(["x", 0.5, true, null, {}, [], -1])");
  int places = 0;
  const Json flat = document.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    // The member itself, and each that leads to it.
    for (std::string at = pointer; !at.empty(); at.resize(at.rfind('/'))) {
      const Json::json_pointer here(at);
      const Json& good = document.at(here);
      ++places;
      for (const Json& bad : wrong) {
        // What may stand there: its own type; numbers may be fractions or negative; an array may be empty.
        if (bad.type() == good.type() || (bad.is_number() && good.is_number()) ||
            (bad.is_array() && good.is_array()))
          continue;
        Json changed = document;
        changed[here] = bad;
        const std::string whole = spelled(at),
                          // or that of three numbers
            around = whole.ends_with(']') ? whole.substr(0, whole.rfind('[')) : whole;
        INFO(at << " = " << bad.dump());
        REQUIRE_THAT(result(changed), Contains("f.gltf: " + around) && Contains(" is due"));
      }
    }
  }
  REQUIRE(places > 300);
}

TEST_CASE("gltf types: indices, counts and offsets are integers of 0 or more") {
  for (const std::string at :
       {"/scene", "/nodes/0/mesh", "/nodes/0/children/0", "/accessors/0/count", "/accessors/0/byteOffset",
        "/bufferViews/0/byteLength", "/meshes/0/primitives/0/attributes/POSITION", "/skins/0/joints/0",
        "/animations/0/channels/0/target/node"}) {
    for (const double bad : {-1.0, 0.5}) {
      Json document = everything();
      document[Json::json_pointer(at)] = bad;
      REQUIRE(result(document) == "f.gltf: " + spelled(at) + ": an integer of 0 or more is due");
    }
  }
}

TEST_CASE("gltf types: what is kept in 31 bits is refused beyond them, not wrapped") {
  for (const std::string at : {"/accessors/0/sparse/count", "/accessors/0/sparse/indices/byteOffset",
                               "/accessors/0/sparse/values/byteOffset", "/bufferViews/0/target",
                               "/meshes/0/primitives/0/mode", "/samplers/0/wrapS", "/samplers/0/magFilter"}) {
    for (const std::uint64_t bad :
         {std::uint64_t{1} << 31, (std::uint64_t{1} << 32) + 4, std::uint64_t{1} << 53}) {
      Json document = everything();
      document[Json::json_pointer(at)] = bad;
      REQUIRE(result(document) == "f.gltf: " + spelled(at) + ": an integer of 0 to 2147483647 is due");
    }
  }
}

TEST_CASE("gltf types: vectors and matrices have their number of numbers") {
  for (const auto& [at, count] : {std::pair<std::string, std::size_t>{"/nodes/0/translation", 3},
                                  {"/nodes/0/rotation", 4},
                                  {"/nodes/0/scale", 3},
                                  {"/nodes/1/matrix", 16},
                                  {"/materials/0/emissiveFactor", 3},
                                  {"/materials/0/pbrMetallicRoughness/baseColorFactor", 4}}) {
    for (const std::size_t size : {count - 1, count + 1, std::size_t{0}}) {
      Json document = everything();
      document[Json::json_pointer(at)] = Json(std::vector<double>(size, 1));
      REQUIRE(result(document) ==
              fmt::format("f.gltf: {}: an array of {} numbers is due", spelled(at), count));
    }
  }
}

TEST_CASE("gltf types: what must be there is named when it is missing") {
  int refused = 0;
  for (const auto& [around, member] : {std::pair<std::string, std::string>{"", "asset"},
                                       {"/asset", "version"},
                                       {"/meshes/0", "primitives"},
                                       {"/meshes/0/primitives/0", "attributes"},
                                       {"/accessors/0", "count"},
                                       {"/accessors/0", "type"},
                                       {"/accessors/0", "componentType"},
                                       {"/accessors/0/sparse", "values"},
                                       {"/bufferViews/0", "buffer"},
                                       {"/bufferViews/0", "byteLength"},
                                       {"/skins/0", "joints"},
                                       {"/animations/0", "samplers"},
                                       {"/animations/0/channels/0", "target"},
                                       {"/animations/0/samplers/0", "output"},
                                       {"/cameras/0", "type"},
                                       {"/cameras/0/perspective", "yfov"},
                                       {"/cameras/1/orthographic", "zfar"},
                                       {"/materials/0/normalTexture", "index"}}) {
    Json document = everything();
    document[Json::json_pointer(around)].erase(member);
    REQUIRE_THAT(result(document), Contains("f.gltf: " + spelled(around + "/" + member) + ": is missing; ") &&
                                       Contains(" is due"));
    ++refused;
  }
  REQUIRE(refused == 18);
  Json document = everything();
  document["nodes"][0] = Json::object();
  document["textures"][0] = Json::object();
  REQUIRE(result(document) == "passed");
}

TEST_CASE("gltf types: every index leads to something, also where nothing is drawn of it") {
  int indices = 0;
  const Json flat = everything().flatten();
  for (const auto& [pointer, value] : flat.items()) {
    const std::string member = pointer.substr(pointer.rfind('/') + 1),
                      around = pointer.substr(0, pointer.rfind('/'));
    const bool index = std::string(
                           " scene mesh camera skin light index source sampler material indices bufferView "
                           "buffer node input output "
                           "skeleton inverseBindMatrices ")
                           .find(" " + member + " ") != std::string::npos;
    const bool in_list = around.ends_with("/nodes") || around.ends_with("children") ||
                         around.ends_with("joints") || around.ends_with("attributes") ||
                         around.find("/targets/") != std::string::npos;
    if (!value.is_number() || (!index && !in_list)) continue;
    Json document = everything();
    document[Json::json_pointer(pointer)] = 2U;  // one table has two elements, the others one
    CAPTURE(pointer);
    REQUIRE_THAT(result(document),
                 Contains("f.gltf: " + spelled(pointer) + ": ") && Contains(" 2 does not exist (the "));
    ++indices;
  }
  REQUIRE(indices == 32);
}

TEST_CASE("gltf types: words and component types are those of glTF, and a type brings its part") {
  const auto changed = [](const std::string& at, const Json& value) {
    Json document = everything();
    document[Json::json_pointer(at)] = value;
    return result(document);
  };
  REQUIRE(changed("/cameras/0/type", "fisheye\n") ==
          "f.gltf: cameras[0].type: one of perspective, orthographic is due");
  REQUIRE(changed("/accessors/0/type", "VEC5") ==
          "f.gltf: accessors[0].type: one of SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4 is due");
  REQUIRE(changed("/accessors/0/componentType", 5124) ==
          "f.gltf: accessors[0].componentType: one of 5120, 5121, 5122, 5123, 5125, 5126 is due");
  REQUIRE(changed("/extensions/KHR_lights_punctual/lights/0/type", "") ==
          "f.gltf: extensions.KHR_lights_punctual.lights[0].type: one of directional, point, spot is due");
  REQUIRE(changed("/cameras/1/type", "perspective") ==
          "f.gltf: cameras[1].perspective: is missing; an object is due");
  Json document = everything();
  document["extensions"]["KHR_lights_punctual"]["lights"][0].erase("spot");
  REQUIRE(result(document) ==
          "f.gltf: extensions.KHR_lights_punctual.lights[0].spot: is missing; an object is due");
  document["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "point";
  REQUIRE(result(document) == "passed");
}

TEST_CASE("gltf types: extensions are objects wherever they stand and what an unknown one holds is its own") {
  Json document = everything();
  document["accessors"][0]["extensions"] = Json::object({{"EXT_y", 1}});
  REQUIRE(result(document) == "f.gltf: accessors[0].extensions.EXT_y: an object is due");
  document["accessors"][0]["extensions"] = Json::array();
  REQUIRE(result(document) == "f.gltf: accessors[0].extensions: an object is due");
  document["accessors"][0]["extensions"] = Json::object({{"EXT_y", {{"index", -1}, {"extensions", 5}}}});
  document["accessors"][0]["extras"] = Json::object({{"extensions", 5}});
  REQUIRE(result(document) == "passed");
}

TEST_CASE("gltf types: a file of glTF 1.0 is refused by its version, not by what else differs") {
  for (const std::string version : {"1.0", "1.1", "3.0", "2", "", "two"})
    REQUIRE_THAT(load_result(R"({"accessors":{},"asset":{"version":")" + version + R"("},"scene":"main"})"),
                 Contains(": asset.version '" + version + "'; glTF 2.x is read"));
  REQUIRE_THAT(load_result(R"({"accessors":{},"asset":{}})"),
               Contains(": asset.version: is missing; a string is due"));
  REQUIRE_THAT(load_result(R"({"asset":{"version":"2.0"},"scene":0})"),
               Contains(": scene: scene 0 does not exist (the file has 0)"));
}

TEST_CASE("gltf types: a whole file is refused before anything of it is drawn") {
  REQUIRE_THAT(load_result(triangle_gltf(R"(,"mode":"4")")),
               Contains("meshes[0].primitives[0].mode: an integer of 0 to 2147483647 is due"));
  REQUIRE_THAT(load_result(triangle_gltf("", R"(,"materials":{})")),
               Contains(": materials: an array is due"));
  REQUIRE_THAT(load_result(triangle_gltf("", "", R"(,"extensions":{"KHR_lights_punctual":"sun"})")),
               Contains("nodes[0].extensions.KHR_lights_punctual: an object is due"));
}

TEST_CASE("gltf types: a place is spelled with names of bounded length, and an empty name is a name") {
  Json document = everything();
  document["nodes"][0]["extensions"][std::string(3000000, 'X')] = 1;
  REQUIRE(result(document).size() < 200);
  document = everything();
  document["meshes"][0]["primitives"][0]["attributes"][""] = "x";
  REQUIRE_THAT(result(document), Contains("primitives[0].attributes.: "));
}

TEST_CASE("gltf types: a stride is a multiple of 4 that glTF allows") {
  for (const std::int64_t bad :
       {std::int64_t{3}, std::int64_t{256}, std::int64_t{-4}, std::int64_t{1} << 40}) {
    Json document = everything();
    document["bufferViews"][0]["byteStride"] = bad;
    REQUIRE(result(document) == "f.gltf: bufferViews[0].byteStride: a multiple of 4 from 4 to 252 is due");
  }
}
