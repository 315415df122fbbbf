/// glTF files through the whole loader and recorder.
#include "scenes/scene.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/refusal.h"
#include "tests/fuzz/targets.h"
#include "tests/fuzz/tiny_frame.h"

namespace quadrille::fuzz {
namespace {

constexpr std::string_view kPlainVertex = "#version 450\nvoid main() { gl_Position = vec4(0); }\n";
constexpr std::string_view kPlainFragment =
    "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1); }\n";

/// The same for the same bytes, everywhere. [P: FNV-1a]
std::uint32_t hash(Bytes bytes) {
  std::uint32_t value = 2166136261u;
  for (const std::byte b : bytes) value = (value ^ std::to_integer<std::uint32_t>(b)) * 16777619u;
  return value ^ value >> 15;
}

}  // namespace

void run_scene(Bytes bytes) {
  static const MemoryFile file, vertex, fragment;
  static const bool prepared = (vertex.put(std::as_bytes(std::span(kPlainVertex))),
                                fragment.put(std::as_bytes(std::span(kPlainFragment))), true);
  file.put(bytes);
  scenes::SceneOptions options;
  options.width = options.height = 8;
  // Compiling the materials' shaders takes a hundred times as long as all else, so one input in sixteen is
  // drawn.
  const bool drawn = hash(bytes) % 16 == 0;
  if (prepared && !drawn) {
    options.vertex_shader = vertex.path();
    options.fragment_shader = fragment.path();
  }
  traces::CommandStream stream;
  const bool loaded =
      done_or_refused(file.path(), [&] { stream = scenes::load_scene(file.path(), options); });
  if (loaded && drawn) done_or_refused("", [&] { draw_if_small(stream); });
}

}  // namespace quadrille::fuzz
