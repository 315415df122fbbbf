/// The units of synthetic machines, built from the kernel's own. What each role does is written at `Role` in
/// world_spec.h.
#pragma once

#include "hw/base/unit.h"
#include "tests/hw/base/world_spec.h"

#include <array>
#include <memory>
#include <optional>

namespace quadrille::hw::world {

/// Up to eight ports of one direction; they lie inside their unit, as the ports of real units do.
template <class Port>
class Ports {
 public:
  void add(Unit& owner, const std::string& name, LinkRole role) {
    ports_.at(count_++).emplace(owner, name.c_str(), role);
  }
  [[nodiscard]] std::size_t size() const { return count_; }
  std::optional<Port>& operator[](std::size_t i) { return ports_[i]; }
  const std::optional<Port>& operator[](std::size_t i) const { return ports_[i]; }
  std::optional<Port>* begin() { return ports_.data(); }
  std::optional<Port>* end() { return ports_.data() + count_; }
  [[nodiscard]] const std::optional<Port>* begin() const { return ports_.data(); }
  [[nodiscard]] const std::optional<Port>* end() const { return ports_.data() + count_; }

 private:
  std::array<std::optional<Port>, 8> ports_;
  std::size_t count_ = 0;
};

/// One unit of a world. Ports are `in0`.., `out0`..; what the roles do is written at `Role`.
class SyntheticUnit : public Unit {
 public:
  SyntheticUnit(sc_core::sc_module_name name, const UnitSpec& spec, const Clock& clock,
                const std::vector<LinkRole>& input_roles);
  [[nodiscard]] FifoIn<Token>& in(int i) { return *inputs_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] FifoOut<Token>& out(int i) { return *outputs_[static_cast<std::size_t>(i)]; }
  /// Where actions are recorded; none by default.
  void record_into(std::vector<Event>& events) { events_ = &events; }

 protected:
  [[nodiscard]] Wake own() const { return Wake(free_); }
  /// Fills a place of this edge and charges it; the last one keeps the unit for `cycles`.
  void use(Tick now, int cycles) {
    if (spec_.rate > 1 && !fills_edge(now)) cycles = 0;
    free_ = after(now, cycles);
    occupy(now, cycles > 0 ? cycles : 1);
  }
  void note(Tick now, char what, int port, std::uint32_t id) {
    if (events_ != nullptr) events_->push_back({now, what, static_cast<std::uint8_t>(port), id});
  }
  UnitSpec spec_;

 private:
  std::vector<Event>* events_ = nullptr;
  [[nodiscard]] bool fills_edge(Tick now) {
    used_ = edge_ == now ? used_ + 1 : 1;
    edge_ = now;
    return used_ == spec_.rate;
  }
  Tick free_ = 0, edge_ = -1;
  int used_ = 0;

 protected:
  Ports<FifoIn<Token>> inputs_;
  Ports<FifoOut<Token>> outputs_;
};

/// A unit of either kind; null for a role of the other.
[[nodiscard]] std::unique_ptr<SyntheticUnit> make_fixed_order(const UnitSpec& spec, const Clock& clock,
                                                              const std::vector<LinkRole>& input_roles);
[[nodiscard]] std::unique_ptr<SyntheticUnit> make_chooser(const UnitSpec& spec, const Clock& clock,
                                                          const std::vector<LinkRole>& input_roles);
[[nodiscard]] std::unique_ptr<SyntheticUnit> make_unit(const UnitSpec& spec, const Clock& clock,
                                                       const std::vector<LinkRole>& input_roles);

}  // namespace quadrille::hw::world
