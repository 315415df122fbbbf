/// The two colours between which the texels of a partition of ASTC lie. [KDF #ASTC, LDR endpoint decoding]
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace quadrille::models {

using AstcColor = std::array<int, 4>;  ///< red, green, blue, alpha: 0..255
struct AstcEnds {
  AstcColor first{}, second{};
};
/// What a block that is not legal decodes to.
inline constexpr AstcColor kAstcErrorColor{255, 0, 255, 255};

/// `v`: 0..255, as many as the mode (0..15) takes. Ends of a mode of high range are the error colour.
[[nodiscard]] AstcEnds astc_ends(int mode, std::span<const int> v);

}  // namespace quadrille::models
