#include "tests/models/memory/dram_traffic.h"

#include <toml++/toml.h>
#include <algorithm>
#include <stdexcept>

namespace quadrille::models {

namespace {

constexpr int kLineBytes = 128;
constexpr int kSectorBytes = 32;
constexpr std::uint8_t kWholeLine = 0xF;

DramRefreshKind refresh_named(const std::string& name) {
  if (name == "none") return DramRefreshKind::kNone;
  if (name == "all_bank") return DramRefreshKind::kAllBank;
  if (name == "per_bank") return DramRefreshKind::kPerBank;
  throw std::invalid_argument("refresh '" + name + "'");
}

DramRefresh model_refresh(DramRefreshKind kind) {
  switch (kind) {
    case DramRefreshKind::kNone: return DramRefresh::kNone;
    case DramRefreshKind::kAllBank: return DramRefresh::kAllBank;
    case DramRefreshKind::kPerBank: return DramRefresh::kPerBank;
  }
  return DramRefresh::kNone;
}

/// The requests of a pattern, one after the other, with the pause before each.
class Requests {
 public:
  Requests(DramPattern pattern, const DramNumbers& numbers, std::uint32_t seed)
      : pattern_(pattern), random_(seed) {
    row_lines_ = static_cast<std::uint64_t>(numbers.pseudo_channels) *
                 static_cast<std::uint64_t>(numbers.row_bytes) / kLineBytes;
    bank_lines_ = row_lines_ * static_cast<std::uint64_t>(numbers.banks * numbers.ranks);
    lines_ = bank_lines_ * static_cast<std::uint64_t>(numbers.rows);
  }

  DramRequest next(std::int64_t& pause);

 private:
  std::uint64_t any(std::uint64_t below) {
    return ((static_cast<std::uint64_t>(random_.bits()) << 32) | random_.bits()) % below;
  }
  bool chance(int percent) { return random_.integer(1, 100) <= percent; }
  DramRequest mixed(std::int64_t& pause);

