/// Which resources a shader reads: what a scene does not have to load for it.
#pragma once

#include <cstdint>
#include <set>
#include <span>

namespace quadrille::scenes {

/// Bindings of descriptor set `set` that functions of the module mention. A module that is not well formed
/// mentions none beyond its damage; it is refused later, with a reason. [SPV #physical-layout]
[[nodiscard]] std::set<std::uint32_t> mentioned_bindings(std::span<const std::uint32_t> spirv,
                                                         std::uint32_t set);

}  // namespace quadrille::scenes
