/// Captured frames beside what lavapipe drew of them: those of small programs of this project's own, those
/// of real programs, which are not part of the project; their tests pass by where the captures are not there.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>

#include "models/precision.h"
#include "pipeline/frame_contents.h"
#include "pipeline/render.h"
#include "scenes/image/image_io.h"
#include "tests/traces/capture/capture_folder.h"
#include "traces/attachment_texels.h"
#include "traces/capture/import.h"
#include "traces/trace_file.h"

namespace quadrille::capture {
namespace {

/// Pixels of a frame that differ from the picture by more than 2 of 255 in a colour.
std::size_t pixels_apart(const std::vector<std::uint32_t>& ours, const scenes::Rgba8Image& theirs) {
  std::size_t apart = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    bool far = false;
    for (std::size_t c = 0; c < 3; ++c)
      far = far || std::abs(static_cast<int>(ours[i] >> (8 * c) & 0xff) - int{theirs.pixels[4 * i + c]}) > 2;
    apart += far ? 1 : 0;
  }
  return apart;
}

struct Frame {
  const char* name;
  std::uint64_t draws;
  std::size_t apart;  ///< pixels of 120000 that may be more than 2 of 255 apart
};
// 99.9 % of the pixels are all but 120.
constexpr Frame kFrames[] = {{"glxgears", 12, 120},         {"gm_buffer_map", 1, 120},
                             {"gm_build", 1, 120},          {"gm_bump_height", 1, 120},
                             {"gm_bump_normals", 1, 120},   {"gm_conditionals_f", 1, 120},
                             {"gm_desktop_blur", 14, 120},  {"gm_ideas", 227, 120},
                             {"gm_jellyfish", 2, 120},      {"gm_loop", 1, 120},
                             {"gm_shading_phong", 1, 120},  {"gm_shadow", 3, 120},
                             {"gm_texture_mipmap", 1, 120}, {"vkcube", 1, 120}};

}  // namespace

TEST_CASE("capture: a frame of this project's own program is what lavapipe draws of it") {
  const std::string path = QUADRILLE_SOURCE_DIR "/tests/traces/capture/own/spinning_cube";
  const Import import = import_capture(path + ".gfxr");
  CHECK(import.notes.empty());
  CHECK(traces::stream_totals(import.stream).draws == 2);
  const pipeline::FrameImage image =
      pipeline::render_functional_frame(import.stream, models::Precision{}).image;
  const scenes::Rgba8Image theirs = scenes::load_image(path + ".png");
  REQUIRE(image.width == theirs.width);
  REQUIRE(image.height == theirs.height);
  CHECK(pixels_apart(image.color, theirs) <= image.color.size() / 1000);
}

TEST_CASE("capture: a frame of a native Vulkan program is what lavapipe draws, on the exact machine too") {
  const std::string path = QUADRILLE_SOURCE_DIR "/tests/traces/capture/own/native_frame";
  const Import import = import_capture(path + ".gfxr");
  CHECK(import.notes.empty());
  // Of two passes two draws each, and a copy and a blit; the resolve is a pass without a draw.
  CHECK(traces::stream_totals(import.stream).draws == 6);
  CHECK(traces::stream_totals(import.stream).passes == 5);
  const pipeline::FrameImage image =
      pipeline::render_functional_frame(import.stream, models::Precision{}).image;
  const scenes::Rgba8Image theirs = scenes::load_image(path + ".png");
  REQUIRE(image.width == theirs.width);
  REQUIRE(image.height == theirs.height);
  CHECK(pixels_apart(image.color, theirs) <= image.color.size() / 1000);
  CHECK(pipeline::render_exact(import.stream, pipeline::MachineConfig()).image.color == image.color);
}

TEST_CASE("capture: frames of a program that draws each on top of the last are what lavapipe draws of them") {
  const std::string path = QUADRILLE_SOURCE_DIR "/tests/traces/capture/own/trail";
  REQUIRE(count_frames(path + ".gfxr") == 3);
  CaptureFrames frames(path + ".gfxr");
  for (int frame = 0; frame < 3; ++frame) {
    CAPTURE(frame);
    const std::optional<Import> import = frames.next();
    REQUIRE(import);
    CHECK(import->notes.empty());
    // The first one clears; later ones load colours and depths of a framebuffer.
    const auto begun = std::ranges::count_if(import->stream.images, traces::begins_with_texels);
    CHECK((frame == 0 ? begun == 0 : begun >= 2));
    const pipeline::FrameImage image =
        pipeline::render_functional_frame(import->stream, models::Precision{}).image;
    if (frame > 0) {
      const scenes::Rgba8Image theirs = scenes::load_image(path + "_" + std::to_string(frame) + ".png");
      REQUIRE(image.width == theirs.width);
      REQUIRE(image.height == theirs.height);
      CHECK(pixels_apart(image.color, theirs) <= image.color.size() / 1000);
    }
    frames.keep(pipeline::contents_after(import->stream, models::Precision{}));
  }
  CHECK_FALSE(frames.next());
}

TEST_CASE("capture: frames of real programs are what lavapipe draws of them") {
  const auto folder = capture_folder();
  if (!folder) return;
  for (const Frame& frame : kFrames) {
    CAPTURE(frame.name);
    const std::string path = (*folder / frame.name).string();
    const Import import = import_capture(path + ".gfxr");
    CHECK(traces::stream_totals(import.stream).draws == frame.draws);
    const pipeline::FrameImage image =
        pipeline::render_functional_frame(import.stream, models::Precision{}).image;
    const scenes::Rgba8Image theirs = scenes::load_image(path + ".png");
    REQUIRE(image.width == theirs.width);
    REQUIRE(image.height == theirs.height);
    CHECK(pixels_apart(image.color, theirs) <= frame.apart);
  }
}

TEST_CASE("capture: a trace that was imported holds the frame of its capture") {
  const auto folder = capture_folder();
  if (!folder) return;
  const Import import = import_capture((*folder / "vkcube.gfxr").string());
  CHECK(traces::decode_trace(traces::encode_trace(import.stream), "trace") == import.stream);
}

}  // namespace quadrille::capture
