/// What a comparison found, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "models/precision.h"
#include "tests/lavapipe/frame_compare.h"

namespace quadrille::lavapipe {

struct Report {
  std::string scene;
  std::uint32_t width = 0, height = 0;
  DeviceInfo device;
  models::Precision precision;
  Limits limits;
  Comparison result;
  FrameTimes lavapipe_times;  ///< frames == 0: not timed
  double machine_ms = 0;      ///< wall time of the colour frame on Quadrille's side
};

/// One line a criterion: figure, limit, verdict.
[[nodiscard]] std::string to_text(const Report& report);
/// The same and the histograms, as JSON.
[[nodiscard]] std::string to_json(const Report& report);

}  // namespace quadrille::lavapipe
