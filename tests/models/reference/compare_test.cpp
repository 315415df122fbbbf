/// The image metrics on images whose difference is known.
#include "models/reference/compare.h"

#include "models/base/error.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace quadrille;
using namespace quadrille::models::reference;

namespace {

struct Picture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint32_t> rgba;
  Picture(std::uint32_t w, std::uint32_t h, std::uint32_t value)
      : width(w), height(h), rgba(std::size_t{w} * h, value) {}
  [[nodiscard]] ImageView view() const { return {width, height, rgba}; }
};

}  // namespace

TEST_CASE("compare: equal images have no difference and infinite PSNR") {
  const Picture a(20, 10, 0xff102030u);
  const ImageDifference d = compare_images(a.view(), a.view());
  CHECK(d.pixels == 200);
  CHECK(d.max_lsb == 0);
  CHECK(d.histogram[0][0] == 200);
  CHECK(d.fraction_within(0) == 1);
  CHECK(std::isinf(d.psnr_db));
  CHECK(d.blocks == 6);
  CHECK(d.bad_blocks == 0);
}

TEST_CASE("compare: the histogram counts each channel, the fraction the worst of them") {
  const Picture a(16, 16, 0xff808080u);
  Picture b = a;
  b.rgba[0] = 0xff808083u;  // red 3
  b.rgba[1] = 0xff7b8080u;  // blue 5
  b.rgba[2] = 0xf0808080u;  // alpha 15
  const ImageDifference d = compare_images(a.view(), b.view());
  CHECK(d.histogram[0][3] == 1);
  CHECK(d.histogram[2][5] == 1);
  CHECK(d.histogram[3][15] == 1);
  CHECK(d.histogram[1][0] == 256);
  CHECK(d.max_lsb == 15);
  CHECK(d.fraction_within(2) == Approx(253.0 / 256));
  CHECK(d.fraction_within(3) == Approx(254.0 / 256));
  CHECK(d.psnr_db == Approx(10 * std::log10(255.0 * 255 * 3 * 256 / (9 + 25))));
  const ImageDifference without_alpha = compare_images(a.view(), b.view(), {}, false);
  CHECK(without_alpha.max_lsb == 5);
  CHECK(without_alpha.histogram[3][15] == 0);
}

TEST_CASE("compare: a block is bad when more than a quarter of its pixels are off by more than 8") {
  const Picture a(16, 8, 0);
  Picture b = a;
  for (std::size_t i = 0; i < 16; ++i) b.rgba[(i / 8) * 16 + 8 + i % 8] = 9;  // a quarter of the right block
  CHECK(compare_images(a.view(), b.view()).bad_blocks == 0);
  CHECK(compare_images(a.view(), b.view()).worst_block == std::array<std::uint32_t, 2>{1, 0});
  b.rgba[7 * 16 + 15] = 8;
  CHECK(compare_images(a.view(), b.view()).bad_blocks == 0);
  b.rgba[7 * 16 + 15] = 9;
  CHECK(compare_images(a.view(), b.view()).bad_blocks == 1);
}

TEST_CASE("compare: excluded pixels count nowhere") {
  const Picture a(8, 8, 0), b(8, 8, 200);
  std::vector<std::uint8_t> excluded(64, 1);
  excluded[5] = 0;
  const ImageDifference d = compare_images(a.view(), b.view(), excluded);
  CHECK(d.pixels == 1);
  CHECK(d.max_histogram[200] == 1);
  excluded[5] = 1;
  const ImageDifference none = compare_images(a.view(), b.view(), excluded);
  CHECK(none.pixels == 0);
  CHECK(none.bad_blocks == 0);
  CHECK(none.fraction_within(0) == 1);
}

TEST_CASE("compare: images of different sizes are the user's mistake") {
  CHECK_THROWS_AS(compare_images(Picture(8, 8, 0).view(), Picture(8, 9, 0).view()), UserError);
  CHECK_THROWS_AS(difference_heat_map(Picture(8, 8, 0).view(), Picture(9, 8, 0).view()), UserError);
}

TEST_CASE("compare: coverage and the triangle seen") {
  constexpr std::uint64_t kNone = ~std::uint64_t{0};
  const std::vector<std::uint64_t> a{kNone, 1, 2, 3, kNone}, b{kNone, 1, kNone, 4, 5};
  const CoverageDifference d = compare_triangles(a, b, kNone);
  CHECK(d.pixels == 5);
  CHECK(d.only_a == 1);
  CHECK(d.only_b == 1);
  CHECK(d.both == 2);
  CHECK(d.other_triangle == 1);
  CHECK(d.coverage_fraction() == Approx(0.4));
  CHECK(d.triangle_fraction() == Approx(0.2));
  CHECK(compare_triangles(a, b, kNone, std::vector<std::uint8_t>{0, 0, 1, 1, 1}).coverage_fraction() == 0);
}

TEST_CASE("compare: the heat map is grey where equal and goes from blue to red") {
  Picture a(4, 1, 0xffffffffu);
  Picture b = a;
  b.rgba[1] = 0xfffffffeu;
  b.rgba[2] = 0xffffff00u;
  const std::vector<std::uint32_t> map = difference_heat_map(a.view(), b.view());
  CHECK(map[0] == 0xff555555u);
  CHECK((map[1] & 0xffu) < (map[1] >> 16 & 0xffu));
  CHECK(map[2] == 0xff0000ffu);
}
