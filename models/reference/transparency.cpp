#include "models/reference/transparency.h"

#include <algorithm>
#include <cmath>

#include "models/reference/output.h"

namespace quadrille::models::reference {
namespace {

/// What the format can hold of a value, before it is rounded. NaN: 0.
double held(const FormatInfo& format, double value) {
  if (format.numeric != Numeric::kUnorm && format.numeric != Numeric::kSrgb) return value;
  return value > 0 ? std::min(value, 1.0) : 0.0;
}

}  // namespace

void keep_fragment(const traces::BlendState& state, traces::Format format, double depth,
                   const std::array<double, 4>& source, KeptFragments& fragments) {
  const FormatInfo& info = format_info(format);
  KeptFragment fragment{depth, {}};
  for (std::size_t c = 0; c < 4; ++c) fragment.color[c] = held(info, source[c]);
  const bool straight = state.src_color == traces::BlendFactor::kSrcAlpha;
  for (std::size_t c = 0; c < 3 && straight; ++c) fragment.color[c] *= fragment.color[3];
  fragments.push_back(fragment);
}

void put_over(std::vector<KeptFragments>& kept, ColorTarget& target) {
  for (std::size_t at = 0; at < kept.size(); ++at) {
    if (kept[at].empty()) continue;
    std::ranges::stable_sort(kept[at], std::ranges::greater{}, &KeptFragment::depth);
    std::array<double, 4> color = load_color(target.format, target.code[at]);
    for (const KeptFragment& fragment : kept[at])
      for (std::size_t c = 0; c < 4; ++c) color[c] = fragment.color[c] + (1 - fragment.color[3]) * color[c];
    for (double& value : color) value = held(format_info(target.format), value);
    const StoredColor stored = store_color(target.format, color);
    target.code[at] = stored.code;
    std::ranges::copy(stored.linear, target.linear.begin() + static_cast<std::ptrdiff_t>(4 * at));
    kept[at].clear();
  }
}

}  // namespace quadrille::models::reference
