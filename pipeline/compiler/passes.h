/// Clean-up of scalar code: dead code, needless control flow, multiply-add fusion, saturation, and the order
/// that groups requests.
#pragma once

#include "pipeline/compiler/ir.h"

namespace quadrille::pipeline {

/// Removes what no output, discard or control flow needs; fuses a product with the one sum that uses it into
/// FMAD (which rounds twice, so no value changes) and a clamp to [0, 1] with the operation it clamps.
void clean_up(ScalarShader& shader);

enum class Order : std::uint8_t {
  kSource,         ///< as lowered
  kRequests,       ///< requests of a block in groups, the rest as lowered
  kRequestsDemand  ///< requests in groups, the rest when something needs it
};
/// Reorders within straight-line stretches. A group holds independent requests, at most
/// `kMaxClauseRequests`, issued back to back before the first of their results is needed. Discards and
/// control flow are not crossed.
[[nodiscard]] std::vector<ScalarInstruction> schedule(const ScalarShader& shader, Order order);

/// Whether the operation changes the flow of control (KILLIF, which only marks lanes, does not).
[[nodiscard]] bool is_control(models::Op op);
/// Whether the operation must be kept though nothing reads a result.
[[nodiscard]] bool has_effect(models::Op op);
[[nodiscard]] bool is_texture(models::Op op);
/// Whether the operation asks memory for values, so that the warp waits before it reads them: textures and
/// loads from storage buffers. Those that are independent stand together.
[[nodiscard]] bool is_request(models::Op op);

}  // namespace quadrille::pipeline
