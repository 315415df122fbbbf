/// Which program this is: its version, and which build of it.
#pragma once

#include <string>

namespace quadrille::studies::explore {

/// "quadrille 0.1.0 build 0123456789abcdef": the digits are a hash of the program's file.
[[nodiscard]] std::string program_version(const std::string& release);

}  // namespace quadrille::studies::explore
