/// Cases of values that are no numbers or hardly any: NaN, infinity, denormals and the largest float, in
/// every attribute and in every entry of a matrix.
#include "studies/stability/measures.h"
#include "studies/stability/stability.h"
#include "studies/stability/stream_builder.h"

#include <array>
#include <cmath>
#include <limits>

namespace quadrille::studies::stability {

namespace {

constexpr std::uint32_t kCell = 20;
constexpr float kInfinity = std::numeric_limits<float>::infinity(),
                kNaN = std::numeric_limits<float>::quiet_NaN();

struct Odd {
  std::string_view name;
  float value;
};
/// Column 0 is left as it is.
constexpr std::array<Odd, 7> kOdd{{{"NaN", kNaN},
                                   {"+inf", kInfinity},
                                   {"-inf", -kInfinity},
                                   {"denormal", 1e-40F},
                                   {"least denormal", 1.4e-45F},
                                   {"-0", -0.0F},
                                   {"largest", std::numeric_limits<float>::max()}}};
constexpr std::size_t kColumns = kOdd.size() + 1;
constexpr bool is_finite(std::size_t column) { return column == 0 || column > 3; }
constexpr std::size_t kLargest = kOdd.size();

Area cell_area(std::size_t row, std::size_t column) {
  return {static_cast<std::int32_t>(kCell * column), static_cast<std::int32_t>(kCell * row), kCell, kCell};
}

/// One colour channel or pixel word of a cell, compared with the clean cell of its row.
template <class Visit>
void for_cell(const Observed& o, std::size_t row, std::size_t column, const Visit& visit) {
  for (std::uint32_t y = 0; y < kCell; ++y) {
    for (std::uint32_t x = 0; x < kCell; ++x) {
      const auto py = static_cast<std::uint32_t>(kCell * row) + y;
      visit(x, y, o.pixel(static_cast<std::uint32_t>(kCell * column) + x, py), o.pixel(x, py));
    }
  }
}

// attributes
// --------------------------------------------------------------------------------------------------

/// Position x y z w, colour r g b a, texture coordinate u v.
constexpr std::size_t kFloats = 10;

float& member(Corner& corner, std::size_t i) {
  const auto k = static_cast<glm::length_t>(i % 4);
  return i < 4 ? corner.position[k] : i < 8 ? corner.color[k] : corner.uv[static_cast<glm::length_t>(i - 8)];
}

/// A quad of two triangles a cell; the odd value is at the first corner of the first triangle alone.
traces::CommandStream attributes() {
  StreamBuilder stream("odd-attributes", kCell * kColumns, kCell * kFloats);
  stream.state({.paint = Paint::kTexture});
  for (std::size_t row = 0; row < kFloats; ++row) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      Corners corners = quad({-0.8F, -0.8F}, {0.8F, 0.8F}, 0.5F, {0.9F, 0.7F, 0.5F, 1});
      if (column > 0) member(corners[0], row) = kOdd[column - 1].value;
      stream.area(cell_area(row, column)).draw(corners);
    }
  }
  return stream.finish();
}

/// The first triangle lies below the diagonal from the upper left to the lower right corner of its quad
/// (window y points down), which runs through samples and is the lower one's right edge: those samples are
/// the other's.
bool of_first_triangle(std::uint32_t x, std::uint32_t y) { return y > x; }

void check_attributes(const Observed& o, Findings& f) {
  std::uint64_t others = 0, kept = 0, stored = 0;
  for (std::size_t row = 0; row < kFloats; ++row) {
    for (std::size_t column = 1; column < kColumns; ++column) {
      for_cell(o, row, column, [&](std::uint32_t x, std::uint32_t y, std::uint32_t now, std::uint32_t clean) {
        const bool first = of_first_triangle(x, y);
        if (!first) others += now != clean && !(row < 4 && column == kLargest) ? 1 : 0;
        if (!first || (clean >> 24) == 0) return;
        if (row < 4 && !is_finite(column)) kept += now != 0 ? 1 : 0;
        if (row >= 4 && row < 8 && !is_finite(column)) {
          const std::uint32_t value = (now >> (8 * (row - 4))) & 0xffu;
          stored += value != 0 && value != 255 ? 1 : 0;
        }
        if (row >= 8 && !is_finite(column)) stored += (now >> 24) == 0 ? 1 : 0;
      });
    }
  }
  f.equal("pixels of neighbours that changed", others, 0);
  f.equal("pixels kept of triangles whose position is not finite (D11)", kept, 0);
  f.equal("stored values that are neither 0 nor 1, nor a texel (D12, D70)", stored, 0);
}

// matrices
// --------------------------------------------------------------------------------------------------

constexpr std::size_t kEntries = 16;

traces::CommandStream matrices() {
  StreamBuilder stream("odd-matrices", kCell * kColumns, kCell * kEntries);
  for (std::size_t entry = 0; entry < kEntries; ++entry) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      glm::mat4 matrix(1);
      const auto c = static_cast<glm::length_t>(entry / 4), r = static_cast<glm::length_t>(entry % 4);
      if (column > 0) matrix[c][r] = kOdd[column - 1].value;
      // A denormal or a zero on the diagonal would flatten the quad: there it is added to the one instead.
      if (column > 0 && c == r && is_finite(column) && column != kLargest) matrix[c][r] += 1;
      const glm::vec4 color(0.3F + 0.04F * static_cast<float>(entry), 0.8F, 0.4F, 1);
      stream.area(cell_area(entry, column)).draw(quad({-0.8F, -0.7F}, {0.7F, 0.8F}, 0.5F, color), matrix);
    }
  }
  return stream.finish();
}

void check_matrices(const Observed& o, Findings& f) {
  std::uint64_t kept = 0, changed = 0;
  for (std::size_t entry = 0; entry < kEntries; ++entry) {
    for (std::size_t column = 1; column < kColumns; ++column) {
      for_cell(o, entry, column, [&](std::uint32_t, std::uint32_t, std::uint32_t now, std::uint32_t clean) {
        if (!is_finite(column)) kept += now != 0 ? 1 : 0;
        else if (column != kLargest) changed += now != clean ? 1 : 0;
      });
    }
  }
  f.equal("pixels drawn through a matrix that is not finite (D11)", kept, 0);
  f.equal("pixels that a denormal or -0 in a matrix changed", changed, 0);
}

}  // namespace

void add_value_cases(std::vector<Case>& cases) {
  cases.push_back({.name = "odd-attributes",
                   .group = "numbers",
                   .purpose = "NaN, infinities, denormals, -0 and the largest float in each component of "
                              "position, colour and texture coordinate",
                   .must = "a triangle without a finite position is dropped, a coordinate reads as 0, a "
                           "colour is stored as 0 or 1; nothing else changes",
                   .build = attributes,
                   .check = check_attributes});
  cases.push_back({.name = "odd-matrices",
                   .group = "numbers",
                   .purpose = "the same values in each of the sixteen entries of a draw's matrix",
                   .must = "the draw is dropped where its positions are not finite, denormals change "
                           "nothing, and no other draw does either",
                   .build = matrices,
                   .check = check_matrices});
}

}  // namespace quadrille::studies::stability
