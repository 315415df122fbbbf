#include "models/base/error.h"

#include <cstdio>
#include <cstdlib>

namespace quadrille {

std::string one_line(std::string text) {
  for (char& c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f) c = '?';
  }
  return text;
}

void internal_error(const char* file, int line, const char* condition, const std::string& detail) {
  std::fprintf(stderr, "quadrille: internal error at %s:%d: %s (%s)\n", file, line, detail.c_str(), condition);
  std::abort();
}

}  // namespace quadrille
