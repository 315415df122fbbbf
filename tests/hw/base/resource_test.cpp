/// Resources of a unit: what slices hold, and what becomes of them when a frame is long.
#include "hw/base/resource.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;

namespace {

constexpr Tick kSlice = Resources::kFirstSlice;

/// A rate whose work is set by hand.
struct Worked {
  double cycles = 0;
  Resources resources;
  Worked() {
    resources.add_rate("rate", [this](Tick) { return cycles; });
  }
  [[nodiscard]] const std::vector<double>& slices() const { return resources.all().front().at_end_of; }
};

}  // namespace

TEST_CASE("resources: a slice ends with the work done before it, and the last one with the frame") {
  Worked w;
  w.cycles = 10;
  w.resources.note(kSlice / 2, 0, 1);
  CHECK(w.slices().empty());
  w.resources.note(kSlice, 0, 1);
  w.cycles = 30;
  w.resources.note(3 * kSlice + 1, 0, 1);  // two slices without an action
  w.cycles = 35;
  w.resources.finish(3 * kSlice + 2, kSlice);
  CHECK(w.slices() == std::vector<double>{10, 30, 30, 35});
}

TEST_CASE("resources: slices of a long frame are joined in pairs, and none of the work is lost") {
  Worked w;
  const auto actions = static_cast<Tick>(5 * Resources::kMostSlices);
  for (Tick i = 1; i <= actions; ++i) {
    w.cycles = static_cast<double>(i);
    w.resources.note(i * kSlice, 0, 1);
  }
  w.resources.finish(actions * kSlice, w.resources.slice());
  CHECK(w.resources.slice() == 8 * kSlice);
  CHECK(w.slices().size() == 5 * Resources::kMostSlices / 8);
  for (std::size_t i = 0; i < w.slices().size(); ++i)
    REQUIRE(w.slices()[i] == 8.0 * static_cast<double>(i + 1));
}

TEST_CASE("resources: a unit with longer slices sets those of all") {
  Worked w;
  for (Tick i = 1; i <= 6; ++i) {
    w.cycles = static_cast<double>(i);
    w.resources.note(i * kSlice, 0, 1);
  }
  w.resources.finish(7 * kSlice, 4 * kSlice);
  CHECK(w.slices() == std::vector<double>{4, 6});
}

TEST_CASE("resources: work that goes on between actions is asked for at the end of each slice") {
  Resources resources;
  resources.add_rate("rate", [](Tick at) { return static_cast<double>(at) / static_cast<double>(kSlice); });
  resources.note(3 * kSlice, 0, 1);
  CHECK(resources.all().front().at_end_of == std::vector<double>{1, 2, 3});
}

TEST_CASE("resources: places count the cycles in which all were taken") {
  bool full = false;
  Resources resources;
  resources.add_places("slots", [&full] { return full; });
  resources.note(10, 0, 2);
  full = true;
  resources.note(24, 10, 2);
  CHECK(resources.all().front().total(24) == 7);
}

TEST_CASE("resources: rows are asked for at the end of every slice, and joined as the slices are") {
  Worked w;
  std::uint64_t counted = 0;
  w.resources.keep_rows([&] { return Resources::Row{counted, 2 * counted}; });
  for (Tick i = 1; i <= 6; ++i) {
    counted = static_cast<std::uint64_t>(i);
    w.resources.note(i * kSlice, 0, 1);
  }
  w.resources.finish(7 * kSlice, 4 * kSlice);
  CHECK(w.resources.rows() == std::vector<Resources::Row>{{4, 8}, {6, 12}});
}

TEST_CASE("resources: a unit without any has slices too where rows are asked for") {
  Resources resources;
  CHECK(resources.empty());
  std::uint64_t counted = 0;
  resources.keep_rows([&] { return Resources::Row{counted}; });
  CHECK_FALSE(resources.empty());
  resources.note(2 * kSlice, 0, 1);
  counted = 5;
  resources.finish(2 * kSlice + 1, kSlice);
  CHECK(resources.rows() == std::vector<Resources::Row>{{0}, {0}, {5}});
}
