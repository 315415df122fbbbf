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

}  // namespace

TEST_CASE("gltf: textures have the levels of their KTX2 or DDS file") {
  const FileBytes blocks = levels_of(BlockCode::kBc1Rgba, 20, 12, 5);
  const TextureFile file{BlockCode::kBc1Rgba, 20, 12, 5, blocks};
  FileBytes expected;
  for (std::uint32_t level = 0; level < 5; ++level) {
    const Rgba8Image picture = decoded_level(file, level);
    const auto bytes = std::as_bytes(std::span(picture.pixels));
    expected.insert(expected.end(), bytes.begin(), bytes.end());
  }
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
    CHECK(textures[0].texels == expected);
  }
}

TEST_CASE("gltf: a scene whose KTX2 file holds Basis Universal is refused with the image's place") {
  const FileBytes blocks = levels_of(BlockCode::kBc1Rgba, 20, 12, 5);
  REQUIRE_THROWS_WITH(recorded(ktx2({.scheme = 1}, BlockCode::kBc1Rgba, blocks), R"("source":0)"),
                      Catch::Contains("images[0]") && Catch::Contains("BasisLZ"));
}

}  // namespace quadrille::scenes
