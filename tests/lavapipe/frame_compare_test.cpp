/// The comparison must see each kind of difference, and excuse only what it may.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <limits>

#include "tests/lavapipe/alpha_ties.h"
#include "tests/lavapipe/frame_compare.h"

namespace quadrille::lavapipe {
namespace {

constexpr std::uint32_t kSide = 128;

/// A frame whose left half shows triangle 1 in grey at depth 0.5, the rest background.
FramePair half_covered() {
  Rendered color{kSide, kSide, std::vector<std::uint32_t>(kSide * kSide, 0xff000000u), {}};
  Rendered triangles{kSide, kSide, std::vector<std::uint32_t>(kSide * kSide, 0),
                     std::vector<float>(kSide * kSide, 1.0f)};
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide / 2; ++x) {
      color.color[y * kSide + x] = 0xff808080u;
      triangles.color[y * kSide + x] = 1;
      triangles.depth[y * kSide + x] = 0.5f;
    }
  return {color, triangles};
}

constexpr Limits kLimits{};

}  // namespace

TEST_CASE("frame_compare: a frame agrees with itself") {
  const FramePair frame = half_covered();
  const Comparison result = compare_frames(frame, frame, {}, kLimits);
  CHECK(result.passed());
  CHECK(result.depth_ties == 0);
  CHECK(result.color.max_lsb == 0);
}

TEST_CASE("frame_compare: one pixel of coverage in 16384 is too many") {
  const FramePair ours = half_covered();
  FramePair theirs = ours;
  theirs.triangles.color[kSide / 2] = 1;
  const Comparison result = compare_frames(ours, theirs, {}, kLimits);
  CHECK_FALSE(result.coverage_ok);
  CHECK(result.triangles_ok);
  CHECK(result.shape.only_b == 1);
}

TEST_CASE("frame_compare: another triangle is excused only within two units in the last place of depth") {
  const FramePair ours = half_covered();
  for (const int ulps : {0, 2, 3}) {
    FramePair theirs = ours;
    float depth = 0.5f;
    for (int i = 0; i < ulps; ++i) depth = std::nextafter(depth, 1.0f);
    for (const std::size_t pixel : {5u, 6u}) {
      theirs.triangles.color[pixel] = 7;
      theirs.triangles.depth[pixel] = depth;
      theirs.color.color[pixel] = 0xff0000ffu;
    }
    const Comparison result = compare_frames(ours, theirs, {}, kLimits);
    CHECK(result.depth_ties == (ulps <= 2 ? 2 : 0));
    CHECK(result.triangles_ok == (ulps <= 2));
    CHECK(result.color.max_lsb == (ulps <= 2 ? 0 : 0x80));
  }
}

TEST_CASE("frame_compare: coverage is excused only by an alpha at its cut-off, at that very pixel") {
  const FramePair ours = half_covered();
  FramePair theirs = ours;
  theirs.triangles.color[9] = 0;
  std::vector<std::uint8_t> ties(kSide * kSide, 0);
  CHECK_FALSE(compare_frames(ours, theirs, {}, kLimits).coverage_ok);
  ties[10] = 1;
  CHECK_FALSE(compare_frames(ours, theirs, ties, kLimits).coverage_ok);
  ties[9] = 1;
  const Comparison result = compare_frames(ours, theirs, ties, kLimits);
  CHECK(result.coverage_ok);
  CHECK(result.alpha_ties == 1);
}

TEST_CASE("alpha_ties: marks the pixels whose alpha is within 1/255 of the cut-off, and no others") {
  // The fake renderer covers pixel i if alpha i / 1020 reaches the cut-off, which the stream holds where
  // scenes put it.
  constexpr float kCutoff = 0.5f;
  traces::CommandStream stream;
  stream.buffers.push_back({"material", std::vector<std::byte>(64)});
  std::memcpy(stream.buffers[0].data.data() + 28 + 32, &kCutoff, sizeof kCutoff);
  stream.descriptor_sets.push_back({{{0, 0, 32, 32}}, {}});
  stream.commands = {traces::BindDescriptorSet{1, 0}, traces::BindDescriptorSet{0, 0},
                     traces::BindDescriptorSet{1, 0}};
  const auto render = [](const traces::CommandStream& s) {
    float cutoff = 0;
    std::memcpy(&cutoff, s.buffers[0].data.data() + 32 + 28, sizeof cutoff);
    Rendered image{1020, 1, std::vector<std::uint32_t>(1020, 0), {}};
    for (std::uint32_t i = 0; i < 1020; ++i)
      image.color[i] = static_cast<float>(i) / 1020.0f >= cutoff ? 1 : 0;
    return image;
  };
  const std::vector<std::uint8_t> ties = alpha_ties(stream, render(stream), render);
  for (std::uint32_t i = 0; i < 1020; ++i) {
    const float distance = std::abs(static_cast<float>(i) / 1020.0f - kCutoff);
    if (distance < 0.99f / 255) CHECK(ties[i] == 1);
    if (distance > 1.01f / 255) CHECK(ties[i] == 0);
  }
}

TEST_CASE("frame_compare: seventeen wrong colours in one block fail the block, sixteen do not") {
  const FramePair ours = half_covered();
  for (const std::uint32_t count : {16u, 17u}) {
    FramePair theirs = ours;
    for (std::uint32_t i = 0; i < count; ++i) theirs.color.color[(i / 8) * kSide + i % 8] += 9;
    const Comparison result = compare_frames(ours, theirs, {}, kLimits);
    CHECK(result.blocks_ok == (count == 16));
    CHECK(result.color.bad_blocks == (count == 16 ? 0 : 1));
  }
}

TEST_CASE("frame_compare: a shift of three in one pixel of a thousand is too much, of two is not") {
  const FramePair ours = half_covered();
  for (const std::uint32_t shift : {2u, 3u}) {
    FramePair theirs = ours;
    for (std::size_t i = 0; i < theirs.color.color.size(); i += 900) theirs.color.color[i] += shift << 8;
    CHECK(compare_frames(ours, theirs, {}, kLimits).color_ok == (shift == 2));
  }
}

TEST_CASE("frame_compare: ulps_apart counts representable floats across zero") {
  CHECK(ulps_apart(1.0f, 1.0f) == 0);
  CHECK(ulps_apart(0.0f, -0.0f) == 0);
  CHECK(ulps_apart(1.0f, std::nextafter(1.0f, 2.0f)) == 1);
  CHECK(ulps_apart(std::numeric_limits<float>::denorm_min(), -std::numeric_limits<float>::denorm_min()) == 2);
  CHECK(ulps_apart(std::nanf(""), 0.0f) > 1000);
}

}  // namespace quadrille::lavapipe
