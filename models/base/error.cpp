#include "models/base/error.h"

#include <cstdio>
#include <cstdlib>

namespace quadrille {

void internal_error(const char* file, int line, const char* condition, const std::string& detail) {
  std::fprintf(stderr, "quadrille: internal error at %s:%d: %s (%s)\n", file, line, detail.c_str(), condition);
  std::abort();
}

}  // namespace quadrille
