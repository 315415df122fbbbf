/// A frame of which more is kept than its figures hold.
#pragma once

#include "pipeline/render.h"
#include "pipeline/report/kept_counters.h"

#include <string>
#include <vector>

namespace quadrille::pipeline {

/// As `render_exact`, with what `kept` asks for filled in, where `detail` has draws or squares. That draws,
/// or squares, and the rest add up to what the units counted is a law of the figures.
[[nodiscard]] RenderedFrame render_exact_watched(const traces::CommandStream& stream,
                                                 const MachineConfig& config, const MachineOptions& options,
                                                 const hw::RunLimits& limits, const DetailOptions& detail,
                                                 KeptCounters& kept);
/// The same by SystemC's own scheduler, with waves of links and units in the file `vcd`
/// (pipeline/machine/wave_file.h). Throws `UserError` where that cannot be written.
[[nodiscard]] RenderedFrame render_exact_with_waves(const traces::CommandStream& stream,
                                                    const MachineConfig& config, MachineOptions options,
                                                    const hw::RunLimits& limits, const DetailOptions& detail,
                                                    KeptCounters& kept, const std::string& vcd);
/// Those laws.
[[nodiscard]] std::vector<Check> checks_of(const KeptCounters& kept);

}  // namespace quadrille::pipeline
