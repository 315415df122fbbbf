/// Shaders that came with the program: found by what they are compiled for, and the same words that the
/// compiler makes of their source.
#include "scenes/material/shader_pack.h"

#include <catch2/catch.hpp>

#include "scenes/material/glsl.h"
#include "scenes/material/material_variant.h"
#include "scenes/material/typical_shaders.h"
#include "scenes/scene.h"

using namespace quadrille;
using namespace quadrille::scenes;

TEST_CASE("shader pack: every shader is found by its key, and no other") {
  std::map<std::string, std::vector<std::uint32_t>> shaders;
  for (const std::size_t count : {0U, 1U, 2U, 7U, 40U}) {
    shaders.clear();
    for (std::size_t i = 0; i < count; ++i)
      shaders[std::string(1 + i * 5 % 11, static_cast<char>('a' + i % 26)) + std::to_string(i)] =
          std::vector<std::uint32_t>(1 + i % 9, 1000 + static_cast<unsigned>(i));
    const std::vector<std::uint32_t> words = write_shader_pack(shaders);
    const ShaderPack pack(words.data());
    REQUIRE(pack.size() == count);
    for (const auto& [key, wanted] : shaders) {
      const std::span<const std::uint32_t> found = pack.find(key);
      REQUIRE(std::vector<std::uint32_t>(found.begin(), found.end()) == wanted);
      REQUIRE(pack.find(key + "x").empty());
      REQUIRE(pack.find(key.substr(1)).empty());
    }
    REQUIRE(pack.find("").empty());
  }
}

TEST_CASE("shader pack: stages and the order of defines tell shaders apart") {
  REQUIRE(shader_key(traces::ShaderStage::kVertex, {"A", "B 1"}) !=
          shader_key(traces::ShaderStage::kFragment, {"A", "B 1"}));
  REQUIRE(shader_key(traces::ShaderStage::kVertex, {"A", "B 1"}) !=
          shader_key(traces::ShaderStage::kVertex, {"B 1", "A"}));
  REQUIRE(shader_key(traces::ShaderStage::kVertex, {"A"}) !=
          shader_key(traces::ShaderStage::kVertex, {"A", "B"}));
}

TEST_CASE("shader pack: what came with the program is what its source compiles to") {
  std::size_t from_source = 0;
  for (const char* name :
       {"triangle", "quad", "cubes", "courtyard", "overdraw", "fill", "flag", "materials"}) {
    INFO(name);
    SceneOptions options;
    options.width = options.height = 16;
    Scene ready(std::string("builtin:") + name, options);
    options.leave_out = false;
    Scene compiled(std::string("builtin:") + name, options);
    const traces::CommandStream a = ready.record({}), b = compiled.record({});
    REQUIRE(a.shaders.size() == b.shaders.size());
    for (std::size_t i = 0; i < a.shaders.size(); ++i)
      REQUIRE((a.shaders[i].stage == b.shaders[i].stage && a.shaders[i].spirv == b.shaders[i].spirv));
    REQUIRE(compiled.compiled_shaders() == b.shaders.size());
    REQUIRE(ready.compiled_shaders() < compiled.compiled_shaders());
    from_source += ready.compiled_shaders();
  }
  REQUIRE(from_source > 0);  // of layers and poses, which do not come with the program
}

TEST_CASE("shader pack: a scene of ordinary materials needs no compiler") {
  for (const char* name : {"builtin:triangle", "builtin:cubes", "builtin:courtyard"}) {
    SceneOptions options;
    options.width = options.height = 16;
    Scene scene(name, options);
    REQUIRE_FALSE(scene.record({}).shaders.empty());
    REQUIRE(scene.compiled_shaders() == 0);
  }
}

TEST_CASE("shader pack: the lectures' pipelines need no compiler for a scene of ordinary materials") {
  for (const char* name : {"builtin:triangle", "builtin:cubes", "builtin:courtyard"}) {
    SceneOptions options;
    options.width = options.height = 16;
    const auto compiled = [&] {
      Scene scene(name, options);
      REQUIRE_FALSE(scene.record({}).shaders.empty());
      return scene.compiled_shaders();
    };
    for (const Shading shading : {Shading::kMinimal, Shading::kFlat, Shading::kGouraud, Shading::kPhong}) {
      options.shading = shading;
      REQUIRE(compiled() == 0);
    }
    options.shading = Shading::kPbr;
    for (const Showing shown :
         {Showing::kDepth, Showing::kUv, Showing::kNormal, Showing::kTriangle, Showing::kLevel}) {
      options.shown = shown;
      REQUIRE(compiled() == 0);
    }
  }
}

TEST_CASE("shader pack: the typical shaders are many, of both stages, and compile") {
  const std::vector<TypicalShader> typical = typical_shaders();
  std::map<std::string, const TypicalShader*> distinct;
  for (const TypicalShader& shader : typical) distinct[shader_key(shader.stage, shader.defines)] = &shader;
  REQUIRE(distinct.size() > 200);
  std::size_t number = 0;
  for (const auto& [key, shader] : distinct) {
    if (number++ % 23 != 0) continue;
    REQUIRE(
        compile_glsl(material_shader_glsl(shader->stage, shader->set), shader->stage, "t", shader->defines)
            .size() > 100);
  }
}
