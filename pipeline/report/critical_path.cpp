#include "pipeline/report/critical_path.h"

#include "pipeline/machine/machine.h"
#include "pipeline/report/report.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace quadrille::pipeline {

std::string_view name_of(PathPart part) {
  constexpr std::array<std::string_view, 3> kNames{"busy", "waiting", "link"};
  return kNames.at(static_cast<std::size_t>(part));
}

namespace {

/// By unit or link, part, and who waited.
using Shares = std::map<std::tuple<std::string_view, PathPart, std::string_view>, hw::Tick>;

std::vector<PathShare> longest_first(const Shares& shares) {
  std::vector<PathShare> parts;
  parts.reserve(shares.size());
  for (const auto& [key, ticks] : shares) {
    const auto& [of, part, by] = key;
    parts.push_back({std::string(of), part, std::string(by), ticks});
  }
  std::ranges::stable_sort(parts, std::ranges::greater{}, &PathShare::ticks);
  return parts;
}

hw::Tick sum(const std::vector<PathShare>& parts) {
  hw::Tick ticks = 0;
  for (const PathShare& part : parts) ticks += part.ticks;
  return ticks;
}

}  // namespace

/// Where the path is, and what it has been so far.
class CriticalPathLog::Walk {
 public:
  explicit Walk(CriticalPathLog& of) : machine_(of.machine_) {
    places_.reserve(machine_.units().size());
    for (std::size_t i = 0; i < machine_.units().size(); ++i) {
      const hw::Unit& unit = *machine_.units()[i];
      const Logs& logs = *of.logs_[i];
      places_.emplace(&unit, Place{without_number(unit.name()), &logs, hw::ChargeLog::Reader(logs.charges)});
    }
    for (std::size_t i = 0; i < machine_.links().size(); ++i)
      keys_.emplace(machine_.links()[i].get(), machine_.link_keys()[i]);
  }

  CriticalPath frame() {
    CriticalPath path;
    path.ticks = machine_.end();
    follow(path.ticks, 0);
    path.stretches = stretches_;
    path.parts = parts_of_all();
    for (const auto& [draw, shares] : by_draw_) {
      CriticalPath::OfDraw one{hw::DrawId(draw), 0, longest_first(shares)};
      one.ticks = sum(one.parts);
      path.draws.push_back(std::move(one));
    }
    std::ranges::stable_sort(path.draws, std::ranges::greater{}, &CriticalPath::OfDraw::ticks);
    return path;
  }

  /// What the end of a draw waited for, back to its begin.
  std::vector<PathShare> draw(hw::Tick issued, hw::Tick retired) {
    by_draw_.clear();
    follow(retired, issued);
    return parts_of_all();
  }

 private:
  struct Place {
    std::string_view kind;
    const Logs* logs;
    hw::ChargeLog::Reader reader;
  };

  /// From an action of the command processor back to a tick before.
  void follow(hw::Tick from, hw::Tick until) {
    now_ = from;
    until_ = until;
    unit_ = &machine_.one<hw::CommandProcessor>();
    sent_through_.reset();
    leg_ = nullptr;
    while (now_ > until_) step();
  }
  /// For whichever draw.
  [[nodiscard]] std::vector<PathShare> parts_of_all() const {
    Shares all;
    for (const auto& [draw, shares] : by_draw_)
      for (const auto& [key, ticks] : shares) all[key] += ticks;
    return longest_first(all);
  }

  /// The time from `to` up to now is on the path.
  void add(hw::DrawId draw, std::string_view of, PathPart part, std::string_view by, hw::Tick to) {
    to = std::clamp(to, until_, now_);
    if (to < now_) by_draw_[draw.index()][{of, part, by}] += now_ - to;
    now_ = to;
  }

  void step() {
    Place& place = places_.at(unit_);
    if (!place.logs->legs.empty() && step_by_leg(place.kind, place.logs->legs)) return;
    const std::string_view kind = place.kind;
    // between two clocks a token's time is known to a cycle, and the unit may just have begun to wait
    const hw::Tick end = place.logs->charges.end();
    if (now_ > end) return add(hw::kNoDraw, kind, PathPart::kWaiting, kind, end);
    const hw::ChargeLog::Interval& now = place.reader.at(now_);
    if (now.what == hw::ChargeLog::kBusy) return add(now.draw, kind, PathPart::kBusy, kind, now.from);
    if (now.what == hw::ChargeLog::kWaiting) return add(now.draw, kind, PathPart::kWaiting, kind, now.from);
    go_through(now.what - hw::ChargeLog::kFirstPort, now.draw, kind);
  }

