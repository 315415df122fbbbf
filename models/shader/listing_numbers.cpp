/// Numbers of a listing, both ways.
#include "models/shader/listing_numbers.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace quadrille::models {

std::optional<std::uint32_t> parse_literal(std::string_view text) {
  if (text.starts_with("0x")) return parse_integer<std::uint32_t>(text.substr(2), 16);
  if (text.find_first_of(".einf") != std::string_view::npos) {
    float value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return std::bit_cast<std::uint32_t>(value);
  }
  const std::optional<std::int64_t> value = parse_integer<std::int64_t>(text);
  if (!value || *value < std::numeric_limits<std::int32_t>::min() ||
      *value > std::numeric_limits<std::uint32_t>::max())
    return std::nullopt;
  return static_cast<std::uint32_t>(*value);
}

std::string literal_text(std::uint32_t word) {
  const float value = std::bit_cast<float>(word);
  const float magnitude = std::fabs(value);
  if (magnitude >= 1e-6f && magnitude <= 1e9f) {
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
  }
  const auto integer = static_cast<std::int32_t>(word);
  return std::abs(static_cast<std::int64_t>(integer)) <= 65536 ? fmt::format("{}", integer)
                                                               : fmt::format("{:#010x}", word);
}

}  // namespace quadrille::models
