/// What is counted by draw and by part of the screen. Units say which of their counters are such counts
/// (`Unit::details`); pipeline/report/detail.h says what the reports call them and which laws they obey.
#pragma once

#include "hw/base/details.h"

#include <cstddef>

namespace quadrille::hw {

/// What is counted by draw. Those from `kVerticesFetched` on only serve laws and queries.
enum class DrawCount : std::uint8_t {
  kTrianglesIn,
  kTrianglesDrawn,
  kVerticesShaded,
  kCovered,
  kShaded,
  kKilledEarly,
  kKilledLate,
  kDiscarded,
  kWritten,
  kSamples,
  kTexels,
  kTextureMisses,
  kVertexBytes,
  kTextureBytes,
  kDepthBytes,
  kColorBytes,
  kStorageBytes,
  kMemoryBytes,
  kVerticesFetched,
  kVerticesAssembled,
  kTrianglesFetched,
  kTrianglesClipped,
  kTrianglesWalked,
  kSamplesPacked,
  kPacked,
  kAtRop,
  kTextureSent,
  kTextureTaken,
  kSimdBusy,
  kClientRequests,
  kL2Requests,
  kFillBytes,
  kMemoryReadBytes,
  kIndices,
  kPiecesClipped,
  kSamplesWritten,
  kSamplesDiscarded
};
inline constexpr auto kReportedDrawCounts = static_cast<std::size_t>(DrawCount::kVerticesFetched);
inline constexpr auto kDrawCounts = static_cast<std::size_t>(DrawCount::kSamplesDiscarded) + 1;

/// What is counted by part of the screen.
enum class TileCount : std::uint8_t { kShaded, kKilledEarly, kTilesHidden, kWritten, kTextureMisses, kBytes };
inline constexpr auto kTileCounts = static_cast<std::size_t>(TileCount::kBytes) + 1;

}  // namespace quadrille::hw