  /// To the unit at the other end of a port's link, at the time when it sent the token or made the room.
  void go_through(std::uint32_t number, hw::DrawId draw, std::string_view kind) {
    const hw::PortBase& port = *unit_->ports().at(number);
    const hw::FifoBase& link = port.fifo();
    const bool input = port.direction() == hw::PortBase::Direction::kIn;
    const hw::Tick latency = input ? link.forward_lookahead() : link.credit_lookahead();
    unit_ = input ? link.producer() : link.consumer();
    sent_through_ = input ? producing_port(link) : std::optional<std::uint32_t>();
    leg_ = nullptr;
    ++stretches_;
    add(draw, keys_.at(&link), PathPart::kLink, kind, now_ - latency);
  }
  [[nodiscard]] static std::optional<std::uint32_t> producing_port(const hw::FifoBase& link) {
    for (const hw::PortBase* port : link.producer()->ports())
      if (&port->fifo() == &link) return port->number();
    return {};
  }

  /// False where the log has nothing so early.
  bool step_by_leg(std::string_view kind, const hw::LegLog& log) {
    if (leg_ == nullptr && !(sent_through_ && log.ends_legs(*sent_through_))) {
      const hw::LegLog::Take* take = sent_through_ ? log.entered_by(now_) : log.taken_by(now_);
      if (take != nullptr) go_before(*take, kind, log);
      return take != nullptr;
    }
    if (leg_ == nullptr) leg_ = log.ended_by(now_, *sent_through_);
    if (leg_ == nullptr) return false;
    const hw::LegLog::Leg& leg = *leg_;
    const hw::LegLog::Take& take = log.take_of(leg);
    add(take.draw, kind, PathPart::kWaiting, kind, leg.sent);
    if (leg.sent > leg.able && !leg.own_rate) {
      go_through(leg.out, take.draw, kind);
      return true;
    }
    add(take.draw, kind, PathPart::kBusy, kind, leg.able);
    add(take.draw, kind, PathPart::kWaiting, kind, std::max({take.taken, leg.from, now_ - leg.latency}));
    go_before(before_legs(kind, log), kind, log);
    return true;
  }
  /// The take that the leg began with, or that of an earlier one for whose work it waited.
  const hw::LegLog::Take& before_legs(std::string_view kind, const hw::LegLog& log) {
    for (;; --leg_) {
      const hw::LegLog::Take& take = log.take_of(*leg_);
      add(take.draw, kind, PathPart::kBusy, kind, std::max(take.taken, leg_->from));
      if (leg_->from <= take.taken || log.first(leg_)) return take;
    }
  }
  /// From a take to what it waited for: the place that a leg left, or its token.
  void go_before(const hw::LegLog::Take& take, std::string_view kind, const hw::LegLog& log) {
    add(take.draw, kind, PathPart::kBusy, kind, take.taken);
    const hw::LegLog::Leg* left = take.enters ? log.left_by(now_, leg_) : nullptr;
    if (left == nullptr || left->sent <= take.arrived) {
      add(take.draw, kind, PathPart::kBusy, kind, take.arrived);
      return go_through(take.port, take.draw, kind);
    }
    add(take.draw, kind, PathPart::kBusy, kind, left->sent);
    leg_ = left;  // the next step is that leg's
  }

  const Machine& machine_;
  std::unordered_map<const hw::Unit*, Place> places_;
  std::unordered_map<const hw::FifoBase*, std::string_view> keys_;
  const hw::Unit* unit_ = nullptr;
  hw::Tick now_ = 0, until_ = 0;
  /// number of the unit's port that the path came from; none: it came from a token that the unit took
  std::optional<std::uint32_t> sent_through_;
  const hw::LegLog::Leg* leg_ = nullptr;  ///< that the path is at the end of; null: not known yet
  std::uint64_t stretches_ = 0;
  std::map<std::uint32_t, Shares> by_draw_;
};

CriticalPathLog::CriticalPathLog(const Machine& machine) : machine_(machine) {
  logs_.reserve(machine.units().size());
  for (hw::Unit* unit : machine.units()) {
    logs_.push_back(std::make_unique<Logs>(Logs{hw::ChargeLog(unit->stats(), unit->clock().period())}));
    unit->keep_charges(logs_.back()->charges);
    unit->keep_legs(logs_.back()->legs);
  }
}

CriticalPathLog::~CriticalPathLog() = default;

CriticalPath CriticalPathLog::follow(bool each_draw) {
  std::size_t bytes = 0;
  for (const auto& log : logs_) {
    log->charges.finish();
    bytes += log->charges.bytes() + log->legs.bytes();
  }
  Walk walk(*this);
  CriticalPath path = walk.frame();
  path.log_bytes = bytes;
  const auto& commands = machine_.one<hw::CommandProcessor>();
  if (each_draw)
    for (std::size_t i = 0; i < commands.issued_at().size(); ++i)
      path.of_each.push_back(walk.draw(commands.issued_at()[i], commands.retired_at()[i]));
  return path;
}

}  // namespace quadrille::pipeline