  DramPattern pattern_;
  RandomSource random_;
  std::uint64_t row_lines_, bank_lines_, lines_;
  std::uint64_t place_ = 0;
  int phase_left_ = 0;
  DramPattern phase_ = DramPattern::kReads;
};

DramRequest Requests::next(std::int64_t& pause) {
  pause = 0;
  const std::uint64_t step = place_++;
  switch (pattern_) {
    case DramPattern::kReads: return {step % lines_, kWholeLine, false};
    case DramPattern::kWrites: return {step % lines_, kWholeLine, true};
    case DramPattern::kCopy:
      return {((step & 1) * lines_ / 2 + step / 2) % lines_, kWholeLine, (step & 1) != 0};
    case DramPattern::kRandom:
      return {any(lines_), static_cast<std::uint8_t>(random_.integer(1, kWholeLine)), chance(30)};
    case DramPattern::kWriteHeavy:
      return {any(lines_), static_cast<std::uint8_t>(random_.integer(1, kWholeLine)), chance(85)};
    case DramPattern::kOneBank: return {step % (lines_ / bank_lines_) * bank_lines_, 1, chance(40)};
    case DramPattern::kTwoRows:
      return {(step & 1) * bank_lines_ + any(row_lines_ * 4), kWholeLine, chance(50)};
    case DramPattern::kPauses:
      if (chance(5)) pause = random_.integer(1, 60'000);
      return {any(lines_), kWholeLine, chance(40)};
    case DramPattern::kMixed: return mixed(pause);
  }
  return {};
}

/// Stretches of the other patterns.
DramRequest Requests::mixed(std::int64_t& pause) {
  if (phase_left_-- == 0) {
    phase_left_ = random_.integer(20, 400);
    phase_ = static_cast<DramPattern>(random_.integer(0, static_cast<int>(DramPattern::kPauses)));
    place_ = any(lines_);
  }
  pattern_ = phase_;
  const DramRequest request = next(pause);
  pattern_ = DramPattern::kMixed;
  return request;
}

/// Commands in order of time over all pseudo-channels; the controller gives them in order for each.
class Sorter {
 public:
  explicit Sorter(DramChecker& checker) : checker_(checker) {}
  void add(const DramCommand& command) { waiting_.push_back(command); }
  /// Nothing before `cycle` is still to come.
  void settle(std::int64_t cycle) {
    if (waiting_.empty()) return;
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [](const DramCommand& a, const DramCommand& b) { return a.cycle < b.cycle; });
    const auto end = std::find_if(waiting_.begin(), waiting_.end(),
                                  [cycle](const DramCommand& c) { return c.cycle >= cycle; });
    std::for_each(waiting_.begin(), end, [this](const DramCommand& c) { checker_.check(c); });
    waiting_.erase(waiting_.begin(), end);
  }

 private:
  DramChecker& checker_;
  std::vector<DramCommand> waiting_;
};

DramControllerParams controller_params(const DramTraffic& traffic) {
  DramControllerParams params;
  params.timing = dram_timing(traffic.model);
  params.scheduler = traffic.policy.scheduler;
  params.page = traffic.policy.page;
  params.write_drain = traffic.policy.write_drain;
  params.mapping = traffic.policy.mapping;
  params.hash = traffic.policy.hash;
  return params;
}

}  // namespace

DramNumbers dram_data_file(const std::string& standard) {
  const toml::table file =
      toml::parse_file(std::string(QUADRILLE_SOURCE_DIR) + "/configs/memory/" + standard + ".toml");
  const auto memory = file["memory"];
  DramNumbers numbers = dram_numbers(standard);
  for (const DramNumberName& number : dram_number_names())
    numbers.*number.member = memory[number.name].value<int>().value();
  numbers.refresh = refresh_named(memory["refresh"].value<std::string>().value());
  numbers.separate_buses = memory["separate_buses"].value<bool>().value();
  numbers.shared_commands = memory["shared_commands"].value<bool>().value();
  return numbers;
}

DramTiming dram_timing(const DramNumbers& n) {
  DramTiming t;
  t.pseudo_channels = n.pseudo_channels;
  t.ranks = n.ranks;
  t.bank_groups = n.bank_groups;
  t.banks = n.banks;
  t.rows = n.rows;
  t.row_bytes = n.row_bytes;
  t.burst_bytes = n.burst_bytes;
  t.t_burst = n.t_burst;
  t.t_rcd = n.t_rcd;
  t.t_rcd_wr = n.t_rcd_wr;
  t.t_rp = n.t_rp;
  t.t_ras = n.t_ras;
  t.t_rc = n.t_rc;
  t.t_cas = n.t_cas;
  t.t_cwl = n.t_cwl;
  t.t_ccd_s = n.t_ccd_s;
  t.t_ccd_l = n.t_ccd_l;
  t.t_rrd_s = n.t_rrd_s;
  t.t_rrd_l = n.t_rrd_l;
  t.t_faw = n.t_faw;
  t.t_wr = n.t_wr;
  t.t_wtr_s = n.t_wtr_s;
  t.t_wtr_l = n.t_wtr_l;
  t.t_rtp = n.t_rtp;
  t.t_rtw = n.t_rtw;
  t.t_rtrs = n.t_rtrs;
  t.t_refi = n.t_refi;
  t.t_rfc = n.t_rfc;
  t.t_rfc_pb = n.t_rfc_pb;
  t.t_rrefd = n.t_rrefd;
  t.refresh = model_refresh(n.refresh);
  t.refresh_postpone = n.refresh_postpone;
  t.separate_buses = n.separate_buses;
  t.shared_commands = n.shared_commands;
  t.act_slots = n.act_slots;
  t.column_slots = n.column_slots;
  return t;
}

const std::vector<DramPattern>& dram_patterns() {
  static const std::vector<DramPattern> patterns{
      DramPattern::kReads,   DramPattern::kWrites,     DramPattern::kCopy,
      DramPattern::kRandom,  DramPattern::kWriteHeavy, DramPattern::kOneBank,
      DramPattern::kTwoRows, DramPattern::kPauses,     DramPattern::kMixed};
  return patterns;
}

const char* dram_pattern_name(DramPattern pattern) {
  switch (pattern) {
    case DramPattern::kReads: return "sequential reads";
    case DramPattern::kWrites: return "sequential writes";
    case DramPattern::kCopy: return "a copy";
    case DramPattern::kRandom: return "random";
    case DramPattern::kWriteHeavy: return "mostly writes";
    case DramPattern::kOneBank: return "one bank";
    case DramPattern::kTwoRows: return "two rows in turn";
    case DramPattern::kPauses: return "with pauses";
    case DramPattern::kMixed: return "mixed";
  }
  return "?";
}

// Every scheduler with every page policy; the other policies take turns, so that each is there with several
// of them. The first row is that of the default machine, but for its mapping.
const std::vector<DramPolicy>& dram_policies() {
  static const std::vector<DramPolicy> policies = [] {
    const auto& drains = dram_write_drains().all();
    const auto& mappings = dram_mappings().all();
    std::vector<DramPolicy> all;
    const auto& schedulers = dram_schedulers().all();
    for (auto scheduler = schedulers.rbegin(); scheduler != schedulers.rend(); ++scheduler) {
      for (const DramPagePolicyEntry* page : dram_page_policies().all()) {
        const std::size_t turn = all.size();
        const auto* drain = drains[(turn + 1) % drains.size()];
        const auto* mapping = mappings[turn % mappings.size()];
        all.push_back({fmt::format("scheduler {}, page {}, write_drain {}, mapping {}", (*scheduler)->name,
                                   page->name, drain->name, mapping->name),
                       *scheduler, page, drain, mapping, turn % 2 == 0});
      }
    }
    return all;
  }();
  return policies;
}

DramRun run_dram_traffic(const DramTraffic& traffic) {
  DramChecker checker(traffic.rules);
  Sorter sorter(checker);
  DramController controller(controller_params(traffic));
  DramRun run;
  controller.set_trace([&](const DramCommand& command) {
    ++run.commands;
    sorter.add(command);
  });
  Requests requests(traffic.pattern, traffic.model, traffic.seed);
  std::vector<DramDone> done;
  std::int64_t pause = 0;
  DramRequest request = requests.next(pause);
  std::int64_t arrival = pause;
  std::int64_t now = 0;
  const auto step = [&] {
    now = controller.next();
    controller.step(now, done);
    run.answers += static_cast<std::int64_t>(done.size());
    for (const DramDone& each : done) run.cycles = std::max(run.cycles, each.done);
    done.clear();
    sorter.settle(now);
  };
  while (run.commands < traffic.commands && !(traffic.stop && checker.violation_count() > 0)) {
    const std::int64_t at = std::max(arrival, now);
    if (!controller.room(request.write) || at > controller.next()) {
      step();
      continue;
    }
    now = at;
    request.id = static_cast<std::uint32_t>(run.requests++);
    run.bytes += kSectorBytes * __builtin_popcount(request.sectors);
    controller.take(request, now);
    request = requests.next(pause);
    arrival = now + pause;
  }
  while (controller.next() != DramController::kNever) step();
  sorter.settle(DramController::kNever);
  checker.finish(now);
  run.violation_count = checker.violation_count();
  run.violations = checker.violations();
  return run;
}

}  // namespace quadrille::models
