#include "studies/explore/slurm.h"

#include <catch2/catch.hpp>

#include "models/base/error.h"

namespace quadrille::studies::explore {

TEST_CASE("slurm: a list of points reads back as it was") {
  const std::vector<PointKey> points{{"0123456789abcdef", "fedcba9876543210", 0}, {"a", "b", 400}};
  const std::set<PointKey> back = read_point_list(point_list(points), "part-0.points");
  CHECK(back == std::set<PointKey>(points.begin(), points.end()));
  CHECK(read_point_list("", "part-0.points").empty());
}

TEST_CASE("slurm: a line that is no point is refused with file and line") {
  CHECK_THROWS_WITH(read_point_list("a b 0\na b\n", "part-0.points"), Catch::StartsWith("part-0.points:2:"));
  CHECK_THROWS_AS(read_point_list("a b c\n", "part-0.points"), UserError);
}

TEST_CASE("slurm: a shell reads words back as they are") {
  CHECK(shell_words({"a b", "it's", "$HOME"}) == R"('a b' 'it'\''s' '$HOME')");
}

}  // namespace quadrille::studies::explore
