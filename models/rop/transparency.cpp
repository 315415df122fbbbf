#include "models/rop/transparency.h"

#include "models/rop/quad_codec.h"

#include <algorithm>

namespace quadrille::models {
namespace {

constexpr float kMostDepth = 16777215.0f;

bool holds_unit_range(const FormatInfo& format) {
  return format.numeric == Numeric::kUnorm || format.numeric == Numeric::kSrgb;
}

/// Red, green, blue, alpha.
__m128 color_of(const TransparencyNode& node) {
  return _mm_cvtph_ps(_mm_set_epi32(0, 0, static_cast<int>(node.color[1]), static_cast<int>(node.color[0])));
}

__m128 over(__m128 near, __m128 far) {
  const __m128 alpha = _mm_shuffle_ps(near, near, 0xff);
  return _mm_add_ps(near, _mm_mul_ps(_mm_sub_ps(_mm_set1_ps(1.0f), alpha), far));
}

void set_color(TransparencyNode& node, __m128 color) {
  const __m128i halves = _mm_cvtps_ph(color, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  node.color[0] = static_cast<std::uint32_t>(_mm_cvtsi128_si32(halves));
  node.color[1] = static_cast<std::uint32_t>(_mm_extract_epi32(halves, 1));
}

}  // namespace

std::array<TransparencyNode, 4> make_nodes(const BlendState& state, Format format, const float rgba[4][4],
                                           const float depth[4], const std::array<std::uint8_t, 4>& samples) {
  const bool clamps = holds_unit_range(format_info(format)),
             straight = state.src_color == BlendFactor::kSrcAlpha;
  QuadColor color;
  for (std::size_t c = 0; c < 4; ++c) {
    color[c] = _mm_loadu_ps(rgba[c]);
    if (clamps) color[c] = saturate(color[c]);
  }
  for (std::size_t c = 0; c < 3 && straight; ++c) color[c] = _mm_mul_ps(color[c], color[3]);
  const __m128 scaled = _mm_mul_ps(saturate(_mm_loadu_ps(depth)), _mm_set1_ps(kMostDepth));
  alignas(16) std::uint32_t code[4][4];
  for (std::size_t c = 0; c < 4; ++c) _mm_store_si128(reinterpret_cast<__m128i*>(code[c]), to_half(color[c]));
  alignas(16) std::uint32_t depths[4];
  _mm_store_si128(reinterpret_cast<__m128i*>(depths), _mm_cvtps_epi32(scaled));
  std::array<TransparencyNode, 4> nodes;
  for (std::size_t i = 0; i < 4; ++i) {
    nodes[i].color = {code[0][i] | code[1][i] << 16, code[2][i] | code[3][i] << 16};
    nodes[i].depth_samples = depths[i] | std::uint32_t{samples[i]} << 24;
  }
  return nodes;
}

bool insert_node(const TransparencyNode& node, std::span<TransparencyNode> entries) {
  TransparencyNode pushed = node;  // the farthest so far of what has no entry yet
  for (TransparencyNode& entry : entries) {
    if (!entry.exists()) {
      entry = pushed;
      return false;
    }
    if (pushed.depth() <= entry.depth()) std::swap(pushed, entry);
  }
  TransparencyNode& last = entries.back();
  set_color(last, over(color_of(last), color_of(pushed)));
  return true;
}

void sort_nodes(std::span<TransparencyNode> nodes) {
  std::ranges::stable_sort(nodes, {}, &TransparencyNode::depth);
}

void compose_quad(Format format, const std::array<std::span<const TransparencyNode>, 4>& nodes,
                  std::uint32_t sample, std::byte* pixels) {
  const FormatInfo& info = format_info(format);
  const QuadWords old = load_quad(pixels, info.bytes);
  QuadColor color = decode_quad(info, old);
  alignas(16) std::uint32_t touched[4] = {};
  _MM_TRANSPOSE4_PS(color[0], color[1], color[2], color[3]);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t n = nodes[i].size(); n-- > 0;) {
      if (!nodes[i][n].covers(sample)) continue;
      color[i] = over(color_of(nodes[i][n]), color[i]);
      touched[i] = ~0u;
    }
  }
  _MM_TRANSPOSE4_PS(color[0], color[1], color[2], color[3]);
  if (holds_unit_range(info))
    for (__m128& component : color.component) component = saturate(component);
  QuadWords out = encode_quad(info, color);
  const __m128i lanes = _mm_load_si128(reinterpret_cast<const __m128i*>(touched));
  for (std::size_t w = 0; w < 4; ++w) out.word[w] = _mm_blendv_epi8(old.word[w], out.word[w], lanes);
  store_quad(pixels, info.bytes, out);
}

}  // namespace quadrille::models
