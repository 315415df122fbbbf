/// Compiles the materials' typical shaders while the program is built: make_shader_pack FILE writes them
/// (scenes/material/shader_pack.h).
#include <cstdio>
#include <exception>
#include <fstream>

#include "scenes/material/glsl.h"
#include "scenes/material/material_variant.h"
#include "scenes/material/shader_pack.h"
#include "scenes/material/typical_shaders.h"

namespace {

using namespace quadrille::scenes;

std::map<std::string, std::vector<std::uint32_t>> compiled() {
  std::map<std::string, std::vector<std::uint32_t>> shaders;
  for (const TypicalShader& shader : typical_shaders()) {
    std::vector<std::uint32_t>& words = shaders[shader_key(shader.stage, shader.defines)];
    if (words.empty())
      words = compile_glsl(material_shader_glsl(shader.stage, shader.set), shader.stage,
                           material_shader_name(shader.stage, shader.set), shader.defines);
  }
  return shaders;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_shader_pack FILE\n", stderr);
    return 2;
  }
  try {
    const std::vector<std::uint32_t> pack = write_shader_pack(compiled());
    std::ofstream file(argv[1], std::ios::binary);
    file.write(reinterpret_cast<const char*>(pack.data()), static_cast<std::streamsize>(4 * pack.size()));
    return file.flush() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_shader_pack: %s\n", error.what());
    return 1;
  }
}
