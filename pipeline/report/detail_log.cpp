#include "pipeline/report/detail_log.h"

#include "pipeline/report/report.h"

#include <algorithm>

namespace quadrille::pipeline {

namespace {

std::string kind_of(const hw::Unit& unit) { return std::string(without_number(unit.name())); }

/// Gives what a unit names of its counters to the log that keeps them.
class Columns final : public hw::Details {
 public:
  Columns(hw::WorkLog& log, DetailLog::LoggedUnit& unit) : log_(log), unit_(unit) {}
  void by_draw(DrawCount count, const hw::Counter& counter) override {
    unit_.draws.push_back({static_cast<std::size_t>(count), log_.by_draw(counter.storage()), &counter});
  }
  void by_tile(TileCount count, const hw::Counter& counter) override {
    unit_.tiles.push_back({static_cast<std::size_t>(count), log_.by_cell(counter.storage()), &counter});
  }
  void total_of_tiles(TileCount count, const hw::Counter& counter) override {
    unit_.tile_totals.push_back({static_cast<std::size_t>(count), 0, &counter});
  }
  void shared_by_draws(const hw::Counter* cycles) override {
    unit_.shared = true;
    if (cycles != nullptr) unit_.own_busy = DetailLog::Column{0, log_.by_draw(cycles->storage()), cycles};
  }
  void work(std::initializer_list<const hw::Counter*> counters, double per_cycle) override {
    DetailLog::LoggedUnit::Work work{{}, per_cycle};
    work.columns.reserve(counters.size());
    for (const hw::Counter* counter : counters) work.columns.push_back(log_.by_draw(counter->storage()));
    unit_.work.push_back(std::move(work));
  }

