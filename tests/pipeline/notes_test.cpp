#include "pipeline/report/notes.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "pipeline/render.h"
#include "scenes/scene.h"
#include "tests/hw/contract.h"

using namespace quadrille;
using namespace quadrille::pipeline;

namespace {

/// What is said of a frame that wrote nothing.
std::string note_on(const FrameFigures& frame) {
  Figures figures;
  figures.frame = frame;
  const std::vector<std::string> notes = notes_on(figures);
  REQUIRE(notes.size() == 1);
  CHECK(notes.front().find('\n') == std::string::npos);
  return notes.front();
}

std::vector<std::uint64_t> triangle_fates(const Fates& f) {
  return {f.off_screen, f.not_finite, f.culled, f.no_area, f.no_sample, f.rasterised};
}

}  // namespace

TEST_CASE("notes: a frame in which a fragment was written has none") {
  Figures figures;
  figures.frame.fragments_written = 1;
  CHECK(notes_on(figures).empty());
}

TEST_CASE("notes: a frame without a written fragment says what became of its triangles and fragments") {
  FrameFigures frame;
  CHECK(note_on(frame) ==
        "nothing was drawn: the frame has no draws; has the scene a mesh with positions, and is it shown?");
  frame.draws = 2;
  CHECK(note_on(frame) == "nothing was drawn: the 2 draws of the frame have no triangles");
  frame.triangles = 5000;
  frame.fates.off_screen = 4990;
  frame.fates.culled = 6;
  frame.fates.no_sample = 3;
  frame.fates.rasterised = 1;
  CHECK(note_on(frame) ==
        "nothing was drawn: no triangle covers a pixel: 4,990 off screen, 6 culled by their facing, 4 "
        "between pixel centres");
  frame.fates.tiles_hidden = 1;
  CHECK(note_on(frame) == "nothing was drawn: every fragment failed the depth test");
  frame.fragments_shaded = 70;
  frame.fates.discarded = 70;
  CHECK(note_on(frame) == "nothing was drawn: no fragment passed: 70 discarded by their shader");
}

TEST_CASE("notes: the machine and the functional run agree on what becomes of triangles") {
  scenes::SceneOptions options;
  options.width = 64;
  options.height = 48;
  options.eye = glm::vec3(0.5F, 0.4F, 0.3F);
  const auto stream = scenes::load_scene("builtin:cubes", options);
  const MachineConfig machine;
  const Fates functional = render_functional_frame(stream, machine.precision()).figures.frame.fates;
  CHECK(functional.off_screen > 0);
  CHECK(functional.culled > 0);
  CHECK(functional.rasterised > 0);
  const std::string exact = hw::contract::in_child([&] {
    return fmt::format("{}",
                       fmt::join(triangle_fates(render_exact(stream, machine).figures.frame.fates), " "));
  });
  CHECK(exact == fmt::format("{}", fmt::join(triangle_fates(functional), " ")));
}
