#include "models/base/error.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace quadrille {

namespace {

/// Bytes of the well-formed UTF-8 sequence at `at` that is not a control character; 0 if there is none. [RFC
/// 3629, 4]
std::size_t printable_bytes(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned first = byte(at), second = byte(at + 1);
  const auto follows = [&](std::size_t i) { return (byte(at + i) & 0xc0U) == 0x80U; };
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  if (first >= 0xc2 && first < 0xe0) return follows(1) && !(first == 0xc2 && second < 0xa0) ? 2 : 0;
  if (first >= 0xe0 && first < 0xf0) {
    const bool legal = !(first == 0xe0 && second < 0xa0) && !(first == 0xed && second >= 0xa0);
    return legal && follows(1) && follows(2) ? 3 : 0;
  }
  const bool legal = first >= 0xf0 && first < 0xf5 && !(first == 0xf0 && second < 0x90) &&
                     !(first == 0xf4 && second >= 0x90);
  return legal && follows(1) && follows(2) && follows(3) ? 4 : 0;
}

}  // namespace

std::string one_line(std::string text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t bytes = printable_bytes(text, at);
    if (bytes == 0) text[at] = '?';
    at += std::max<std::size_t>(1, bytes);
  }
  return text;
}

void internal_error(const char* file, int line, const char* condition, const std::string& detail) {
  std::fprintf(stderr, "quadrille: internal error at %s:%d: %s (%s)\n", file, line, detail.c_str(),
               condition);
  std::abort();
}

}  // namespace quadrille
