/// What more of each parameter does, as it is declared.
#pragma once

#include "pipeline/machine_config.h"

#include <string>
#include <string_view>
#include <vector>

namespace quadrille::studies::experiments {

enum class Effect : std::uint8_t {
  kFaster,    ///< more of it is never slower
  kSlower,    ///< more of it is never faster
  kTradeOff,  ///< either, by the frame
  kPicture,   ///< another picture, and thereby another frame
  kNeutral    ///< bounds what the default machines do not reach
};
[[nodiscard]] Effect effect_of(std::string_view path);
[[nodiscard]] std::string_view effect_name(Effect effect);

/// Is the machine with `settings` and `change` refused?
[[nodiscard]] bool refused(const std::vector<std::string>& settings, const std::string& change);

}  // namespace quadrille::studies::experiments
