/// For whom a counter grew: rows of draws and of cells add up to the counter, whatever the turns.
#include "hw/base/work_log.h"

#include "hw/base/counter.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;

namespace {

struct Stats : StatGroup {
  Counter things{*this, "things", "thing", "For a test"};
};

/// Two cells of 4x4 tiles side by side, for draws 1 and 2.
constexpr ScreenCells kScreen{.first_draw = DrawId(1), .draws = 2, .columns = 2, .rows = 1};

}  // namespace

TEST_CASE("work log: what is counted goes to the draw and the cell that were named last") {
  Stats stats;
  ++stats.things;  // before the log was there
  WorkLog log(3, kScreen);
  const std::size_t draws = log.by_draw(stats.things.storage()), cells = log.by_cell(stats.things.storage());
  stats.keep_log(log);
  stats.things += 2;  // for nobody
  stats.working_for(DrawId(1), 3, 3);
  stats.things += 10;
  stats.working_at(4, 0);
  stats.things += 20;
  stats.working_for(DrawId(2), 7, 3);
  stats.things += 40;
  stats.working_for(DrawId(2), 8, 3);  // right of the screen
  stats.things += 80;
  stats.working_for(DrawId(0), 0, 0);  // of a pass that is not shown
  stats.things += 160;
  stats.working_for(kNoDraw);
  stats.things += 320;
  log.settle();
  CHECK(log.of_draw(draws, DrawId(0)) == 160);
  CHECK(log.of_draw(draws, DrawId(1)) == 30);
  CHECK(log.of_draw(draws, DrawId(2)) == 120);
  CHECK(log.of_draw(draws, kNoDraw) == 322);
  CHECK(log.of_cell(cells, 0) == 10);
  CHECK(log.of_cell(cells, 1) == 60);
  CHECK(log.of_cell(cells, 2) == 562);
}

TEST_CASE("work log: settling twice adds nothing, and counts may shrink") {
  Stats stats;
  std::int64_t span = 0;
  WorkLog log(1, {});
  const std::size_t column = log.by_draw(span);
  stats.keep_log(log);
  stats.working_for(DrawId(0));
  span = 7;
  log.settle();
  log.settle();
  CHECK(log.of_draw(column, DrawId(0)) == 7);
  span = 4;  // three cycles lie behind the frame's end
  log.settle();
  CHECK(log.of_draw(column, DrawId(0)) == 4);
  CHECK(log.of_draw(column, kNoDraw) == 0);
}

TEST_CASE("work log: a group without a log only counts") {
  Stats stats;
  stats.working_for(DrawId(5), 1, 1);
  stats.working_at(2, 2);
  ++stats.things;
  CHECK(stats.things.value() == 1);
  CHECK(stats.log() == nullptr);
}
