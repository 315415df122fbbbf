/// Which name somebody meant who typed one that is none.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille {

/// Letters to insert, delete, replace or swap with their neighbour until `a` is `b`. Capitals count as their
/// small letters. [P: Damerau 1964]
[[nodiscard]] std::size_t letters_apart(std::string_view a, std::string_view b);

/// The names nearest to the typed one, if they are near: a third of the letters may be wrong. Names that
/// differ in nothing but what they leave out at a dot ("cores" for "gpu.cores") are near too. At most three,
/// in the order given.
[[nodiscard]] std::vector<std::string> near_names(std::string_view typed, std::span<const std::string> names);

/// "; did you mean 'gpu.cores'?", to go on with after what is wrong; empty when no name is near.
[[nodiscard]] std::string did_you_mean(std::string_view typed, std::span<const std::string> names);

}  // namespace quadrille
