#include "tests/lavapipe/llvmpipe_counts.h"

#include <array>
#include <optional>

#include "studies/experiments/triangle_work.h"

namespace quadrille::lavapipe {
namespace {

constexpr std::size_t kRunTriangles = 1023 / 3, kRemembered = 256;
constexpr studies::experiments::Sample kCentre[] = {{}};

}  // namespace

std::uint64_t llvmpipe_vertex_invocations(const studies::experiments::TriangleMesh& mesh) {
  std::uint64_t shaded = 0;
  std::array<std::optional<std::uint32_t>, kRemembered> remembered;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % kRunTriangles == 0) remembered.fill(std::nullopt);
    for (const std::uint32_t index : mesh.triangles[i]) {
      auto& slot = remembered[index % kRemembered];
      if (slot != index) ++shaded;
      slot = index;
    }
  }
  return shaded;
}

std::uint64_t llvmpipe_fragment_invocations(const studies::experiments::TriangleMesh& mesh) {
  return 16 * studies::experiments::coverage_of(mesh, kCentre).blocks;
}

}  // namespace quadrille::lavapipe
