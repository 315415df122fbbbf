/// A machine with a fault on a wire, and the laws that notice it.
#pragma once

#include "pipeline/machine/machine.h"
#include "pipeline/report/detail.h"

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace quadrille::pipeline::test {

/// The link of that name.
template <class T>
hw::Fifo<T>& link(const Machine& machine, std::string_view name) {
  for (const auto& l : machine.links()) {
    if (static_cast<const sc_core::sc_object&>(*l).basename() == name) return dynamic_cast<hw::Fifo<T>&>(*l);
  }
  throw std::runtime_error("no such link");
}

/// Runs a random frame on the default machine with a fault, in a process of its own; gives the broken laws,
/// one a line.
[[nodiscard]] std::string broken_laws(const std::function<void(const Machine&)>& inject,
                                      DetailOptions detail = {});

}  // namespace quadrille::pipeline::test
