/// A warp in execution: its registers, masks and place in the program, and the function that runs it up to
/// its next wait.
///
/// The core calls `run_clause` when a warp is issued. A *clause* is what executes without giving up the issue
/// slot: it ends before the results of a group of texture instructions are needed, or at the end of the
/// program. Values depend on the warp's own lanes only, never on time.
#pragma once

#include "models/memory/storage.h"
#include "models/shader/isa.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille::models {

class WarpClock;

using LaneFloats = std::array<float, kWarpLanes>;
using LaneWords = std::array<std::uint32_t, kWarpLanes>;
using LaneMask = std::uint32_t;  ///< bit i = lane i; quad q owns bits 4q..4q+3

/// Inputs of a fragment warp, lane = 4 * quad + pixel, pixels of a quad in the order (0,0) (1,0) (0,1) (1,1).
struct FragmentInputs {
  alignas(64) LaneFloats x, y, z, inv_w;  ///< FragCoord: pixel centre (pixels), window depth, 1/w_clip
  /// perspective-correct weights of the triangle's second and third vertex
  alignas(64) LaneFloats persp_1, persp_2;
  /// the same, linear in screen space; of a point, its coordinates
  alignas(64) LaneFloats linear_1, linear_2;
  /// the four of them at the place of centroid varyings, for programs that `reads_coverage`
  alignas(64) LaneFloats centroid_persp_1, centroid_persp_2, centroid_linear_1, centroid_linear_2;
  alignas(64) LaneFloats sample_x, sample_y;  ///< where in the pixel, for programs by sample
  alignas(64) LaneFloats line_coverage;       ///< of smooth lines: how much of the pixel is covered
  LaneWords sample_id, sample_mask;           ///< for programs by sample, and those that `reads_coverage`
  LaneWords front_facing, primitive_id;       ///< all ones / zero; 0-based primitive of the draw
  /// Per quad: `3 * varyings.size()` floats, (a0, a1 - a0, a2 - a0) for each scalar component. A quad that is
  /// not used points at a valid one.
  std::array<const float*, kWarpQuads> varyings{};
};

/// Inputs of a vertex warp: one row of 32 lanes for each entry of `Program::vertex_inputs`.
struct VertexInputs {
  const LaneWords* attributes = nullptr;
  LaneWords vertex_index, instance_index;
};

/// What a warp of a program with storage buffers needs besides.
struct WarpStorage {
  StorageMemory* memory = nullptr;
  const StorageView* buffers = nullptr;  ///< by the program's buffer index
  std::uint32_t pass = 0;                ///< of the frame
  LaneMask live = 0;                     ///< lanes that may write: helpers may not
  bool may_repeat = false;               ///< the invocations may have run before (vertices)
  std::array<Invocation, kWarpLanes> invocations;
  LaneWords updates{};  ///< atomic operations done, by lane
};

/// One storage instruction of a warp. Its effect and result are there when it has executed; the request says
/// what it moves.
struct StorageRequest {
  LaneWords offset;     ///< bytes in the buffer
  LaneMask active = 0;  ///< lanes that accessed
  Op op = Op::kLoadBuffer;
  std::uint16_t binding = 0;  ///< index into Program::buffers
};

/// One texture instruction of a warp, from its issue to its result.
struct TextureRequest {
  alignas(64) LaneFloats u, v, lod;                   ///< `lod`: bias or explicit level, by `op`
  std::array<LaneFloats, kMaxTextureWords - 3> more;  ///< further words of `operation`
  /// lanes that executed it (helpers included); u, v, lod hold all 32 lanes, so a quad's differences exist
  LaneMask active = 0;
  Op op = Op::kTexImplicit;
  const TextureOperation* operation = nullptr;  ///< of kTexOp and kTexOpQuad
  std::uint16_t binding = 0;                    ///< index into Program::textures
  std::uint16_t dst = 0;
  /// A word of `operation`: those of the coordinates come first.
  [[nodiscard]] LaneFloats& word(std::size_t i) {
    return i == 0 ? u : i == 1 ? v : i == 2 ? lod : more[i - 3];
  }
  [[nodiscard]] const LaneFloats& word(std::size_t i) const {
    return i == 0 ? u : i == 1 ? v : i == 2 ? lod : more[i - 3];
  }
};

inline constexpr int kMaxClauseRequests = 8;  ///< texture and storage instructions
inline constexpr int kMaxControlDepth = 32;

