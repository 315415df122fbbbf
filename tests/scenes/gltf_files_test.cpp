/// Containers, URIs and extensions: what of a glTF file lies where, and what is refused.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>

#include "models/base/error.h"
#include "scenes/gltf/container.h"
#include "scenes/gltf/file.h"
#include "scenes/gltf/loader.h"
#include "scenes/gltf/uri.h"
#include "scenes/image/image_io.h"
#include "tests/scenes/gltf_text.h"
#include "traces/whole_file.h"

using namespace quadrille;
using namespace quadrille::scenes;
using Catch::Contains;

namespace {

struct Chunk {
  std::string type, data;
};

std::string word(std::size_t value) {
  const auto w = static_cast<std::uint32_t>(value);
  std::string text(4, '\0');
  std::memcpy(text.data(), &w, 4);
  return text;
}

std::string binary_file(const std::vector<Chunk>& chunks) {
  std::string body;
  for (const Chunk& c : chunks) body += word(c.data.size()) + c.type + c.data;
  return "glTF" + word(2) + word(12 + body.size()) + body;
}

std::string load_binary(const std::string& bytes) {
  const TempGltf file(bytes, "t.glb");
  try {
    (void)load_gltf(file.path());
  } catch (const UserError& error) { return error.what(); }
  return "loaded";
}

const std::string kBin{"BIN\0", 4};

std::string triangle_bytes() {
  const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
  return {reinterpret_cast<const char*>(corners.data()), 36};
}

/// The triangle whose buffer has this URI (none: the BIN chunk).
std::string triangle_from(const std::string& uri, std::size_t bytes = 36) {
  std::string text = triangle_gltf();
  const std::size_t start = text.find(R"("byteLength":36,"uri":)"), end = text.find('}', start);
  return text.replace(
      start, end - start,
      fmt::format(R"("byteLength":{}{})", bytes, uri.empty() ? "" : R"(,"uri":")" + uri + "\""));
}

/// Loads the triangle from a file beside it.
std::string load_beside(const std::string& uri, const std::string& name) {
  const TempGltf file(triangle_from(uri));
  const auto folder = std::filesystem::path(file.path()).parent_path();
  std::filesystem::create_directories((folder / name).parent_path());
  std::ofstream(folder / name, std::ios::binary) << triangle_bytes() << "and more than the buffer needs";
  try {
    (void)load_gltf(file.path());
  } catch (const UserError& error) { return error.what(); }
  return "loaded";
}

}  // namespace

TEST_CASE("binary glTF: chunks of unknown types are passed over, and the BIN chunk's padding") {
  const std::string json = triangle_from("");
  REQUIRE(load_binary(binary_file({{"JSON", json}, {kBin, triangle_bytes()}})) == "loaded");
  REQUIRE(load_binary(binary_file(
              {{"JSON", json}, {kBin, triangle_bytes() + std::string(3, '\0')}, {"XYZ1", "what"}})) ==
          "loaded");
}

TEST_CASE("binary glTF: chunks that do not fit, come in another order or are missing are refused") {
  const std::string json = triangle_from("");
  REQUIRE_THAT(load_binary(binary_file({{"JSON", json}, {kBin, "short"}})),
               Contains("buffers[0]: byteLength 36 where there are 5 bytes"));
  REQUIRE_THAT(load_binary(binary_file({{"JSON", json}})),
               Contains("buffer 0 has no bytes (no uri, no BIN chunk)"));
  REQUIRE_THAT(load_binary(binary_file({{kBin, triangle_bytes()}, {"JSON", json}})),
               Contains("the first chunk, and only it, holds JSON; chunk 0"));
  REQUIRE_THAT(load_binary(binary_file({{"JSON", json}, {"XYZ1", "what"}, {kBin, triangle_bytes()}})),
               Contains("chunk 2 is BIN"));
  REQUIRE_THAT(load_binary(binary_file({{"JSON", json}, {"JSON", json}})), Contains("chunk 1 breaks that"));
  REQUIRE_THAT(load_binary(binary_file({})), Contains("is truncated"));
  std::string bytes = binary_file({{"JSON", json}, {kBin, triangle_bytes()}});
  REQUIRE_THAT(load_binary(bytes.substr(0, bytes.size() - 1)), Contains("its header says"));
  bytes.replace(12, 4, word(0xfffffff0));
  REQUIRE_THAT(load_binary(bytes), Contains("chunk 0 of 4294967280 bytes reaches beyond the end"));
  bytes.replace(4, 4, word(1));
  REQUIRE_THAT(load_binary(bytes), Contains("version 1 of the binary container; 2 is read"));
}

