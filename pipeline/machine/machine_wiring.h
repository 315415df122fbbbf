/// Who is linked to whom: the links of the plan (machine_plan.h) between the units that were made.
///
/// How often the kinds of both ends stand says how many links a wire is. Units of kinds that stand equally
/// often are linked in pairs, by their numbers; a unit that stands once has a port for each of the others; a
/// core has a port for each partition and a partition one for each core, and so have geometry front ends and
/// cores, and front ends and raster engines. Clients of the L2 cache have a port
/// for each slice.
#pragma once

#include "pipeline/machine/machine.h"

namespace quadrille::pipeline {

/// Makes the links of a machine whose units are there.
class Machine::Wiring {
 public:
  explicit Wiring(Machine& machine) : m_(machine), l_(machine.config_.link) {}
  void wire();

 private:
  /// The links of unit number `i` of the kinds that stand so often, to each other and to kinds that stand
  /// less often.
  void wire_units(Stands stands, std::size_t i);
  template <class... Wires>
  void wire_class(const LinkParams& of, Stands stands, std::size_t i);
  template <class Wire>
  void wire_one(const LinkParams& of, Stands stands, std::size_t i, bool alone);
  void wire_clients();
  /// Of a link between a geometry front end and unit `i` of another kind.
  [[nodiscard]] std::string front_end_path(const std::string& path, std::size_t front_end, Stands other,
                                           std::size_t i) const;
  /// A link of a class from port to port, called `path`.
  template <class Token>
  void link(hw::FifoOut<Token>& from, hw::FifoIn<Token>& to, const LinkParams& of, const std::string& path);

  Machine& m_;
  const Links& l_;
};

}  // namespace quadrille::pipeline
