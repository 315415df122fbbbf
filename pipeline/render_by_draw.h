/// A frame of which more is kept by draw than its figures hold.
#pragma once

#include "pipeline/render.h"
#include "pipeline/report/counters_by_draw.h"

namespace quadrille::pipeline {

/// As `render_exact`, with the detail of draws; fills `counters` with what it asks for. That draws and the
/// rest add up to what the units counted is a law of the figures.
[[nodiscard]] RenderedFrame render_exact_by_draw(const traces::CommandStream& stream,
                                                 const MachineConfig& config, const MachineOptions& options,
                                                 const hw::RunLimits& limits, DetailOptions detail,
                                                 CountersByDraw& counters);

/// That law.
[[nodiscard]] Check check_of(const CountersByDraw& counters);

}  // namespace quadrille::pipeline
