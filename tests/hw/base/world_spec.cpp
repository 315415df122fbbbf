#include "tests/hw/base/world_spec.h"

#include <algorithm>
#include <random>

namespace quadrille::hw::world {

int WorldSpec::add(UnitSpec unit) {
  const int index = static_cast<int>(units.size());
  if (unit.name.empty())
    unit.name.append("u").append(std::to_string(index)).append("_").append(role_name(unit.role));
  unit.seed += static_cast<std::uint32_t>(index) * 7919u;
  units.push_back(std::move(unit));
  return index;
}

void WorldSpec::wire(LinkEnd from, LinkEnd to, WireSpec spec) {
  spec.from = from;
  spec.to = to;
  UnitSpec& producer = units[static_cast<std::size_t>(from.unit)];
  UnitSpec& consumer = units[static_cast<std::size_t>(to.unit)];
  producer.outputs = std::max(producer.outputs, from.port + 1);
  consumer.inputs = std::max(consumer.inputs, to.port + 1);
  wires.push_back(spec);
}

bool is_chooser(Role role) {
  return role == Role::kArbiter || role == Role::kPriority || role == Role::kSpread || role == Role::kCore ||
         role == Role::kMemory;
}

const char* role_name(Role role) {
  static constexpr const char* kNames[] = {"source",   "stage",  "serial", "fork",   "route",
                                           "recycle",  "join",   "expand", "pack",   "arbiter",
                                           "priority", "spread", "core",   "memory", "sink"};
  return kNames[static_cast<std::size_t>(role)];
}

namespace {

/// Grows a random machine from open streams: outputs that nobody reads yet.
class Grower {
 public:
  explicit Grower(std::uint64_t seed) : random_(seed) {}

  WorldSpec grow() {
    choose_clocks();
    for (int i = up_to(1, 3); i > 0; --i) open_.push_back({unit(Role::kSource, up_to(20, 150)), 0});
    for (int i = up_to(2, 12); i > 0; --i) step();
    for (const LinkEnd& stream : open_) connect(stream, {unit(Role::kSink), 0});
    return std::move(world_);
  }

