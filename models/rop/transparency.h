/// Order-independent transparency: what a fragment leaves, and how all that a pixel was left are put over
/// its colour, whatever order they came in. [P: Carpenter 1984] [P: Bavoil et al. 2007] [P: Yang et al. 2010]
///
/// A *node* is a fragment's colour, multiplied by its alpha, its depth, and the samples that it covers.
/// Nodes are sorted by depth; of equal depths the one that was drawn later is nearer. Then they are put over
/// what the attachment holds, from the farthest to the nearest, and the result is rounded once.
///
/// An A-buffer keeps all nodes of a pixel. A k-buffer keeps at most k of each sample, sorted: when one more
/// comes, the two farthest become one. So what it shows follows from the pixel's nodes in the order of
/// drawing, and from nothing else.
#pragma once

#include "models/base/format.h"
#include "models/base/pipeline_state.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace quadrille::models {

/// As memory holds it. One of zeros is none.
struct TransparencyNode {
  std::array<std::uint32_t, 2> color{};  ///< halves: red, green, blue and alpha, multiplied by alpha
  /// depth in 24 bits, 0..1, and in the high 8 the samples that it covers
  std::uint32_t depth_samples = 0;
  std::uint32_t next = 0;  ///< of a list: number of the next node, from 1; 0: the last
  [[nodiscard]] std::uint32_t depth() const { return depth_samples & 0xffffffu; }
  [[nodiscard]] bool covers(std::uint32_t sample) const { return (depth_samples >> (24 + sample) & 1u) != 0; }
  [[nodiscard]] bool exists() const { return depth_samples >> 24 != 0; }
  friend bool operator==(const TransparencyNode&, const TransparencyNode&) = default;
};
inline constexpr std::uint32_t kNodeBytes = 16;
static_assert(sizeof(TransparencyNode) == kNodeBytes);

/// What a pixel's list begins with, as memory holds it.
struct ListHead {
  std::uint32_t first = 0;  ///< number of the newest node, from 1; 0: there is none
  std::uint32_t count = 0;
};
inline constexpr std::uint32_t kListHeadBytes = 8;
static_assert(sizeof(ListHead) == kListHeadBytes);

/// Nodes of four pixels of an attachment of that format, which cover `samples` (by pixel). `state` is one of
/// `is_over`; `rgba[c][i]` is component c of pixel i as the shader wrote it. Depths outside 0..1 are clamped;
/// NaN is 0.
[[nodiscard]] std::array<TransparencyNode, 4> make_nodes(const BlendState& state, Format format,
                                                         const float rgba[4][4], const float depth[4],
                                                         const std::array<std::uint8_t, 4>& samples);

/// Puts a node among the entries of a sample, nearest first. True when all were taken: then the two farthest
/// of them and the node have become one.
[[nodiscard]] bool insert_node(const TransparencyNode& node, std::span<TransparencyNode> entries);

/// Sorts the nodes of a list, which begins with the newest: nearest first.
void sort_nodes(std::span<TransparencyNode> nodes);

/// Puts those nodes of four pixels that cover `sample` over the pixels' colours; nodes nearest first.
void compose_quad(Format format, const std::array<std::span<const TransparencyNode>, 4>& nodes,
                  std::uint32_t sample, std::byte* pixels);

}  // namespace quadrille::models
