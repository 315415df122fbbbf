#include "models/rop/alpha_coverage.h"

namespace quadrille::models {

std::uint32_t alpha_coverage(float alpha, int count) {
  if (count == 1) return alpha > 0.5f ? 1 : 0;
  std::uint32_t kept = 0;
  for (int s = 0; s < count; ++s)
    if (alpha > static_cast<float>(s) / static_cast<float>(count)) kept |= 1u << s;
  return kept;
}

}  // namespace quadrille::models
