/// How the program fails: a user's mistake is a `UserError` (one clear line, exit code 2); our own bug is a
/// `QUADRILLE_CHECK` that aborts with its place.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace quadrille {

/// A mistake in what the user gave: a scene, trace, machine file, shader or flag. `what()` is one line: file,
/// place, what is wrong, legal values.
class UserError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The text with every control character, and every byte that is not UTF-8, replaced by '?': what a message
/// quotes from a file cannot add lines to it or command a terminal.
[[nodiscard]] std::string one_line(std::string text);

/// Builds a `UserError` of one line from a format string.
template <class... Args>
[[nodiscard]] UserError user_error(fmt::format_string<Args...> text, Args&&... args) {
  return UserError(one_line(fmt::format(text, std::forward<Args>(args)...)));
}

/// Reports a broken invariant of this program and aborts. `place` names the unit or function, `detail` what
/// was seen.
[[noreturn]] void internal_error(const char* file, int line, const char* condition,
                                 const std::string& detail);

}  // namespace quadrille

/// An invariant that holds in release builds too. The detail is a format string with its arguments, evaluated
/// only on failure.
#define QUADRILLE_CHECK(condition, ...)                                                        \
  do {                                                                                         \
    if (!(condition)) [[unlikely]]                                                             \
      ::quadrille::internal_error(__FILE__, __LINE__, #condition, ::fmt::format(__VA_ARGS__)); \
  } while (false)