/// Instructions issued by one clause, by class; a divided warp issues both sides, and a side that no lane
/// takes is jumped over and not counted. Texture and storage instructions are not among them:
/// `Warp::texture_count` and `Warp::access_count` say how many the clause issued (their lanes are in
/// `lane_ops`).
struct ClauseCost {
  std::uint32_t alu = 0, sfu = 0, interp = 0, constant = 0, control = 0, exported = 0;
  std::uint64_t lane_ops = 0;  ///< sum over instructions of active lanes
  [[nodiscard]] std::uint32_t instructions() const {
    return alu + sfu + interp + constant + control + exported;
  }
};

/// Size of a bound texture, for kTexSize and kTexDims.
struct TextureSize {
  std::uint32_t width = 1, height = 1, levels = 1;
  std::uint32_t depth = 1, layers = 0;  ///< layers of an array (of cubes: as many as cubes), else 0
  std::uint32_t samples = 0;            ///< a texel of a multisampled view, which has one level, else 0
};

/// One register of a warp, aligned to a host cache line.
struct alignas(64) RegisterRow : LaneWords {};

/// Back edges one warp may take, and instructions it may have executed at one, before its program counts as
/// endless. A texture or storage request counts as many.
inline constexpr std::uint32_t kMaxBackEdges = 1u << 20;
inline constexpr std::uint64_t kMaxLoopInstructions = std::uint64_t{1} << 26, kRequestInstructions = 256;

struct Warp {
  const Program* program = nullptr;
  const std::uint32_t* constants = nullptr;  ///< the draw's constant file
  const VertexInputs* vertex = nullptr;      ///< vertex stage
  const FragmentInputs* fragment = nullptr;  ///< fragment stage
  /// by texture binding of the program; needed only by programs with kTexSize
  const TextureSize* texture_sizes = nullptr;
  WarpStorage* storage = nullptr;  ///< needed only by programs with storage buffers
  /// rows by output slot; owned by the caller, who sets it before `launch`; only executing lanes are written
  LaneWords* outputs = nullptr;
  LaneMask launched = 0;  ///< lanes that exist (helpers included)
  LaneMask exec = 0;      ///< lanes executing now
  LaneMask killed = 0;    ///< lanes that met kKillIf
  std::uint32_t pc = 0;
  int control_depth = 0;
  struct Frame {
    /// IF: mask outside, lanes of the other side. LOOP: mask outside, lanes that continued
    LaneMask outer = 0, other = 0;
    std::uint32_t start = 0;  ///< LOOP: index of its first instruction
  };
  std::array<Frame, kMaxControlDepth> frames{};
  int texture_count = 0, access_count = 0;  ///< requests of the clause that just ended
  std::array<TextureRequest, kMaxClauseRequests> textures;
  std::array<StorageRequest, kMaxClauseRequests> accesses;
  std::vector<RegisterRow> regs;         ///< num_regs rows; kept between launches so that no launch allocates
  const DecodedProgram* code = nullptr;  ///< the form of `program` that executes
  std::uint32_t back_edges = 0;          ///< taken so far
  std::uint64_t instructions = 0;        ///< executed so far, by which a loop without an end is known

  [[nodiscard]] int requests() const { return texture_count + access_count; }

  /// Prepares a launch: lanes in `lanes` run `p` from its start. Registers are zeroed, and so are outputs
  /// that some path of the program does not write: nothing depends on what ran here before. The program must
  /// outlive the run and stay unchanged. A lane that is not launched has no defined register values. Throws
  /// what `prepare` throws.
  void launch(const Program& p, const std::uint32_t* constant_file, LaneMask lanes);
};

enum class ClauseEnd : std::uint8_t { kRequests, kProgramEnd };

struct ClauseResult {
  ClauseEnd end = ClauseEnd::kProgramEnd;
  ClauseCost cost;
};

/// Runs the warp until it must wait for the requests it made (`warp.textures[0 .. texture_count)`,
/// `warp.accesses[0 .. access_count)`) or until the program ends. The caller writes the results of textures
/// with `write_texture_result` before it calls again.
/// Throws `UserError` when a loop does not end (`kMaxBackEdges`, `kMaxLoopInstructions`).
ClauseResult run_clause(Warp& warp);
/// The same; `clock`, which was restarted for the warp's program, counts the clause's cycles.
ClauseResult run_clause(Warp& warp, WarpClock& clock);

/// Stores a filtered result into the registers the request named, for its active lanes.
void write_texture_result(Warp& warp, const TextureRequest& request, const std::array<LaneFloats, 4>& rgba);

}  // namespace quadrille::models
