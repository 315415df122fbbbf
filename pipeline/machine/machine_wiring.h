/// Who is linked to whom.
#pragma once

#include "pipeline/machine/machine.h"

namespace quadrille::pipeline {

/// Makes the links of a machine whose units are there.
class Machine::Wiring {
 public:
  explicit Wiring(Machine& machine) : m_(machine), l_(machine.config_.link) {}
  void wire();

 private:
  void geometry();
  void partition(std::size_t p);
  void core(std::size_t c);
  void memory();
  void client(const hw::Unit& unit, hw::MemoryPort& port);
  /// A link of a class from port to port; its path is the class's name unless another is given.
  template <class Token>
  void link(hw::FifoOut<Token>& from, hw::FifoIn<Token>& to, const LinkParams& of, const std::string& path,
            int path_clk = 0);
  template <class Token>
  void link(hw::FifoOut<Token>& from, hw::FifoIn<Token>& to, const LinkParams& of) {
    link(from, to, of, std::string(of.name));
  }
  template <class Token>
  void link(hw::FifoOut<Token>& from, hw::FifoIn<Token>& to, const LinkParams& of, std::size_t number) {
    link(from, to, of, fmt::format("{}_{}", of.name, number));
  }

  Machine& m_;
  const Links& l_;
};

}  // namespace quadrille::pipeline
