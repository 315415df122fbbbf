/// Clipper: one triangle, line or point a cycle, the time of a cut, and what becomes of each primitive.
#include "hw/geometry/clipper.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

#include <bit>
#include <limits>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

/// Lanes of the batch: a triangle each.
enum Shape : std::uint8_t { kInside, kOneOut, kTwoOut, kBeside, kNan, kSmall };

struct ClipBench final : Bench {
  struct Setup {
    std::vector<Timed<PrimitiveToken>> primitives;
    int clip_clk = 12, triangles_per_clk = 1, line_clip_clk = 4;
    models::PrimitiveState state{};
    models::CullMode cull = models::CullMode::kNone;
    Pace pace{};
    LinkSpec out{.depth = 64};
    int engines = 1;
  };
  ClipBench(Driver& driver, const contract::Variation& v, const Setup& s)
      : Bench(driver, v),
        batches(1),
        pieces(static_cast<std::size_t>(s.out.depth) + 2),
        second_pieces(static_cast<std::size_t>(s.out.depth) + 2) {
    PassState pass;
    pass.width = pass.height = 64;
    frame.passes = {pass};
    DrawState draw;
    draw.views[0].viewport = {0, 0, 64, 64, 0, 1};
    draw.views[0].clip = models::make_clip_state(draw.views[0].viewport, false, 8);
    draw.primitives = s.state;
    draw.views[0].setup.cull = s.cull;
    draw.vertex.program = &program;
    frame.draws = {draw};
    batches[0].outputs.resize(4);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    triangle(kInside, {0.5f, 0.5f, 0.5f}, 0);
    // the near plane cuts one corner off: a quadrilateral, two pieces
    triangle(kOneOut, {-0.5f, 0.5f, 0.5f}, 0);
    triangle(kTwoOut, {-0.5f, -0.5f, 0.5f}, 0);
    triangle(kBeside, {0.5f, 0.5f, 0.5f}, 5);
    triangle(kNan, {0.5f, nan, 0.5f}, 0);
    triangle(kSmall, {0.5f, 0.5f, 0.5f}, 0);
    for (std::size_t i = 0; i < 3; ++i) {  // within the first 8x8 pixels
      for (std::size_t c = 0; c < 2; ++c) {
        std::uint32_t& word = batches[0].outputs[c][3 * kSmall + i];
        word = std::bit_cast<std::uint32_t>(std::bit_cast<float>(word) * 0.1f - 0.9f);
      }
    }
    params.clip_clk.set(s.clip_clk);
    params.triangles_per_clk.set(s.triangles_per_clk);
    params.line_clip_clk.set(s.line_clip_clk);
    unit = std::make_unique<Clipper>(
        "unit", context({.partitions = s.engines, .engines = s.engines}), params, batches,
        s.engines == 1 ? std::vector{&pieces} : std::vector{&pieces, &second_pieces});
    add(*unit);
    feed(unit->primitive_in, s.primitives);
    const auto shown = [](const ClippedToken& t) {
      return t.kind == TokenKind::kWork ? t.primitive : 900u + static_cast<unsigned>(t.kind);
    };
    sink = &drain<ClippedToken>(*unit->clipped_out[0], shown, s.pace, s.out);
    if (s.engines > 1) second = &drain<ClippedToken>(*unit->clipped_out[1], shown, {}, s.out);
  }
  void triangle(Shape shape, std::array<float, 3> z, float x) {
    const float corner[3][2] = {{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.0f, 0.5f}};
    for (std::size_t i = 0; i < 3; ++i) {
      const float position[4] = {corner[i][0] + x, corner[i][1], z[i], 1.0f};
      for (std::size_t c = 0; c < 4; ++c)
        batches[0].outputs[c][3 * shape + i] = std::bit_cast<std::uint32_t>(position[c]);
    }
  }
  models::Program program;
  Clipper::Params params;
  Store<BatchSlot> batches;
  Store<ClippedPiece> pieces, second_pieces;
  std::unique_ptr<Clipper> unit;
  StubSink<ClippedToken>*sink = nullptr, *second = nullptr;
};

