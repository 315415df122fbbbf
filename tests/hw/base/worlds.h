/// The synthetic machines of world_spec.h, built from the units of synthetic_unit.h.
#pragma once

#include "hw/base/driver.h"
#include "tests/hw/base/synthetic_unit.h"
#include "tests/hw/contract.h"

#include <memory>

namespace quadrille::hw::world {

/// A built world. Every link is named `link_<from>_<port>`.
class World final : public contract::Specimen {
 public:
  /// `variation.creation_seed` permutes the order of creating modules and links.
  World(const WorldSpec& spec, Driver& driver, const contract::Variation& variation = {}, bool record = true);
  [[nodiscard]] const Trace& trace() const { return trace_; }
  [[nodiscard]] SyntheticUnit& unit(int i) { return *units_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] Fifo<Token>& link(int i) { return *links_[static_cast<std::size_t>(i)]; }
  /// Order-sensitive checksum of the trace.
  [[nodiscard]] std::uint64_t digest() const override;
  [[nodiscard]] bool finished() const override { return true; }

 private:
  Trace trace_;
  std::vector<std::unique_ptr<SyntheticUnit>> units_;
  std::vector<std::unique_ptr<Fifo<Token>>> links_;
};

}  // namespace quadrille::hw::world
