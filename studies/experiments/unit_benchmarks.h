/// A pair of frames for each kind of unit: one that the unit limits, so that arithmetic gives its cycles, and
/// one that it does not limit, so that its rate is of no account.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "studies/experiments/experiment.h"

namespace quadrille::studies::experiments {

/// What is measured of a frame.
enum class Share : std::uint8_t {
  kRender,  ///< until the last pass is flushed
  kScanOut  ///< from then on
};

/// A frame that a unit limits.
struct LimitedFrame {
  std::string_view unit;  ///< its kind, by the name of the machine plan
  std::string what, formula;
  traces::CommandStream stream;
  std::vector<std::string> settings;  ///< of the machine, KEY=VALUE
  double predicted = 0;               ///< cycles
  Share share = Share::kRender;
};

/// A frame that a unit does not limit.
struct SlackFrame {
  std::string_view unit;
  std::string what;
  traces::CommandStream stream;
  std::vector<std::string> settings;
  std::string parameter;  ///< of the unit
  double value = 0;       ///< that the parameter has; it is halved and doubled
};

/// At least one of each kind. The work grows with the frame's pixels.
[[nodiscard]] std::vector<LimitedFrame> limited_frames(std::uint32_t width, std::uint32_t height);
[[nodiscard]] std::vector<SlackFrame> slack_frames(std::uint32_t width, std::uint32_t height);

/// Draws the frames and holds them to what is said of them: a table and a verdict of each.
[[nodiscard]] Result judged(const std::vector<LimitedFrame>& limited, const std::vector<SlackFrame>& slack,
                            const Setting& setting);

}  // namespace quadrille::studies::experiments