TEST_CASE("uris: files beside the scene or below it, plain or percent-encoded") {
  REQUIRE(load_beside("a.bin", "a.bin") == "loaded");
  REQUIRE(load_beside("sub/./a%20b.bin", "sub/a b.bin") == "loaded");
  REQUIRE(load_beside("sub/../a%C3%A9.bin", "a\xc3\xa9.bin") == "loaded");
  REQUIRE(load_beside("100%.bin", "100%.bin") == "loaded");
  REQUIRE(load_beside(R"(sub\\a b.bin)", "sub/a b.bin") == "loaded");
  REQUIRE_THAT(load_beside("b.bin", "a.bin"), Contains("buffers[0]: ") && Contains("b.bin"));
}

TEST_CASE(
    "uris: absolute paths, other schemes and ways out of the folder are refused before anything is opened") {
  REQUIRE_THAT(load_result(triangle_from("/etc/passwd")),
               Contains("buffers[0]: '/etc/passwd': an absolute path"));
  REQUIRE_THAT(load_result(triangle_from("../a.bin")), Contains("leads out of the scene's folder"));
  REQUIRE_THAT(load_result(triangle_from("a/%2e%2e/..%2fb.bin")),
               Contains("leads out of the scene's folder"));
  REQUIRE_THAT(load_result(triangle_from("file:///a.bin")),
               Contains("only data URIs and files beside the scene are read"));
  REQUIRE_THAT(load_result(triangle_from("https://a.b/c.bin")), Contains("only data URIs"));
  REQUIRE_THAT(load_result(triangle_from("C:\\\\a.bin")), Contains("only data URIs"));
  REQUIRE_THAT(load_result(triangle_from(R"(\\\\host\\a.bin)")), Contains("an absolute path"));
  REQUIRE_THAT(load_result(triangle_from(R"(a\\..\\..\\b.bin)")),
               Contains("leads out of the scene's folder"));
  REQUIRE_THAT(load_result(triangle_from("a%00b.bin")), Contains("no zero byte"));
  REQUIRE_THAT(load_result(triangle_from(".")), Contains("buffers[0]: "));
}

