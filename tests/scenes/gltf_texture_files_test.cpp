/// Textures of glTF whose images are KTX2 or DDS files with their own levels.
#include <catch2/catch.hpp>

#include "scenes/image/texture_file.h"
#include "scenes/scene.h"
#include "tests/scenes/gltf_text.h"
#include "tests/scenes/texture_files.h"

namespace quadrille::scenes {

using models::BlockCode;

namespace {

/// What a glTF file that names this texture's file by `texture` records: its images that bring texels.
std::vector<traces::Image> recorded(const FileBytes& file, const std::string& texture,
                                    const std::string& role = "emissiveTexture") {
  const TempGltf gltf(triangle_gltf(R"(,"material":0)", R"(,"materials":[{"emissiveFactor":[1,1,1],")" +
                                                            role + R"(":{"index":0}}],"textures":[{)" +
                                                            texture + R"(}],"images":[{"uri":")" +
                                                            data_uri(file) + R"("}])"));
  SceneOptions options;
  options.width = options.height = 16;
  options.leave_out = false;
  std::vector<traces::Image> textures;
  for (const traces::Image& image : load_scene(gltf.path(), options).images)
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
    CHECK(textures[0].format == traces::Format::kBc1RgbaSrgb);
    CHECK(textures[0].texels == blocks);
  }
}

TEST_CASE("gltf: blocks of a KTX2 file stay blocks where the machine has their format") {
  using traces::Format;
  for (const auto& [number, code, role, format] :
       {std::tuple{145u, BlockCode::kBc7, "emissiveTexture", Format::kBc7Srgb},
        {145u, BlockCode::kBc7, "occlusionTexture", Format::kBc7Unorm},
        {141u, BlockCode::kBc5Unorm, "normalTexture", Format::kBc5Unorm},
        {166u, BlockCode::kAstc6x6Srgb, "emissiveTexture", Format::kAstc6x6Srgb},
        {166u, BlockCode::kAstc6x6Srgb, "occlusionTexture", Format::kAstc6x6Unorm},
        {149u, BlockCode::kEtc2Rgb8A1, "emissiveTexture", Format::kEtc2Rgb8A1Srgb},
        // No format with sRGB; numbers with a sign, which glTF's textures do not have; halves.
        {139u, BlockCode::kBc4Unorm, "emissiveTexture", Format::kR8G8B8A8Srgb},
        {142u, BlockCode::kBc5Snorm, "normalTexture", Format::kR8G8B8A8Unorm},
        {143u, BlockCode::kBc6hUfloat, "emissiveTexture", Format::kR8G8B8A8Srgb}}) {
    INFO(models::block_code_info(code).name << " " << role);
    const FileBytes blocks = levels_of(code, 20, 12, 5);
    const std::vector<traces::Image> textures =
        recorded(ktx2({.vk_format = number}, code, blocks), R"("source":0)", role);
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
