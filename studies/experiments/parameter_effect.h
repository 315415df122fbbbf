/// What more of each parameter does, as it is declared.
#pragma once

#include <cstdint>
#include <string_view>

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

}  // namespace quadrille::studies::experiments