TEST_CASE("uris: data with and without base64 and padding, and what is no base64") {
  const std::string good = data_uri_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  REQUIRE(load_result(triangle_from(good)) == "loaded");
  REQUIRE(load_result(triangle_gltf("", R"(,"images":[{"uri":""}])")) == "loaded");
  std::string more = triangle_gltf();
  more.replace(more.find(R"("buffers":[)"), 11, R"("buffers":[{"byteLength":9,"uri":""},)")
      .replace(more.find(R"("buffer":0)"), 10, R"("buffer":1)");
  // a buffer without a name is none; nothing is read from it
  REQUIRE(load_result(more) == "loaded");
  REQUIRE(load_result(triangle_from(good, 35)) != "loaded");  // the view reaches beyond
  const auto fetched = [](const std::string& uri) {
    const std::vector<std::byte> bytes = fetch_uri("t.gltf", uri, "t.gltf: here", 1000);
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  REQUIRE(fetched("data:;base64,YWJjZA==") == "abcd");
  REQUIRE(fetched("data:text/plain;base64,YWJjZA") == "abcd");
  REQUIRE(fetched("data:,a%20b") == "a b");
  REQUIRE(fetched("data:;base64,").empty());
  REQUIRE(fetched("data:;base64,YWJjZA%3D%3D") == "abcd");
  REQUIRE(fetched("data:;base64,Pz8%2FPj4%2B") == "\?\?\?>>>");
  REQUIRE(fetched("data:,plain") == "plain");
  for (const char* bad : {"data:;base64,YWJjZA=", "data:;base64,Y", "data:;base64,YW*j", "data:;base64,Y=Wj",
                          "data:;base64,YW-_", "data:base64"}) {
    CAPTURE(bad);
    REQUIRE_THROWS_WITH(fetched(bad), Catch::StartsWith("t.gltf: here: its data URI"));
  }
}

TEST_CASE("gltf: JSON that is not UTF-8 is refused") {
  std::string text = triangle_gltf("", R"(,"extras":"?")");
  text[text.rfind('?')] = '\xff';
  REQUIRE_THAT(load_result(text), Contains("not JSON in UTF-8"));
}

TEST_CASE("gltf: Basis textures fall back to the plain image, and are refused where there is none") {
  const auto file = [](const std::string& texture, const std::string& more) {
    return triangle_gltf(
        R"(,"material":0)",
        R"(,"materials":[{"emissiveTexture":{"index":0}}],"textures":[{)" + texture +
            R"("extensions":{"KHR_texture_basisu":{"source":1}}}],"images":[{"uri":"none.png"},{"uri":"none.ktx2"}])" +
            more);
  };
  REQUIRE_THAT(
      load_result(file("", "")),
      Contains("textures[0]: its only image is KHR_texture_basisu's; Basis textures are not supported"));
  // the fallback is what is opened
  REQUIRE_THAT(load_result(file(R"("source":0,)", "")), Contains("images[0]") && Contains("none.png"));
  REQUIRE_THAT(load_result(file(R"("source":0,)", R"(,"extensionsRequired":["KHR_texture_basisu"])")),
               Contains("extensionsRequired: KHR_texture_basisu not supported"));
}

TEST_CASE("gltf: an image of EXT_texture_webp or MSFT_texture_dds goes before the texture's own") {
  for (const char* name : {"EXT_texture_webp", "MSFT_texture_dds"}) {
    const std::string text = triangle_gltf(
        R"(,"material":0)",
        fmt::format(
            R"(,"materials":[{{"emissiveTexture":{{"index":0}}}}],"textures":[{{"source":0,"extensions":{{"{}":{{"source":1}}}}}}],)"
            R"("images":[{{"uri":"a.png"}},{{"uri":"b.other"}}])",
            name));
    REQUIRE_THAT(load_result(text), Contains("images[1]") && Contains("b.other"));
  }
}

TEST_CASE("gltf: the layers of a material are read from its extensions, wrong values are named") {
  const auto material = [](const std::string& extensions) {
    return triangle_gltf(R"(,"material":0)", R"(,"materials":[{"extensions":{)" + extensions + "}}]");
  };
  const auto layers = [&](const std::string& extensions) {
    const TempGltf file(material(extensions));
    return load_gltf(file.path()).materials[0].layers;
  };
  REQUIRE_FALSE(
      layers(
          R"("KHR_materials_ior":{"ior":1.5},"KHR_materials_specular":{},"KHR_materials_clearcoat":{},"KHR_materials_sheen":{})")
          .any());
  REQUIRE(layers(R"("KHR_materials_ior":{"ior":3})").specular_color == glm::vec3(0.25F));
  REQUIRE(layers(R"("KHR_materials_ior":{"ior":0})").specular_color == glm::vec3(1));
  REQUIRE(
      layers(
          R"("KHR_materials_ior":{"ior":3},"KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[1,2,0]})")
          .specular_color == glm::vec3(0.25F, 0.5F, 0));
  const MaterialLayers glass = layers(
      R"("KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_volume":{"thicknessFactor":2,"attenuationDistance":1,"attenuationColor":[1,0.5,0.25]})");
  REQUIRE(glass.transmits());
  REQUIRE(glass.absorption == glm::vec3(0, -2, -4));
  REQUIRE_THAT(load_result(material(R"("KHR_materials_ior":{"ior":0.5})")),
               Contains("materials[0].KHR_materials_ior.ior: 0.5 is neither 0 nor at least 1"));
  REQUIRE_THAT(load_result(material(R"("KHR_materials_clearcoat":{"clearcoatFactor":2})")),
               Contains("clearcoatFactor: 2 is outside 0..1"));
  REQUIRE_THAT(
      load_result(material(R"("KHR_materials_sheen":{"sheenColorFactor":[1,1]})")),
      Contains("materials[0].extensions.KHR_materials_sheen.sheenColorFactor: an array of 3 numbers is due"));
  REQUIRE_THAT(load_result(material(R"("KHR_materials_transmission":{"transmissionTexture":{"index":4}})")),
               Contains("materials[0].extensions.KHR_materials_transmission.transmissionTexture.index: "
                        "texture 4 does not exist (the file has 0)"));
}

