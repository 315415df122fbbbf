#include "tests/hw/base/synthetic_unit.h"

namespace quadrille::hw::world {

SyntheticUnit::SyntheticUnit(sc_core::sc_module_name name, const UnitSpec& spec, const Clock& clock,
                             const std::vector<LinkRole>& input_roles)
    : Unit(name, is_chooser(spec.role) && !spec.declared_fixed ? Kind::kChooser : Kind::kFixedOrder, clock),
      spec_(spec) {
  for (int i = 0; i < spec.inputs; ++i) {
    inputs_.add(*this, fmt::format("in{}", i), input_roles[static_cast<std::size_t>(i)]);
  }
  for (int i = 0; i < spec.outputs; ++i) outputs_.add(*this, fmt::format("out{}", i), LinkRole::kFlow);
}

std::unique_ptr<SyntheticUnit> make_unit(const UnitSpec& s, const Clock& clock,
                                         const std::vector<LinkRole>& roles) {
  return is_chooser(s.role) ? make_chooser(s, clock, roles) : make_fixed_order(s, clock, roles);
}

}  // namespace quadrille::hw::world