 private:
  int up_to(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(int per_cent) { return up_to(1, 100) <= per_cent; }

  void choose_clocks() {
    static const std::vector<std::vector<std::int64_t>> kSets = {
        {1'000'000'000},
        {1'000'000'000, 500'000'000},
        {1'500'000'000, 1'000'000'000, 750'000'000},
        {1'000'000'000, 618'033'989},
        {1'755'000'000, 1'750'000'001, 2'414'213'562},
        {999'999'900},
    };
    world_.clocks_hz = kSets[random_() % kSets.size()];
    one_clock_ = chance(40);
  }

  int unit(Role role, int count = 1, int slots = 1) {
    UnitSpec u;
    u.role = role;
    u.clock = one_clock_ ? 0 : up_to(0, static_cast<int>(world_.clocks_hz.size()) - 1);
    u.rate = role != Role::kSerial && chance(25) ? up_to(2, 3) : 1;
    u.period = chance(70) ? 1 : up_to(2, 6);
    u.jitter = chance(60) ? 1 : up_to(2, 20);
    u.service = up_to(1, 8);
    u.spread = chance(50) ? 1 : up_to(2, 100);
    u.count = count;
    u.slots = slots;
    u.seed = static_cast<std::uint32_t>(random_());
    return world_.add(u);
  }

  void connect(LinkEnd from, LinkEnd to, bool reply = false) {
    WireSpec w;
    w.depth = chance(30) ? 1 : up_to(1, 12);
    w.width = chance(60) ? 1 : up_to(2, 3);
    w.latency = chance(60) ? 1 : chance(70) ? up_to(2, 8) : up_to(9, 100);
    w.credit = chance(60) ? 1 : chance(70) ? up_to(2, 8) : up_to(9, 100);
    w.reply = reply;
    world_.wire(from, to, w);
  }

  LinkEnd take() {
    const std::size_t i = random_() % open_.size();
    const LinkEnd stream = open_[i];
    open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(i));
    return stream;
  }

  void step() {
    const int pick = up_to(0, 99);
    if (pick < 20) chain(chance(50) ? Role::kStage : Role::kSerial, 1);
    else if (pick < 30) chain(chance(50) ? Role::kExpand : Role::kPack, up_to(1, 4));
    else if (pick < 48) split();
    else if (pick < 72) merge();
    else if (pick < 86) shared_memory();
    else feedback();
  }

  void chain(Role role, int count) {
    const int u = unit(role, count);
    connect(take(), {u, 0});
    open_.push_back({u, 0});
  }

  void split() {
    static constexpr Role kRoles[] = {Role::kFork, Role::kRoute, Role::kSpread, Role::kSpread};
    const int u = unit(kRoles[random_() % 4]);
    connect(take(), {u, 0});
    for (int i = 0, n = up_to(2, 3); i < n; ++i) open_.push_back({u, i});
  }

  void merge() {
    if (open_.size() < 2) return split();
    static constexpr Role kRoles[] = {Role::kArbiter, Role::kArbiter, Role::kPriority, Role::kJoin};
    const int u = unit(kRoles[random_() % 4]);
    const int n = up_to(2, static_cast<int>(std::min<std::size_t>(4, open_.size())));
    for (int i = 0; i < n; ++i) connect(take(), {u, i});
    open_.push_back({u, 0});
  }

  void shared_memory() {
    const int memory = unit(Role::kMemory, 1, up_to(1, 6));
    const int n = up_to(1, static_cast<int>(std::min<std::size_t>(3, open_.size())));
    std::vector<LinkEnd> served;
    for (int i = 0; i < n; ++i) {
      const int core = unit(Role::kCore, up_to(1, 3), up_to(1, 4));
      connect(take(), {core, 0});
      connect({core, 1}, {memory, i});
      connect({memory, i}, {core, 1}, true);
      served.push_back({core, 0});
    }
    open_.insert(open_.end(), served.begin(), served.end());
  }

  void feedback() {
    const int merge = unit(chance(50) ? Role::kArbiter : Role::kPriority);
    const int work = unit(chance(50) ? Role::kStage : Role::kSerial);
    const int back = unit(Role::kRecycle);
    connect(take(), {merge, 1});
    connect({merge, 0}, {work, 0});
    connect({work, 0}, {back, 0});
    connect({back, 1}, {merge, 0});
    open_.push_back({back, 0});
  }

  std::mt19937_64 random_;
  WorldSpec world_;
  std::vector<LinkEnd> open_;
  bool one_clock_ = true;
};

}  // namespace

WorldSpec random_world(std::uint64_t seed) { return Grower(seed).grow(); }

WorldSpec benchmark_world(int tokens, WireSpec link) {
  WorldSpec w;
  const int memory = w.add({.role = Role::kMemory, .rate = 4, .service = 4, .spread = 8, .slots = 8});
  const int merge = w.add({.role = Role::kArbiter});
  for (int lane = 0; lane < 8; ++lane) {
    const int source = w.add({.role = Role::kSource, .jitter = 4, .count = tokens});
    const int loop = w.add({.role = Role::kPriority});
    const int stage = w.add({.role = Role::kStage});
    const int core = w.add({.role = Role::kCore, .count = 1, .slots = 4});
    const int back = w.add({.role = Role::kRecycle});
    w.wire({source, 0}, {loop, 1}, link);
    w.wire({loop, 0}, {stage, 0}, link);
    w.wire({stage, 0}, {core, 0}, link);
    w.wire({core, 0}, {back, 0}, link);
    w.wire({core, 1}, {memory, lane}, link);
    WireSpec reply = link;
    reply.reply = true;
    w.wire({memory, lane}, {core, 1}, reply);
    w.wire({back, 1}, {loop, 0}, link);
    w.wire({back, 0}, {merge, lane}, link);
  }
  int last = merge;
  for (int i = 0; i < 7; ++i) {
    const int stage = w.add({.role = Role::kStage});
    w.wire({last, 0}, {stage, 0}, link);
    last = stage;
  }
  w.wire({last, 0}, {w.add({.role = Role::kSink}), 0}, link);
  return w;
}

}  // namespace quadrille::hw::world
