/// A field of a table of comma-separated values [RFC 4180].
#pragma once

#include <string>

namespace quadrille::pipeline {

/// In quotes where it holds what would end it.
[[nodiscard]] inline std::string csv_field(const std::string& text) {
  if (text.find_first_of("\",\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

}  // namespace quadrille::pipeline
