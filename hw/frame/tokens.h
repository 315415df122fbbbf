/// Tokens: what travels through the FIFOs. Small and trivially copyable; bulk stays in a store (stores.h) and
/// travels as a slot number.
///
/// Geometry and raster tokens carry in-band markers, so that "everything before this point has passed" needs
/// no other channel:
///   kDrawEnd   the last token of a draw            kPassEnd  the last token of a pass: flush
///   kBatchEnd  the last triangle of a vertex batch (its slot may be reused)
///   kRangeEnd  the same, and what follows in the draw comes from the next geometry front end
///   kSync      all tiles of the triangles before `sequence` have passed (their slots may be reused once
///   retired)
#pragma once

#include "hw/base/work_log.h"
#include "models/base/pipeline_state.h"
#include "models/geometry/post_transform.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace quadrille::hw {

using models::PartitionId;
using models::PassId;
using models::WarpSlotId;

enum class TokenKind : std::uint8_t { kWork, kBatchEnd, kDrawEnd, kPassBegin, kPassEnd, kSync, kRangeEnd };

/// What a token is a part of: a draw, or, of one that begins or ends a pass, the pass.
class FramePart {
 public:
  constexpr FramePart() = default;
  // Either is a part of the frame as it is: not explicit.
  constexpr FramePart(DrawId draw) : bits_(draw.index()) {}            // NOLINT(google-explicit-constructor)
  constexpr FramePart(PassId pass) : bits_(pass.index() | kIsPass) {}  // NOLINT(google-explicit-constructor)
  /// `kNoDraw` if it is a pass.
  [[nodiscard]] constexpr DrawId draw() const { return (bits_ & kIsPass) != 0 ? kNoDraw : DrawId(bits_); }
  /// It is a pass.
  [[nodiscard]] constexpr PassId pass() const { return PassId(bits_ & ~kIsPass); }

 private:
  static constexpr std::uint32_t kIsPass = 0x80000000u;
  std::uint32_t bits_ = 0;
};

/// Command processor -> vertex fetch: draw it, or a pass boundary.
struct DrawToken {
  TokenKind kind = TokenKind::kWork;
  FramePart part;
};

/// Vertex fetch -> primitive assembly: a batch's triangles, in draw order.
struct BatchToken {
  TokenKind kind = TokenKind::kWork;
  FramePart part;
  std::uint32_t slot = 0;  ///< in the batch store
};

/// Vertex fetch -> core: shade this batch.
struct VertexWarpToken {
  DrawId draw;
  std::uint32_t slot = 0;  ///< in the batch store
};

/// Warp packer -> core: run this fragment warp.
struct FragmentWarpToken {
  DrawId draw;
  WarpSlotId slot;
  PartitionId partition;
  std::uint16_t tile_x = 0, tile_y = 0;  ///< of its first quad
};

/// Core -> primitive assembly: the batch in this slot is shaded.
struct VertexDoneToken {
  std::uint32_t slot = 0;
};

/// Primitive assembly -> clipper: one triangle of shaded vertices.
struct PrimitiveToken {
  TokenKind kind = TokenKind::kWork;
  FramePart part;
  std::uint32_t slot = 0;       ///< kBatchEnd, kRangeEnd: batch
  std::uint32_t primitive = 0;  ///< 0-based in the draw's instance
  models::VertexPlace corner[3] = {};
};

/// Clipper -> set-up: a triangle or a piece of a clipped one; its window vertices are in the clipper's ring.
struct ClippedToken {
  TokenKind kind = TokenKind::kWork;
  FramePart part;
  std::uint32_t slot = 0;  ///< kBatchEnd, kRangeEnd: batch
  std::uint32_t primitive = 0;
  models::VertexPlace corner[3] = {};
  std::uint32_t piece = 0;  ///< slot in the ring of clipped pieces
};

/// Set-up -> coarse rasteriser. `triangle` is a sequence number; its slot in the triangle store is the
/// remainder by the store's size.
struct TriangleToken {
  TokenKind kind = TokenKind::kWork;
  FramePart part;
  std::uint64_t triangle = 0;
};

/// Coarse rasteriser -> fine rasteriser.
struct TileToken {
  TokenKind kind = TokenKind::kWork;
  bool fully_covered = false;
  std::uint16_t tile_x = 0, tile_y = 0;
  FramePart part;
  std::uint64_t triangle = 0;  ///< kSync: every triangle before this one
  /// what is covered, in the store of walked tiles; or the fine rasteriser tests it
  std::uint32_t walked = kNotWalked;
  static constexpr std::uint32_t kNotWalked = ~std::uint32_t{0};
  bool in_front = false;  ///< every fragment passes the depth test: it is nearer than all that is there
};

