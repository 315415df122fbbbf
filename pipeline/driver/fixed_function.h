/// The fixed-function state of a draw, from its pipeline and what was set before it.
#pragma once

#include "hw/frame/frame.h"
#include "traces/command_stream.h"

#include <span>

namespace quadrille::pipeline {

struct FixedFunctionInputs {
  const traces::Pipeline& pipeline;
  const hw::PassState& pass;
  models::Format depth;                         ///< of the pass's depth attachment; kUndefined: it has none
  std::span<const models::Viewport> viewports;  ///< those that are set, and scissors alike
  std::span<const models::PixelRect> scissors;
  int subpixel_bits = 8;
};
/// Sets what a draw does outside of its programs, which it must have already. Throws `UserError` for a
/// program that the pipeline cannot run.
void set_fixed_function(const FixedFunctionInputs& inputs, hw::DrawState& draw);

}  // namespace quadrille::pipeline
