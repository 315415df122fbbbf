/// Which draws have something in which part of the screen: what the figures do not tell, for the page of a
/// frame.
///
/// The machine is not asked for it. The frame is drawn once more without time, and every primitive that is
/// rasterised then notes its draw in the squares of its samples, before any test.
#pragma once

#include "models/precision.h"
#include "traces/command_stream.h"

#include <cstdint>
#include <vector>

namespace quadrille::pipeline {

/// By square of the screen, row by row from the top left as in `TileFigures`: numbers of the draws of the
/// shown pass that cover a sample there, in API order.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> draws_by_square(const traces::CommandStream& stream,
                                                                      const models::Precision& precision);

}  // namespace quadrille::pipeline
