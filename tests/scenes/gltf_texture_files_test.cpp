/// Textures of glTF whose images are KTX2 or DDS files with their own levels.
#include <catch2/catch.hpp>

#include <memory>
#include <tuple>
#include <utility>

#include "models/texture/block/block_format.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/image/texture_file.h"
#include "scenes/record/recorder.h"
#include "scenes/scene.h"
#include "tests/scenes/gltf_text.h"
#include "tests/scenes/texture_files.h"

namespace quadrille::scenes {

using models::BlockCode;

namespace {

/// What a glTF file that names this texture's file by `texture` records: its images that bring texels.
std::vector<traces::Image> recorded(const FileBytes& file, const std::string& texture) {
  const TempGltf gltf(triangle_gltf(
      R"(,"material":0)", R"(,"materials":[{"emissiveTexture":{"index":0}}],"textures":[{)" + texture +
                              R"(}],"images":[{"uri":")" + data_uri(file) + R"("}])"));
  SceneOptions options;
  options.width = options.height = 16;
  options.leave_out = false;
  std::vector<traces::Image> textures;
  for (const traces::Image& image : load_scene(gltf.path(), options).images)
    if (!image.is_attachment()) textures.push_back(image);
  return textures;
}

/// What a card with this texture in this slot of its material records: its images that bring texels.
std::vector<traces::Image> recorded_in(TextureSlot slot, TextureFile file) {
  SceneData scene;
  scene.images.emplace_back("t", std::make_shared<const TextureFile>(std::move(file)));
  Material m;
  m.emissive = glm::vec3(1);
  m.texture(slot).image = 0;
  scene.materials.push_back(m);
  MeshBuilder mesh;
  mesh.box(glm::vec3(-1), glm::vec3(1), 1);
  place(scene, mesh.finish(scene, "card", 0, {}));
  SceneOptions options;
  options.width = options.height = 16;
  std::vector<traces::Image> textures;
  for (const traces::Image& image : Recorder(scene, options).record().images)
    if (!image.is_attachment()) textures.push_back(image);
  return textures;
}

}  // namespace

TEST_CASE("gltf: textures have the levels of their KTX2 or DDS file") {
  const FileBytes blocks = levels_of(BlockCode::kBc1Rgba, 20, 12, 5);
  const std::string by_source = R"("source":0)",
                    by_extension = R"("extensions":{"MSFT_texture_dds":{"source":0}})";
  for (const auto& [bytes, texture] : {std::pair{ktx2({}, BlockCode::kBc1Rgba, blocks), by_source},
                                       {ktx2({.scheme = 2}, BlockCode::kBc1Rgba, blocks), by_source},
                                       {dds("DXT1", 0, 20, 12, 5, blocks), by_extension}}) {
    const std::vector<traces::Image> textures = recorded(bytes, texture);
    REQUIRE(textures.size() == 1);
    CHECK(textures[0].width == 20);
    CHECK(textures[0].height == 12);
    CHECK(textures[0].levels == 5);
    CHECK(textures[0].format == traces::Format::kBc1RgbaUnorm);  // no shader reads it
    CHECK(textures[0].texels == blocks);
  }
}

TEST_CASE("gltf: blocks of a KTX2 file stay blocks where the machine has their format") {
  using traces::Format;
  for (const auto& [number, code, slot, format] :
       {std::tuple{145u, BlockCode::kBc7, TextureSlot::kEmissive, Format::kBc7Srgb},
        {145u, BlockCode::kBc7, TextureSlot::kOcclusion, Format::kBc7Unorm},
        {141u, BlockCode::kBc5Unorm, TextureSlot::kNormal, Format::kBc5Unorm},
        {166u, BlockCode::kAstc6x6Srgb, TextureSlot::kEmissive, Format::kAstc6x6Srgb},
        {166u, BlockCode::kAstc6x6Srgb, TextureSlot::kOcclusion, Format::kAstc6x6Unorm},
        {149u, BlockCode::kEtc2Rgb8A1, TextureSlot::kEmissive, Format::kEtc2Rgb8A1Srgb},
        // No format with sRGB; numbers with a sign, which glTF's textures do not have; halves.
        {139u, BlockCode::kBc4Unorm, TextureSlot::kEmissive, Format::kR8G8B8A8Srgb},
        {142u, BlockCode::kBc5Snorm, TextureSlot::kNormal, Format::kR8G8B8A8Unorm},
        {143u, BlockCode::kBc6hUfloat, TextureSlot::kEmissive, Format::kR8G8B8A8Srgb}}) {
    INFO(models::block_code_info(code).name << " in slot " << static_cast<int>(slot));
    const FileBytes blocks = levels_of(code, 20, 12, 5);
    const std::vector<traces::Image> textures =
        recorded_in(slot, read_texture_file(ktx2({.vk_format = number}, code, blocks), "t.ktx2"));
    REQUIRE(textures.size() == 1);
    CHECK(textures[0].format == format);
    const bool stays = models::is_block_format(format);
    CHECK((textures[0].texels == blocks) == stays);
    if (stays) continue;
    const TextureFile file{code, 20, 12, 5, blocks};
    FileBytes expected;
    for (std::uint32_t level = 0; level < 5; ++level) {
      const Rgba8Image picture = decoded_level(file, level);
      const auto bytes = std::as_bytes(std::span(picture.pixels));
      expected.insert(expected.end(), bytes.begin(), bytes.end());
    }
    CHECK(textures[0].texels == expected);
  }
}

TEST_CASE("gltf: a scene whose KTX2 file holds Basis Universal is refused with the image's place") {
  const FileBytes blocks = levels_of(BlockCode::kBc1Rgba, 20, 12, 5);
  REQUIRE_THROWS_WITH(recorded(ktx2({.scheme = 1}, BlockCode::kBc1Rgba, blocks), R"("source":0)"),
                      Catch::Contains("images[0]") && Catch::Contains("BasisLZ"));
}

}  // namespace quadrille::scenes
