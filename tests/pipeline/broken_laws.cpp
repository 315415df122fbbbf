#include "tests/pipeline/broken_laws.h"

#include "pipeline/report/detail_log.h"
#include "pipeline/report/figures.h"
#include "tests/hw/contract.h"
#include "tests/pipeline/random_stream.h"

#include <optional>

namespace quadrille::pipeline::test {

std::string broken_laws(const std::function<void(const Machine&)>& inject, DetailOptions detail) {
  return hw::contract::in_child([&] {
    const traces::CommandStream stream = random_stream(5);
    MachineConfig config;
    DeviceFrame frame(std::uint64_t{1} << 30);
    build_frame(stream, config.precision(), frame);
    Machine machine(config, frame, {});
    std::optional<DetailLog> log;
    if (detail.any()) log.emplace(machine, frame, detail);
    inject(machine);
    machine.run({});
    std::string lines;
    for (const Check& c :
         collect_figures(machine, frame, log ? std::optional(log->collect()) : std::nullopt).checks) {
      if (!c.holds()) lines += c.law + "\n";
    }
    return lines;
  });
}

}  // namespace quadrille::pipeline::test