TEST_CASE("gltf: numbers of an extension beyond 32 bits are read as they are written") {
  const auto material = [](const std::string& distance) {
    return triangle_gltf(
        R"(,"material":0)",
        R"(,"materials":[{"extensions":{"KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_volume":)"
        R"({"thicknessFactor":1e10,"attenuationColor":[0.5,0.5,0.5],"attenuationDistance":)" +
            distance + "}}}]");
  };
  const auto absorption = [&](const std::string& distance) {
    const TempGltf file(material(distance));
    return load_gltf(file.path()).materials[0].layers.absorption.x;
  };
  REQUIRE(absorption("10000000000") == -1);
  REQUIRE(absorption("1e10") == -1);
  REQUIRE(absorption("10000000000.0") == -1);
  REQUIRE(absorption("4294967296") == Approx(-1e10 / 4294967296.0));
  REQUIRE(absorption("3e9") == Approx(-10 / 3.0));
  REQUIRE(absorption("2147483648") == Approx(-1e10 / 2147483648.0));
  REQUIRE(absorption("2147483647") == Approx(-1e10 / 2147483647.0));
  REQUIRE_THAT(load_result(material("-3000000000")),
               Contains("attenuationDistance: -3000000000 is not positive"));
  REQUIRE_THAT(
      load_result(triangle_gltf("", "", R"(,"extensions":{"KHR_lights_punctual":{"light":4294967296}})")),
      Contains(
          "nodes[0].extensions.KHR_lights_punctual.light: light 4294967296 does not exist (the file has 0)"));
}

TEST_CASE(
    "gltf: numbers of an extension that are words or beyond all indices are refused, not taken for zero") {
  const std::string lights = R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}})";
  for (const std::string light : {"\"x\"", "1e300", "0.5", "-1", "null"}) {
    CAPTURE(light);
    REQUIRE_THAT(load_result(triangle_gltf(
                     "", lights, R"(,"extensions":{"KHR_lights_punctual":{"light":)" + light + "}}")),
                 Contains("nodes[0].extensions.KHR_lights_punctual.light: "));
  }
  REQUIRE_THAT(
      load_result(triangle_gltf(
          R"(,"material":0)",
          R"(,"materials":[{"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":"x"}}}])")),
      Contains("materials[0].extensions.KHR_materials_emissive_strength.emissiveStrength: a number is due"));
}

