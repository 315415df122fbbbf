/// Messages on standard error.
#pragma once

#include <string>

namespace quadrille {

/// Writes to standard error. What cannot be written there (it is closed, full, or a pipe that nobody reads)
/// is lost: a message ends nothing.
void say(const std::string& text) noexcept;

}  // namespace quadrille
