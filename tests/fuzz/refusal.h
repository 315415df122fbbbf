/// The contract of every input: done, or refused by a `UserError` (or for want of memory) in one line that
/// names the input.
#pragma once

#include <new>
#include <string_view>

#include "models/base/error.h"

namespace quadrille::fuzz {

/// Does the work; returns whether it was done. Aborts when the refusal has more than one line or does not say
/// `name`. Anything else thrown ends the process.
template <class Work>
bool done_or_refused(std::string_view name, const Work& work) {
  try {
    work();
    return true;
  } catch (const UserError& error) {
    const std::string_view text = error.what();
    QUADRILLE_CHECK(text.find('\n') == std::string_view::npos && text.find(name) != std::string_view::npos,
                    "refused with '{}', input {}", text, name);
  } catch (const std::bad_alloc&) {  // the program says "out of memory" and ends with exit code 2
  }
  return false;
}

}  // namespace quadrille::fuzz