 private:
  hw::WorkLog& log_;
  DetailLog::LoggedUnit& unit_;
};

}  // namespace

hw::ScreenCells screen_cells(const hw::Frame& frame) {
  hw::ScreenCells screen;
  if (frame.passes.empty()) return screen;
  const hw::PassState& shown = frame.passes.back();
  const auto cells = [&](std::uint32_t tiles) { return (tiles + screen.tiles - 1) / screen.tiles; };
  screen.first_draw = shown.first_draw;
  screen.draws = shown.draws;
  screen.columns = cells(shown.color[0].surface.tiles_x);
  screen.rows = cells(shown.color[0].surface.tiles_y);
  return screen;
}

DetailLog::DetailLog(const Machine& machine, const DeviceFrame& frame, DetailOptions wanted,
                     KeptCounters* kept)
    : machine_(machine), frame_(frame), kept_(kept), screen_(screen_cells(frame.frame)) {
  detail_.wanted = wanted;
  for (const hw::Unit* unit : machine.units())
    if (unit->stats() != nullptr) add(*unit);
}

void DetailLog::add(const hw::Unit& unit) {
  LoggedUnit u;
  u.unit = &unit;
  const std::string kind = kind_of(unit);
  const auto known = std::ranges::find(detail_.kinds, kind);
  u.kind = static_cast<std::size_t>(known - detail_.kinds.begin());
  if (known == detail_.kinds.end()) detail_.kinds.push_back(kind);
  u.log = std::make_unique<hw::WorkLog>(static_cast<std::uint32_t>(frame_.frame.draws.size()), screen_);
  Columns columns(*u.log, u);
  unit.details(columns);
  if (kept_ != nullptr) add_asked(u, kind);
  u.busy = u.log->by_draw(unit.busy_storage());
  unit.stats()->keep_log(*u.log);
  units_.push_back(std::move(u));
}

void DetailLog::add_asked(LoggedUnit& u, const std::string& kind) const {
  const auto each = [&](const AskedCounter& asked, const auto& keep) {
    if (asked.kind != kind) return;
    for (const hw::Counter* c : u.unit->stats()->counters())
      if (c->name() == asked.counter) keep(*c);
  };
  for (std::size_t i = 0; i < kept_->by_draw.asked.size(); ++i)
    each(kept_->by_draw.asked[i], [&](const hw::Counter& c) {
      u.asked.push_back({i, u.log->by_draw(c.storage()), &c});
    });
  for (std::size_t i = 0; i < kept_->by_square.size(); ++i)
    each(kept_->by_square[i].asked, [&](const hw::Counter& c) {
      u.asked_squares.push_back({i, u.log->by_cell(c.storage()), &c});
    });
}

void DetailLog::collect_asked() {
  CountersByDraw& kept = kept_->by_draw;
  kept.draws.assign(frame_.frame.draws.size(), std::vector<std::uint64_t>(kept.asked.size()));
  kept.outside.assign(kept.asked.size(), 0);
  kept.total = 0;
  for (const LoggedUnit& u : units_) {
    for (const Column& c : u.asked) {
      for (std::uint32_t i = 0; i < kept.draws.size(); ++i)
        kept.draws[i][c.count] += u.log->of_draw(c.column, hw::DrawId(i));
      kept.outside[c.count] += u.log->of_draw(c.column, hw::kNoDraw);
      kept.total += c.counter->value();
    }
  }
  for (const hw::DrawState& draw : frame_.frame.draws)
    kept_->registers.push_back({draw.vertex.program->num_regs, draw.fragment.program->num_regs});
}

void DetailLog::collect_squares() {
  for (CounterBySquare& kept : kept_->by_square) kept.squares.assign(screen_.count(), 0);
  for (const LoggedUnit& u : units_) {
    for (const Column& c : u.asked_squares) {
      CounterBySquare& kept = kept_->by_square[c.count];
      for (std::uint32_t cell = 0; cell < screen_.count(); ++cell)
        kept.squares[cell] += u.log->of_cell(c.column, cell);
      kept.outside += u.log->of_cell(c.column, screen_.count());
      kept.total += c.counter->value();
    }
  }
}

std::int64_t DetailLog::busy_of(const LoggedUnit& u, hw::DrawId id) {
  if (u.own_busy) return static_cast<std::int64_t>(u.log->of_draw(u.own_busy->column, id));
  return u.shared ? 0 : u.unit->to_cycles(static_cast<std::int64_t>(u.log->of_draw(u.busy, id)));
}

double DetailLog::work_of(const LoggedUnit& u, hw::DrawId id) const {
  double most = u.shared ? 0 : static_cast<double>(busy_of(u, id));
  for (const LoggedUnit::Work& work : u.work) {
    std::uint64_t sum = 0;
    for (const std::size_t column : work.columns) sum += u.log->of_draw(column, id);
    most = std::max(most, static_cast<double>(sum) / work.per_cycle);
  }
  return most * static_cast<double>(machine_.clock().frequency_hz()) /
         static_cast<double>(u.unit->clock().frequency_hz());
}

void DetailLog::collect_draw(const LoggedUnit& u, hw::DrawId id, DrawFigures& draw) const {
  for (const Column& c : u.draws) draw.counts[c.count] += u.log->of_draw(c.column, id);
  draw.work[u.kind] = std::max(draw.work[u.kind], work_of(u, id));
  draw.busy[u.kind] += busy_of(u, id);
}

void DetailLog::collect_tiles(const LoggedUnit& u, TileFigures& tiles) const {
  for (const Column& c : u.tiles)
    for (std::uint32_t cell = 0; cell <= screen_.count(); ++cell)
      tiles.counts[c.count][cell] += u.log->of_cell(c.column, cell);
}

Detail DetailLog::collect() {
  const auto draws = static_cast<std::uint32_t>(frame_.frame.draws.size());
  const auto& commands = machine_.one<hw::CommandProcessor>();
  Detail d = detail_;
  const auto blank = [&](DrawFigures draw) {
    draw.busy.assign(d.kinds.size(), 0);
    draw.work.assign(d.kinds.size(), 0);
    return draw;
  };
  for (std::uint32_t i = 0; i < draws; ++i) {
    const hw::DrawState& state = frame_.frame.draws[i];
    d.draws.push_back(blank({.label = state.label,
                             .vertex_shader = state.vertex.program->name,
                             .fragment_shader = state.fragment.program->name,
                             .pass = state.pass,
                             .issued = machine_.clock().edges_before(commands.issued_at()[i]),
                             .retired = machine_.clock().edges_before(commands.retired_at()[i])}));
  }
  d.outside_draws = blank({.label = "outside_draws", .vertex_shader = {}, .fragment_shader = {}, .pass = {}});
  d.tiles.width = screen_.columns;
  d.tiles.height = screen_.rows;
  d.tiles.pixels = screen_.tiles * models::kTileSize;
  for (auto& counts : d.tiles.counts) counts.assign(std::size_t{screen_.count()} + 1, 0);
  std::array<std::uint64_t, kTileCounts> own{}, others{};  // totals as the tiles' own units count them
  std::array<bool, kTileCounts> counted_elsewhere{};
  for (const LoggedUnit& u : units_) {
    u.log->settle();
    for (std::uint32_t i = 0; i < draws; ++i) collect_draw(u, hw::DrawId(i), d.draws[i]);
    collect_draw(u, hw::kNoDraw, d.outside_draws);
    collect_tiles(u, d.tiles);
    for (const Column& c : u.draws) d.draw_totals[c.count] += c.counter->value();
    for (const Column& c : u.tiles) own[c.count] += c.counter->value();
    for (const Column& c : u.tile_totals) {
      others[c.count] += c.counter->value();
      counted_elsewhere[c.count] = true;
    }
    if (!u.shared) d.busy_total += u.unit->busy_cycles();
    if (u.own_busy) d.busy_total += static_cast<std::int64_t>(u.own_busy->counter->value());
  }
  if (kept_ != nullptr) {
    collect_asked();
    collect_squares();
  }
  for (std::size_t i = 0; i < kTileCounts; ++i) d.tile_totals[i] = counted_elsewhere[i] ? others[i] : own[i];
  return d;
}

}  // namespace quadrille::pipeline
