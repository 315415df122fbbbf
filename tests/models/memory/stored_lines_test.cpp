/// How lines are said to lie in memory.
#include "models/memory/stored_lines.h"

#include <catch2/catch.hpp>

using namespace quadrille::models;

namespace {

std::pair<std::uint32_t, int> place(const StoredLines& lines, std::uint32_t line) {
  const StoredLines::Place at = lines.place_of(line);
  return {at.line, at.sectors};
}
using Place = std::pair<std::uint32_t, int>;

}  // namespace

TEST_CASE("stored_lines: every line is plain until it is said to be encoded, and again afterwards") {
  StoredLines lines;
  CHECK_FALSE(lines.is_encoded(7));
  CHECK(place(lines, 7) == Place(7, 0xf));
  lines.set_encoded(7, 1);
  CHECK(lines.is_encoded(7));
  CHECK_FALSE(lines.is_copy(7));
  CHECK(place(lines, 7) == Place(7, 0x1));
  lines.set_encoded(7, 3);
  CHECK(place(lines, 7) == Place(7, 0x7));
  CHECK_FALSE(lines.is_encoded(6));
  CHECK_FALSE(lines.is_encoded(1000000));
  lines.set_plain(7);
  lines.set_plain(1000000);
  CHECK_FALSE(lines.is_encoded(7));
}

TEST_CASE("stored_lines: a copy lies where its original lies, however that is stored") {
  StoredLines lines;
  lines.set_copy(100, 44);  // 56 lines apart: eight samples of 16 bytes
  CHECK(lines.is_copy(100));
  CHECK(lines.original_of(100) == 44);
  CHECK(place(lines, 100) == Place(44, 0xf));
  lines.set_encoded(44, 2);
  CHECK(place(lines, 100) == Place(44, 0x3));
  lines.set_plain(100);
  CHECK_FALSE(lines.is_copy(100));
}
