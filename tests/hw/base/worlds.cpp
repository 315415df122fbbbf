#include "tests/hw/base/worlds.h"

#include <numeric>
#include <random>

namespace quadrille::hw::world {
namespace {

std::vector<std::size_t> shuffled(std::size_t n, std::uint64_t seed) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937_64 random(seed);
  for (std::size_t i = n; seed != 0 && i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

}  // namespace

World::World(const WorldSpec& spec, Driver& driver, const contract::Variation& variation, bool record)
    : trace_(spec.units.size()), units_(spec.units.size()), links_(spec.wires.size()) {
  for (const std::size_t i : shuffled(spec.units.size(), variation.creation_seed)) {
    const UnitSpec& u = spec.units[i];
    std::vector<LinkRole> roles(static_cast<std::size_t>(u.inputs), LinkRole::kFlow);
    for (const WireSpec& w : spec.wires) {
      if (w.reply && w.to.unit == static_cast<int>(i))
        roles[static_cast<std::size_t>(w.to.port)] = LinkRole::kReply;
    }
    units_[i] = make_unit(u, Clock(spec.clocks_hz[static_cast<std::size_t>(u.clock)]), roles);
    if (record) units_[i]->record_into(trace_[i]);
  }
  for (const std::size_t i : shuffled(spec.wires.size(), variation.creation_seed)) {
    const WireSpec& w = spec.wires[i];
    SyntheticUnit& from = unit(w.from.unit);
    SyntheticUnit& to = unit(w.to.unit);
    const LinkSpec link = variation.link(
        {.depth = w.depth, .width = w.width, .latency = w.latency, .credit_latency = w.credit});
    links_[i] =
        std::make_unique<Fifo<Token>>(fmt::format("link_{}_{}", from.basename(), w.from.port).c_str(), link);
    from.out(w.from.port).bind(*links_[i]);
    to.in(w.to.port).bind(*links_[i]);
  }
  for (const auto& u : units_) driver.add(*u);
}

std::uint64_t World::digest() const {
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&hash](std::uint64_t v) { hash = (hash ^ v) * 1099511628211u; };
  for (const auto& events : trace_) {
    add(events.size());
    for (const Event& e : events) {
      add(static_cast<std::uint64_t>(e.at));
      add(static_cast<std::uint64_t>(e.what) << 40 | static_cast<std::uint64_t>(e.port) << 32 | e.id);
    }
  }
  return hash;
}

}  // namespace quadrille::hw::world
