#include "tests/fuzz/tiny_frame.h"

#include <algorithm>

#include "pipeline/driver/frame_builder.h"
#include "pipeline/functional/functional.h"
#include "traces/trace_file.h"

namespace quadrille::fuzz {
namespace {

constexpr std::uint64_t kMaxPixels = 4096, kMaxVertices = 3000, kMaxBytes = std::uint64_t{1} << 24,
                        kMaxPasses = 8, kMaxDraws = 64;
constexpr std::uint64_t kMaxOverdraw = 1 << 20;  ///< pixels times triangles

bool is_small(const traces::CommandStream& stream) {
  std::uint64_t pixels = 0;
  for (const traces::Image& image : stream.images) {
    if (image.is_attachment())
      pixels = std::max(pixels, std::uint64_t{image.width} * image.height * image.layers);
  }
  const traces::StreamTotals totals = traces::stream_totals(stream);
  return pixels <= kMaxPixels && totals.vertices <= kMaxVertices &&
         totals.buffer_bytes + totals.image_bytes <= kMaxBytes && totals.passes <= kMaxPasses &&
         totals.draws <= kMaxDraws && pixels * totals.triangles <= kMaxOverdraw;
}

/// A loop may take its million iterations in every warp.
bool loops(const models::Program& program) {
  return std::ranges::any_of(program.code,
                             [](const models::Instruction& i) { return i.op == models::Op::kLoop; });
}

}  // namespace

void draw_if_small(const traces::CommandStream& stream) {
  if (!is_small(stream)) return;
  pipeline::DeviceFrame frame(std::uint64_t{1} << 28);
  pipeline::build_frame(stream, {}, frame);
  const bool endless =
      std::ranges::any_of(frame.programs, [](const auto& p) { return loops(p.vertex) || loops(p.fragment); });
  if (!endless) (void)pipeline::render_functional(frame.frame, frame.memory);
}

}  // namespace quadrille::fuzz
