/// What is noted in a log of charges comes out again, whatever tick is asked for.
#include "hw/base/charge_log.h"

#include <catch2/catch.hpp>

#include <random>
#include <vector>

#include "hw/base/counter.h"

using namespace quadrille;
using namespace quadrille::hw;

namespace {

/// Random intervals for random draws: long and short, of whole cycles and not, and like ones in a row.
struct Noted {
  StatGroup group;
  WorkLog work{8, ScreenCells{}};
  std::vector<ChargeLog::Interval> intervals;

  ChargeLog log(unsigned seed, Tick period, std::size_t count) {
    group.keep_log(work);
    ChargeLog log(&group, period);
    std::mt19937 random(seed);
    Tick at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Tick cycles = random() % 8 == 0 ? 1 + random() % 1'000'000 : 1 + random() % 4;
      const Tick to = at + cycles * period + (random() % 16 == 0 ? 1 : 0);
      const auto what = static_cast<std::uint32_t>(random() % 5);
      if (random() % 3 == 0) work.turn_to({DrawId(static_cast<std::uint32_t>(random() % 8)), kNoTile});
      log.note(to, what);
      intervals.push_back({at, to, what, work.now().draw});
      at = to;
    }
    log.finish();
    return log;
  }
};

}  // namespace

TEST_CASE("charge log: every tick is found in what was noted for it") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Noted noted;
    const ChargeLog log = noted.log(seed, seed == 2 ? 569'801 : 1'000'000, 5000);
    CHECK(log.end() == noted.intervals.back().to);
    CHECK(log.bytes() < 8 * noted.intervals.size());
    ChargeLog::Reader reader(log);
    std::size_t wrong = 0;
    for (auto i = noted.intervals.rbegin(); i != noted.intervals.rend(); ++i) {
      for (const Tick t : {i->to, i->to - 1, i->from + 1}) {
        if (t <= i->from) continue;
        const ChargeLog::Interval& found = reader.at(t);
        // like neighbours are one
        wrong += found.from > i->from || found.to < i->to || found.what != i->what || found.draw != i->draw;
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("charge log: like intervals in a row take no room") {
  ChargeLog log(nullptr, 1000);
  for (Tick cycle = 1; cycle <= 100'000; ++cycle) log.note(cycle * 1000, ChargeLog::kBusy);
  log.note(100'001'000, ChargeLog::kWaiting);
  log.finish();
  CHECK(log.bytes() < 12);
  ChargeLog::Reader reader(log);
  CHECK(reader.at(100'001'000).what == ChargeLog::kWaiting);
  CHECK(reader.at(100'000'000).from == 0);
  CHECK(reader.at(1).draw == kNoDraw);
}