/// Fine rasteriser -> depth unit -> warp packer: the covered pixels of one triangle in one tile. Of several
/// samples a pixel: those of which one sample is covered; a token for each sample, one after the other.
struct CoverageToken {
  TokenKind kind = TokenKind::kWork;
  bool late = false;  ///< set by the depth unit: test and write after shading
  std::uint16_t tile_x = 0, tile_y = 0;
  FramePart part;
  std::uint64_t triangle = 0;
  std::uint64_t coverage = 0;  ///< quad-major
  std::uint8_t sample = 0;
  bool first = true, last = true;  ///< of the tokens of its triangle in its tile
  bool in_front = false;           ///< as of its tile
};

/// Warp packer -> ROP: what retires next, in order. kWork: the warp in `slot`; `sync` (if not 0) may be
/// reported when it has retired.
struct OrderToken {
  TokenKind kind = TokenKind::kWork;
  FramePart part;
  WarpSlotId slot;
  std::uint64_t sync = 0;
};

/// Core -> ROP: the fragment warp in this slot is shaded.
struct FragmentDoneToken {
  WarpSlotId slot;
};

/// ROP <-> late port of the depth unit: test the warp in this slot (the survivors are written to it), or
/// (kPassEnd) flush.
struct LateToken {
  TokenKind kind = TokenKind::kWork;
  WarpSlotId slot;
};

/// ROP -> warp packer: the slot of a retired warp is free again.
struct WarpReleaseToken {
  WarpSlotId slot;
};

/// A slot is free again. With `sequence`: everything before it is.
struct ReleaseToken {
  std::uint32_t slot = 0;
  std::uint64_t sequence = 0;
};

/// Depth unit -> coarse rasteriser: no depth in this tile is greater than `max_depth`.
struct HiZToken {
  std::uint16_t tile_x = 0, tile_y = 0;
  PassId pass;
  float max_depth = 1;
};

/// ROP -> command processor: draw retired in this partition, or pass flushed.
struct RetireToken {
  TokenKind kind = TokenKind::kDrawEnd;
  FramePart part;
};

/// Core <-> texture unit: the texture requests of the warp in this core slot.
struct TextureToken {
  std::uint32_t slot = 0;
  DrawId draw;
  models::ShaderStage stage = models::ShaderStage::kVertex;
};

/// Core <-> load-store unit: the storage requests of the warp in this core slot.
struct StorageToken {
  std::uint32_t slot = 0;
  DrawId draw;
  models::ShaderStage stage = models::ShaderStage::kVertex;
};

/// On whose behalf memory is accessed.
enum class MemoryClient : std::uint8_t {
  kVertexFetch,
  kTexture,
  kStorage,
  kDepth,
  kColor,
  kScanOut,
  kWriteBack
};
inline constexpr std::size_t kMemoryClients = 7;
[[nodiscard]] constexpr std::string_view name_of(MemoryClient client) {
  constexpr std::array<std::string_view, kMemoryClients> kNames{
      "vertex_fetch", "texture", "storage", "depth", "color", "scan_out", "write_back"};
  return kNames[static_cast<std::size_t>(client)];
}

/// A client's request to the memory system: sectors of one 128-byte line. `tag` comes back with the answer.
/// Writes are not answered; a fence is, once all requests of its client before it have been taken in.
struct MemoryRequest {
  enum class Kind : std::uint8_t {
    kRead,
    kWrite,      ///< sectors that are known whole
    kWritePart,  ///< a part of each sector: whoever lacks the rest fetches it
    kAtomic,     ///< words of each sector are updated where they are; answered with what they were
    kFence
  };
  std::uint32_t line = 0;  ///< device address / 128
  std::uint32_t tag = 0;
  std::uint8_t sectors = 0;
  Kind kind = Kind::kRead;
  MemoryClient client = MemoryClient::kVertexFetch;  ///< written by the L2 slice
  DrawId draw = kNoDraw;                             ///< for the figures alone: on whose behalf
};
struct MemoryResponse {
  std::uint32_t line = 0;
  std::uint32_t tag = 0;
  std::uint8_t sectors = 0;
};

/// Command processor -> scan-out: show the target of this pass.
struct ScanToken {
  PassId pass;
};

}  // namespace quadrille::hw