ClipBench::Setup shapes(const std::vector<Shape>& list) {
  ClipBench::Setup s;
  for (const Shape shape : list) {
    const auto first = static_cast<std::uint8_t>(3 * shape);
    s.primitives.push_back({0,
                            {TokenKind::kWork,
                             DrawId(0),
                             0,
                             shape,
                             {{0, first},
                              {0, static_cast<std::uint8_t>(first + 1)},
                              {0, static_cast<std::uint8_t>(first + 2)}}}});
  }
  return s;
}
std::string cycles(const ClipBench::Setup& s) {
  return run<ClipBench>(s, [](const ClipBench& b) { return b.sink->text(); });
}

}  // namespace

TEST_CASE("clipper: one triangle a cycle while none is cut") {
  CHECK(cycles(shapes({kInside, kInside, kInside})) == "2:0 3:0 4:0");
}

TEST_CASE("clipper: a cut triangle takes clip_clk cycles and then one a piece") {
  for (const int clk : {1, 12, 40}) {
    auto s = shapes({kOneOut, kInside});
    s.clip_clk = clk;
    CHECK(cycles(s) == fmt::format("{}:1 {}:1 {}:0", 2 + clk, 3 + clk, 4 + clk));
    s = shapes({kTwoOut, kInside});
    s.clip_clk = clk;
    CHECK(cycles(s) == fmt::format("{}:2 {}:0", 2 + clk, 3 + clk));
  }
}

TEST_CASE(
    "clipper: n triangles take n over triangles_per_clk, whether they pass or not, a cut one clip_clk and "
    "its pieces") {
  constexpr int kCount = 600;
  for (const int rate : {1, 2, 4}) {
    for (const Shape shape : {kInside, kBeside, kNan, kOneOut}) {
      auto s = shapes(std::vector<Shape>(kCount, shape));
      s.triangles_per_clk = rate;
      s.pace = {.from = 0, .period = 0};
      s.out = {.depth = 64, .width = 8};
      s.primitives.push_back({0, {TokenKind::kDrawEnd, DrawId(0), 0, 0, {}}});
      const auto last = std::stod(
          run<ClipBench>(s, [](const ClipBench& b) { return fmt::format("{}", b.sink->got.back().cycle); }));
      const double each = shape == kOneOut ? 12 + 2.0 / rate : 1.0 / rate;
      CHECK(last == Approx(kCount * each).epsilon(0.02));
    }
  }
}

TEST_CASE("clipper: dropped triangles cost a cycle each, and every triangle is accounted for once") {
  const auto text =
      run<ClipBench>(shapes({kBeside, kNan, kInside, kOneOut, kTwoOut, kBeside}), [](const ClipBench& b) {
        const Unit& u = *b.unit;
        return fmt::format("{} of {}: {} passed {} clipped {} rejected {} not finite; {} pieces",
                           b.sink->text(), counter(u, "triangles"), counter(u, "passed"),
                           counter(u, "clipped"), counter(u, "rejected"), counter(u, "not_finite"),
                           counter(u, "pieces"));
      });
  CHECK(text == "4:0 17:1 18:1 31:2 of 6: 1 passed 2 clipped 2 rejected 1 not finite; 3 pieces");
}

TEST_CASE("clipper: a cut line takes line_clip_clk cycles and leaves as one") {
  // Lines between the first two corners: of these, none, one and both lie before the near plane.
  for (const int clk : {1, 4, 40}) {
    auto s = shapes({kInside, kOneOut, kTwoOut, kInside});
    s.state.assembled = models::PieceKind::kLine;
    s.line_clip_clk = clk;
    CHECK(cycles(s) == fmt::format("2:0 {}:1 {}:0", 3 + clk, 5 + clk));
  }
}

TEST_CASE("clipper: n lines and n points take n over triangles_per_clk, cut lines line_clip_clk and one") {
  constexpr int kCount = 600;
  for (const auto kind : {models::PieceKind::kLine, models::PieceKind::kPoint}) {
    for (const Shape shape : {kInside, kBeside, kNan, kOneOut}) {
      auto s = shapes(std::vector<Shape>(kCount, shape));
      s.state.assembled = kind;
      s.pace = {.from = 0, .period = 0};
      s.primitives.push_back({0, {TokenKind::kDrawEnd, DrawId(0), 0, 0, {}}});
      const auto text = run<ClipBench>(s, [&](const ClipBench& b) {
        return fmt::format("{} {} {}", b.sink->got.back().cycle, counter(*b.unit, "lines"),
                           counter(*b.unit, "points"));
      });
      const bool line = kind == models::PieceKind::kLine;
      CHECK(std::stod(text) == Approx(kCount * (line && shape == kOneOut ? 4 + 1 : 1)).epsilon(0.02));
      CHECK(text.ends_with(line ? " 600 0" : " 0 600"));
    }
  }
}

