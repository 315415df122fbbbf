/// Pieces of state that both pipelines and commands hold.
#pragma once

#include "traces/capture/raster_state.h"

namespace quadrille::capture {

[[nodiscard]] traces::VertexBinding binding_of(const Value& description);
/// Adds it to the pipeline, and to what has to be expanded if its format is not one that is fetched.
void add_attribute(RasterState& state, const Value& description);
[[nodiscard]] traces::FrontFace front_of(std::uint32_t value);
/// Factors and operations of a blend, whose members have the same names everywhere.
void take_equation(traces::BlendState& blend, const Value& from);
/// `count` of them, from `first` on; of null only their number is known.
void set_viewports(RasterState& state, const Value& from, std::uint32_t first, std::uint32_t count);
void set_scissors(RasterState& state, const Value& from, std::uint32_t first, std::uint32_t count);

}  // namespace quadrille::capture
