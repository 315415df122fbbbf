/// Nodes of order-independent draws: what one holds, how layers take them, and what they come to.
#include "models/rop/transparency.h"

#include "models/rop/blend.h"
#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

using namespace quadrille::models;

namespace {

constexpr BlendState over(BlendFactor source) {
  return {true,
          source,
          BlendFactor::kOneMinusSrcAlpha,
          BlendFactor::kOne,
          BlendFactor::kOneMinusSrcAlpha,
          BlendOp::kAdd,
          BlendOp::kAdd,
          0xf};
}

TransparencyNode node(const std::array<float, 4>& color, float depth,
                      BlendFactor source = BlendFactor::kSrcAlpha, std::uint8_t samples = 1) {
  float rgba[4][4], depths[4];
  for (std::size_t i = 0; i < 4; ++i) {
    depths[i] = depth;
    for (std::size_t c = 0; c < 4; ++c) rgba[c][i] = color[c];
  }
  return make_nodes(over(source), Format::kR32G32B32A32Float, rgba, depths,
                    {samples, samples, samples, samples})[0];
}

/// Of pixels that hold `under`.
std::array<float, 4> composed(std::vector<TransparencyNode> nodes, const std::array<float, 4>& under,
                              std::uint32_t sample = 0) {
  constexpr Format kFormat = Format::kR16G16B16A16Float;
  std::array<std::byte, 32> pixels{};
  const PixelCode code = encode_color(kFormat, under);
  for (std::size_t i = 0; i < 4; ++i) std::memcpy(pixels.data() + 8 * i, code.word.data(), 8);
  const std::span<const TransparencyNode> all = nodes;
  compose_quad(kFormat, {all, {}, all, {}}, sample, pixels.data());
  PixelCode first, second;
  std::memcpy(first.word.data(), pixels.data(), 8);
  std::memcpy(second.word.data(), pixels.data() + 8, 8);
  CHECK(second == code);  // pixels without nodes keep their bits
  return decode_color(kFormat, first);
}

std::vector<TransparencyNode> random_nodes(RandomSource& random, int count) {
  std::vector<TransparencyNode> nodes;
  nodes.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    nodes.push_back(node({random.real(0, 1), random.real(0, 1), random.real(0, 1), random.real(0, 1)},
                         static_cast<float>(i + 1) / 64));
  return nodes;
}

}  // namespace

TEST_CASE("transparency: blending over is known by its factors, and nothing else is") {
  CHECK(is_over(over(BlendFactor::kSrcAlpha)));
  CHECK(is_over(over(BlendFactor::kOne)));
  CHECK_FALSE(is_over(over(BlendFactor::kSrc1Alpha)));
  CHECK_FALSE(is_over({}));
  BlendState state = over(BlendFactor::kOne);
  state.write_mask = 7;
  CHECK_FALSE(is_over(state));
  state = over(BlendFactor::kOne);
  state.color = BlendOp::kMax;
  CHECK_FALSE(is_over(state));
}

TEST_CASE("transparency: depths of nodes are within 0..1, and NaN is 0") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(node({}, -2).depth() == 0);
  CHECK(node({}, nan).depth() == 0);
  CHECK(node({}, 0.5f).depth() == 0x800000u);
  CHECK(node({}, 3).depth() == 0xffffffu);
  CHECK_FALSE(TransparencyNode{}.exists());
  CHECK(node({}, 0).exists());
}

TEST_CASE("transparency: two of one colour over black are the closed form, straight or premultiplied") {
  const float a = 0.25f;
  const TransparencyNode straight = node({0.5f, 1, 0, a}, 0.5f),
                         made = node({0.5f * a, a, 0, a}, 0.5f, BlendFactor::kOne);
  CHECK(straight == made);
  const std::array<float, 4> color = composed({straight, straight}, {0, 0, 0, 0});
  const float both = 1 - (1 - a) * (1 - a);
  CHECK(color[0] == Approx(0.5f * both).epsilon(1e-3));
  CHECK(color[1] == Approx(both).epsilon(1e-3));
  CHECK(color[2] == 0);
  CHECK(color[3] == Approx(both).epsilon(1e-3));
}

TEST_CASE("transparency: sorted nodes are the same in whatever order they came") {
  RandomSource random(3);
  std::vector<TransparencyNode> nodes = random_nodes(random, 9), wanted = nodes;
  for (int i = 0; i < 50; ++i) {
    std::swap(nodes[static_cast<std::size_t>(random.integer(0, 8))],
              nodes[static_cast<std::size_t>(random.integer(0, 8))]);
    std::vector<TransparencyNode> sorted = nodes;
    sort_nodes(sorted);
    CHECK(sorted == wanted);
  }
}

TEST_CASE("transparency: of equal depths the one that was drawn later is nearer, in lists and layers") {
  const TransparencyNode first = node({1, 0, 0, 0.5f}, 0.5f), second = node({0, 1, 0, 0.5f}, 0.5f);
  std::vector<TransparencyNode> list{second, first};  // a list begins with the newest
  sort_nodes(list);
  CHECK(list[0] == second);
  std::array<TransparencyNode, 3> layers{};
  CHECK_FALSE(insert_node(first, layers));
  CHECK_FALSE(insert_node(second, layers));
  CHECK(layers[0] == second);
  CHECK(layers[1] == first);
  CHECK_FALSE(layers[2].exists());
}

TEST_CASE("transparency: as many layers as nodes keep them all, sorted") {
  RandomSource random(5);
  std::vector<TransparencyNode> nodes = random_nodes(random, 8), wanted = nodes;
  for (std::size_t i = nodes.size(); i-- > 1;)
    std::swap(nodes[i], nodes[static_cast<std::size_t>(random.integer(0, static_cast<int>(i)))]);
  std::array<TransparencyNode, 8> layers{};
  for (const TransparencyNode& one : nodes) CHECK_FALSE(insert_node(one, layers));
  CHECK(std::ranges::equal(layers, wanted));
}

TEST_CASE(
    "transparency: when layers are full the two farthest become one, and nothing is lost from back to "
    "front") {
  RandomSource random(7);
  std::vector<TransparencyNode> nodes = random_nodes(random, 6);
  const std::array<float, 4> wanted = composed(nodes, {0.3f, 0.6f, 0.9f, 1});
  for (const std::size_t k : {std::size_t{1}, std::size_t{2}, std::size_t{4}}) {
    std::vector<TransparencyNode> layers(k);
    int merged = 0;
    for (std::size_t i = nodes.size(); i-- > 0;) merged += insert_node(nodes[i], layers) ? 1 : 0;
    CHECK(merged == static_cast<int>(nodes.size() - k));
    const std::array<float, 4> color = composed(layers, {0.3f, 0.6f, 0.9f, 1});
    for (std::size_t c = 0; c < 4; ++c) CHECK(color[c] == Approx(wanted[c]).margin(2e-3));
  }
}

TEST_CASE("transparency: a node is put over those samples that it covers") {
  const std::vector<TransparencyNode> nodes{node({1, 1, 1, 1}, 0.5f, BlendFactor::kOne, 0b0101)};
  CHECK(composed(nodes, {0, 0, 0, 0}, 0)[0] == 1);
  CHECK(composed(nodes, {0, 0, 0, 0}, 1)[0] == 0);
  CHECK(composed(nodes, {0, 0, 0, 0}, 2)[0] == 1);
}
