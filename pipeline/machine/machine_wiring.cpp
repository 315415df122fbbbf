#include "pipeline/machine/machine_wiring.h"

#include <algorithm>
#include <map>

namespace quadrille::pipeline {

namespace {

// The port for unit number `i` of the kind at the other end; a port that stands alone is there for any.
template <class T>
hw::FifoOut<T>& port_for(hw::FifoOut<T>& port, std::size_t /*i*/) {
  return port;
}
template <class T>
hw::FifoIn<T>& port_for(hw::FifoIn<T>& port, std::size_t /*i*/) {
  return port;
}
template <class Port>
Port& port_for(const std::unique_ptr<Port>& port, std::size_t /*i*/) {
  return *port;
}
template <class Port>
Port& port_for(const std::vector<std::unique_ptr<Port>>& group, std::size_t i) {
  return *group[i];
}
template <class T>
hw::FifoIn<T>& port_for(const hw::FifoInGroup<T>& group, std::size_t i) {
  return group[i];
}
/// The port for a kind of unit whose ports are the last ones of the group, behind those for kinds that stand
/// more often: the `from_end`-th from its end, 1 the last.
template <class Port>
auto& port_from_end(Port& port, std::size_t from_end) {
  if constexpr (std::is_base_of_v<hw::PortBase, Port>) return port_for(port, 0);
  else return port_for(port, port.size() - from_end);
}

/// "vertex" of the input "vertex_in".
std::string_view flow_of(const hw::PortBase& input) {
  std::string_view name = input.name();
  if (name.ends_with("_in")) name.remove_suffix(3);
  return name;
}

}  // namespace

template <class Token>
void Machine::Wiring::link(hw::FifoOut<Token>& from, hw::FifoIn<Token>& to, const LinkParams& of,
                           const std::string& path) {
  hw::LinkSpec spec = of.spec();
  if (&of == &l_.memory_to_l2) {
    // A longer way holds as many tokens more as are on it.
    const int path_clk = m_.config_.memory.path_clk;
    spec.latency += path_clk;
    spec.depth += spec.width * path_clk;
  }
  auto made = std::make_unique<hw::Fifo<Token>>(path.c_str(), spec);
  from.bind(*made);
  to.bind(*made);
  m_.links_.push_back(std::move(made));
  m_.link_keys_.push_back(fmt::format("link.{}", of.name));
}

std::string Machine::Wiring::front_end_path(const std::string& path, std::size_t front_end, Stands other,
                                            std::size_t i) const {
  return m_.name_of(m_.name_of(path, other, static_cast<int>(i)), Stands::kFrontEnd,
                    static_cast<int>(front_end));
}

void Machine::Wiring::wire() {
  const auto wire_all = [this](Stands stands) {
    for (int i = 0; i < m_.count(stands); ++i) wire_units(stands, static_cast<std::size_t>(i));
  };
  wire_all(Stands::kOnce);
  wire_all(Stands::kFrontEnd);
  wire_all(Stands::kEngine);
  wire_all(Stands::kPartition);
  wire_all(Stands::kCore);
  wire_clients();
  wire_all(Stands::kChannel);
}

void Machine::Wiring::wire_units(Stands stands, std::size_t i) {
#define QUADRILLE_LINK(name, depth, width, latency, flow, way, ...) \
  wire_class<__VA_ARGS__>(l_.name, stands, i);
  QUADRILLE_LINKS(QUADRILLE_LINK)
#undef QUADRILLE_LINK
}

template <class... Wires>
void Machine::Wiring::wire_class(const LinkParams& of, Stands stands, std::size_t i) {
  (wire_one<Wires>(of, stands, i, sizeof...(Wires) == 1), ...);
}

template <class Wire>
void Machine::Wiring::wire_one(const LinkParams& of, Stands stands, std::size_t i, bool alone) {
  using From = typename Wire::From;
  using To = typename Wire::To;
  if constexpr (!std::is_same_v<From, hw::MemoryPort> && !std::is_same_v<To, hw::MemoryPort>) {
    constexpr Stands kFrom = UnitKind<From>::stands, kTo = UnitKind<To>::stands;
    if (stands != std::max(kFrom, kTo) || m_.all<From>().empty() || m_.all<To>().empty()) return;
    // A class of several wires names each of them for its input.
    const auto path = [&](const hw::PortBase& input) {
      return alone ? std::string(of.name) : fmt::format("{}_{}", of.name, flow_of(input));
    };
    if constexpr (kFrom == Stands::kOnce && kTo == Stands::kOnce) {
      auto& input = port_from_end(m_.one<To>().*Wire::input, 1);
      link(port_from_end(m_.one<From>().*Wire::output, 1), input, of, path(input));
    } else if constexpr (kFrom == Stands::kCore && kTo == Stands::kPartition) {
      for (std::size_t p = 0; p < m_.all<To>().size(); ++p) {
        auto& input = port_for(m_.all<To>()[p]->*Wire::input, i);
        link(port_for(m_.all<From>()[i]->*Wire::output, p), input, of,
             fmt::format("{}_{}_{}", path(input), i, p));
      }
    } else if constexpr (kFrom == Stands::kFrontEnd && kTo != Stands::kFrontEnd && kTo != Stands::kOnce) {
      for (std::size_t f = 0; f < m_.all<From>().size(); ++f) {
        auto& input = port_for(m_.all<To>()[i]->*Wire::input, f);
        link(port_for(m_.all<From>()[f]->*Wire::output, i), input, of,
             front_end_path(path(input), f, kTo, i));
      }
    } else if constexpr (kTo == Stands::kFrontEnd && kFrom != Stands::kFrontEnd && kFrom != Stands::kOnce) {
      for (std::size_t f = 0; f < m_.all<To>().size(); ++f) {
        auto& input = port_for(m_.all<To>()[f]->*Wire::input, i);
        link(port_for(m_.all<From>()[i]->*Wire::output, f), input, of,
             front_end_path(path(input), f, kFrom, i));
      }
    } else if constexpr (kFrom == Stands::kFrontEnd && kTo == Stands::kOnce) {
      // Of a group, front ends have the last ports, behind kinds that stand more often.
      auto& input = port_from_end(m_.one<To>().*Wire::input, m_.all<From>().size() - i);
      link(port_for(m_.all<From>()[i]->*Wire::output, 0), input, of,
           m_.name_of(path(input), stands, static_cast<int>(i)));
    } else if constexpr (kFrom == Stands::kEngine && kTo == Stands::kPartition) {
      const std::size_t engines = m_.all<From>().size();
      auto& input = port_for(m_.all<To>()[i]->*Wire::input, 0);
      link(port_for(m_.all<From>()[i % engines]->*Wire::output, i / engines), input, of,
           fmt::format("{}_{}", path(input), i));
    } else if constexpr (kFrom == Stands::kPartition && kTo == Stands::kEngine) {
      const std::size_t engines = m_.all<To>().size();
      auto& input = port_for(m_.all<To>()[i % engines]->*Wire::input, i / engines);
      link(port_for(m_.all<From>()[i]->*Wire::output, 0), input, of, fmt::format("{}_{}", path(input), i));
    } else {
      static_assert(kFrom == kTo || kFrom == Stands::kOnce || kTo == Stands::kOnce);
      const std::size_t from = kFrom == Stands::kOnce ? 0 : i, to = kTo == Stands::kOnce ? 0 : i;
      auto& input = port_for(m_.all<To>()[to]->*Wire::input, i);
      link(port_for(m_.all<From>()[from]->*Wire::output, i), input, of,
           m_.name_of(path(input), stands, static_cast<int>(i)));
    }
  }
}

void Machine::Wiring::wire_clients() {
  std::map<std::string_view, hw::MemoryPort*> ports;
  visit_unit_kinds([&]<class Unit>() {
    if constexpr (MemoryClientUnit<Unit>)
      for (Unit* unit : m_.all<Unit>()) ports[unit->name()] = &unit->memory_port();
  });
  const std::vector<hw::L2Slice*>& slices = m_.all<hw::L2Slice>();
  for (std::size_t c = 0; c < m_.clients_.size(); ++c) {
    const std::string& name = m_.clients_[c].name;
    hw::MemoryPort& port = *ports.at(name);
    for (std::size_t i = 0; i < slices.size(); ++i) {
      link(*port.request_out[i], slices[i]->request_in[c], l_.client_to_l2,
           fmt::format("{}_to_l2_{}", name, i));
      link(*slices[i]->response_out[c], port.response_in[i], l_.l2_to_client,
           fmt::format("l2_{}_to_{}", i, name));
    }
  }
}

}  // namespace quadrille::pipeline
