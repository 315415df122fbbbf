#include "models/base/say.h"

#include <cstdio>

namespace quadrille {

void say(const std::string& text) noexcept {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
  std::clearerr(stderr);
}

}  // namespace quadrille