TEST_CASE("clipper: a triangle's edges and corners leave one a cycle, in the place of the triangle") {
  const auto text = [](models::PolygonMode mode, models::CullMode cull) {
    auto s = shapes({kInside, kOneOut, kBeside, kInside});
    s.state.polygon_mode = mode;
    s.cull = cull;
    return run<ClipBench>(s, [](const ClipBench& b) {
      const Unit& u = *b.unit;
      return fmt::format("{} | {} outlined {} clipped {} culled {} rejected {} pieces", b.sink->text(),
                         counter(u, "outlined"), counter(u, "clipped"), counter(u, "culled"),
                         counter(u, "rejected"), counter(u, "pieces"));
    });
  };
  // Two of the second triangle's edges are cut, 4 cycles each; of its corners one is before the near plane.
  CHECK(text(models::PolygonMode::kLine, models::CullMode::kNone) ==
        "2:0 3:0 4:0 13:1 14:1 15:1 17:0 18:0 19:0 | 2 outlined 1 clipped 0 culled 1 rejected 9 pieces");
  CHECK(text(models::PolygonMode::kPoint, models::CullMode::kNone) ==
        "2:0 3:0 4:0 5:1 6:1 8:0 9:0 10:0 | 3 outlined 0 clipped 0 culled 1 rejected 8 pieces");
  CHECK(text(models::PolygonMode::kLine, models::CullMode::kBack) ==
        " | 0 outlined 0 clipped 3 culled 1 rejected 0 pieces");
}

TEST_CASE("clipper: each engine gets the triangles that touch its part of the screen, and all boundaries") {
  // The triangle inside spans tiles of both engines; the small one lies in the first tile, which is the first
  // engine's.
  auto s = shapes({kInside, kSmall, kBeside});
  s.engines = 2;
  s.primitives.push_back({0, {TokenKind::kDrawEnd, DrawId(0), 0, 0, {}}});
  const auto text = run<ClipBench>(s, [](const ClipBench& b) {
    return fmt::format("{} | {} | {} copies", b.sink->text(), b.second->text(), counter(*b.unit, "copies"));
  });
  const unsigned end = 900 + static_cast<unsigned>(TokenKind::kDrawEnd);
  CHECK(text == fmt::format("2:0 3:5 5:{0} | 2:0 5:{0} | 1 copies", end));
}

TEST_CASE("clipper: all triangles wait while one engine's link is full") {
  auto s = shapes({kInside, kSmall, kInside, kSmall, kInside});
  s.engines = 2;
  s.out = {.depth = 1};
  s.pace = {.from = 100, .period = 1};
  const auto text = run<ClipBench>(s, [](const ClipBench& b) { return b.second->text(); });
  CHECK_THAT(text, Catch::StartsWith("2:0 10"));  // the second engine's next triangle waits for the first's
}

TEST_CASE("clipper: the window position of a piece is there when its token is") {
  const auto text = run<ClipBench>(shapes({kInside}), [](const ClipBench& b) {
    const ClippedPiece& piece = b.pieces[b.sink->got[0].token.piece];
    return fmt::format("{},{} {},{} {},{}", piece.vertices[0].x, piece.vertices[0].y, piece.vertices[1].x,
                       piece.vertices[1].y, piece.vertices[2].x, piece.vertices[2].y);
  });
  CHECK(text == "4096,4096 12288,4096 8192,12288");  // pixels 16, 48 and 32 in 1/256
}

TEST_CASE("clipper: stops between pieces while clipped_out is full") {
  auto s = shapes({kOneOut, kInside});
  s.pace = {.from = 100, .period = 10};
  s.out = {.depth = 1};
  CHECK(cycles(s) == "100:1 110:1 120:0");
}

TEST_CASE("clipper: keeps the contract, one-deep links included") {
  auto s = shapes({kInside, kOneOut, kNan, kTwoOut, kBeside, kInside});
  s.primitives.push_back({30, {TokenKind::kBatchEnd, DrawId(0), 0, 0, {}}});
  s.pace = {.from = 0, .period = 3};
  CHECK(contract_text<ClipBench>(s) == "");
}
