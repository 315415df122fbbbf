/// The JSON types of what the loader reads of a glTF file: a member of another type is refused with its
/// place, not passed over; so is a missing one.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace quadrille::scenes {

/// Checks every member that the loader knows, wherever it stands, by one walk over the document: its type,
/// and that none is missing which must be there. Members that nobody knows and `extras` may be anything.
/// Integers may be of any size here. Throws `UserError`: file, place, what is due. [glTF2.0
/// #properties-reference]
void check_types(const std::string& path, const nlohmann::json& root);

}  // namespace quadrille::scenes
