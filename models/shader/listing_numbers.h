/// How numbers are written in a listing.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace quadrille::models {

/// The number that all of `text` spells, if any.
template <class T>
[[nodiscard]] std::optional<T> parse_integer(std::string_view text, int base = 10) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The bits of a number: 0x hexadecimal, a float if it has a point or an exponent or is inf or nan, otherwise
/// an integer.
[[nodiscard]] std::optional<std::uint32_t> parse_literal(std::string_view text);

/// A word as the shortest number that `parse_literal` reads back to the same bits: a float if it looks like
/// one, otherwise an integer.
[[nodiscard]] std::string literal_text(std::uint32_t word);

}  // namespace quadrille::models