TEST_CASE("uris: a scene named without its folder lacks a file as any other does") {
  const TempGltf file(triangle_from("missing.bin"));
  const std::filesystem::path before = std::filesystem::current_path(), path(file.path());
  std::filesystem::current_path(path.parent_path());
  std::string said;
  try {
    (void)load_gltf(path.filename().string());
  } catch (const UserError& error) { said = error.what(); }
  std::filesystem::current_path(before);
  CHECK_THAT(said, Contains("missing.bin") && Contains("no such file"));
}

TEST_CASE(
    "uris: a link that leads out of the folder is refused, a scene file that is a link itself is read") {
  namespace fs = std::filesystem;
  const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
  const TempGltf inner(triangle_from("a.bin")), outer(triangle_from("a.bin"));
  const fs::path folder = fs::path(inner.path()).parent_path(), other = fs::path(outer.path()).parent_path();
  const auto result = [](const fs::path& path) {
    try {
      (void)load_gltf(path.string());
    } catch (const UserError& error) { return std::string(error.what()); }
    return std::string("loaded");
  };
  traces::write_whole_file((other / "real.bin").string(), std::as_bytes(std::span(corners)));
  traces::write_whole_file((folder / "real.bin").string(), std::as_bytes(std::span(corners)));
  fs::create_symlink(other / "real.bin", folder / "a.bin");
  REQUIRE_THAT(result(inner.path()),
               Contains("buffers[0]: 'a.bin': a link that leads out of the scene's folder"));
  fs::remove(folder / "a.bin");
  fs::create_symlink("real.bin", folder / "a.bin");
  REQUIRE(result(inner.path()) == "loaded");
  // A folder of links into a store of files, and a folder that is a link as a whole.
  fs::create_directory(folder / "links");
  fs::create_symlink(folder / "t.gltf", folder / "links" / "scene.gltf");
  fs::create_symlink(folder / "real.bin", folder / "links" / "a.bin");
  REQUIRE(result(folder / "links" / "scene.gltf") == "loaded");
  fs::create_directory_symlink(folder, other / "door");
  REQUIRE(result(other / "door" / "t.gltf") == "loaded");
}

TEST_CASE("gltf: images of one buffer view share its bytes, and their pixels are charged against them once") {
  const Rgba8Image picture{2, 2, std::vector<std::uint8_t>(16, 200)};
  const TempGltf scratch("");
  const std::string png = scratch.path() + ".png";
  save_png(png, picture);
  std::vector<std::byte> bytes = traces::read_whole_file(png, 1 << 20);
  const auto load = [&](const std::string& images, SceneData& data) -> std::string {
    std::string all = triangle_gltf("", R"(,"images":[)" + images + "]");
    all.insert(all.find(R"("byteLength":36})") + 16,
               fmt::format(R"(,{{"buffer":1,"byteLength":{}}})", bytes.size()));
    all.insert(all.find(']', all.find(R"("buffers":[)")),
               fmt::format(R"(,{{"byteLength":{},"uri":"{}"}})", bytes.size(), data_uri(bytes)));
    const TempGltf file(all);
    GltfChoice choice;
    choice.leave_out = false;
    try {
      data = std::move(GltfScene(file.path(), choice).data());
    } catch (const UserError& error) { return error.what(); }
    return "loaded";
  };
  const std::string one = R"({"bufferView":1,"mimeType":"image/png"})";
  SceneData data;
  REQUIRE(load(one + "," + one, data) == "loaded");
  REQUIRE(data.images.size() == 2);
  REQUIRE(data.images[0].pixels().pixels == picture.pixels);
  REQUIRE(data.images[1].pixels().pixels == picture.pixels);
  // Its header says 8192x8192; 1.5 million bytes bring one of these about, and not two.
  bytes[18] = bytes[22] = std::byte{0x20};
  bytes[19] = bytes[23] = std::byte{0};
  bytes.resize(1500000);
  REQUIRE(load(one, data) == "loaded");
  REQUIRE_THAT(load(one + "," + one, data),
               Contains("images[1]: the images up to here are 134217728 pixels in 1500000 bytes of files"));
}
