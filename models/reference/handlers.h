/// The operations that the interpreter can execute, found by SPIR-V opcode. Internal to the reference.
///
/// Arithmetic handlers share one calling rule: `n` is the cell count of the first operand (of the result for
/// OpSelect), a scalar operand beside vectors has step 0, `imm[0]` is the cell count of the result and
/// `imm[1]` the rows of a matrix first operand (else n).
#pragma once

#include <cstdint>

#include "models/reference/shader_program.h"

namespace quadrille::models::reference {

/// Handler of a core opcode, or null. Each file knows its own family.
[[nodiscard]] Handler float_handler(std::uint32_t op);
[[nodiscard]] Handler vector_handler(std::uint32_t op);  ///< products, matrices, derivatives
[[nodiscard]] Handler integer_handler(std::uint32_t op);
/// OpBitcast between 32-bit scalars or vectors of equal length. A float's bits are those of the nearest
/// float32.
[[nodiscard]] Handler bitcast_handler(bool float_source, bool float_result);
/// Handler of a GLSL.std.450 instruction, or null.
[[nodiscard]] Handler glsl_float_handler(std::uint32_t instruction);
[[nodiscard]] Handler glsl_vector_handler(std::uint32_t instruction);
[[nodiscard]] Handler glsl_integer_handler(std::uint32_t instruction);
/// GLSL.std.450 Modf and Frexp with both results, the first in `dst` and the second in the n cells after it.
[[nodiscard]] Handler glsl_two_result_handler(std::uint32_t instruction);

// Memory: dst and src[0] are first cells, src[1] (or src[0] for scatter_cells' address) a cell of offsets.
void copy_cells(const Operation& o, Lanes& lanes);
void gather_cells(const Operation& o, Lanes& lanes);   ///< dst[i] = at(src[0] + offset)[i], offset in src[1]
void scatter_cells(const Operation& o, Lanes& lanes);  ///< at(dst + offset)[i] = src[0][i], offset in src[1]
void scale_index(const Operation& o,
                 /// dst = min(src[0], imm[0] - 1) * imm[1] + src[1] (if any); a negative index counts as 0
                 Lanes& lanes);
void extract_dynamic(const Operation& o, Lanes& lanes);
void insert_dynamic(const Operation& o, Lanes& lanes);
void kill_lanes(const Operation& o, Lanes& lanes);   ///< marks the running lanes as discarded
void note_margin(const Operation& o, Lanes& lanes);  ///< lowers the discard margin to |src[0] - src[1]|

// Textures: imm[0] is the instruction of the program's list, or of queries the texture, and src[0] the cell
// with what is added to it.
void ask_texture_lanes(const Operation& o, Lanes& lanes);
void query_size(const Operation& o, Lanes& lanes);  ///< src[1]: the level, if it has any
void query_levels(const Operation& o, Lanes& lanes);
void query_samples(const Operation& o, Lanes& lanes);

/// Stores a cell for the running lanes.
inline void write(Lanes& lanes, Cell& dst, const Cell& value) {
  if (lanes.mask == kAllLanes) {
    dst = value;
    return;
  }
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if ((lanes.mask >> lane & 1u) != 0) dst.bits[lane] = value.bits[lane];
  }
}

/// dst[i] = formula(i, lane), a double, for n components, in the running lanes.
template <class Formula>
void vector_result(const Operation& o, Lanes& lanes, std::uint32_t n, const Formula& formula) {
  for (std::uint32_t i = 0; i < n; ++i) {
    Cell r;
    for (int lane = 0; lane < kLanes; ++lane) r.set_f(lane, formula(i, lane));
    write(lanes, lanes.cells[o.dst + i], r);
  }
}

}  // namespace quadrille::models::reference
