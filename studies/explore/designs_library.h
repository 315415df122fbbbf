/// The module of designs, loaded in a process that ends when it has answered: neither its libraries nor their
/// threads stay in the program.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "studies/explore/design_module.h"

namespace quadrille::studies::explore {

/// The address of a function of the module. Throws `UserError` when the module is not found, or lacks it.
[[nodiscard]] void* address_in_designs_library(const char* name);

/// A function of the module. In the process of `in_designs_library`.
template <class Function>
[[nodiscard]] Function* of_designs_library(const char* name) {
  return reinterpret_cast<Function*>(address_in_designs_library(name));
}

/// What `ask` returns, from a process of its own. When it sets the message, that is thrown as `UserError`
/// that begins with `about`.
[[nodiscard]] std::vector<double> in_designs_library(
    const std::string& about, const std::function<std::vector<double>(QuadrilleMessage*)>& ask);

}  // namespace quadrille::studies::explore
