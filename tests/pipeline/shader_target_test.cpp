/// What the driver tells the shader compiler of the machine.
#include "pipeline/compiler/target.h"
#include "pipeline/machine/machine_config.h"

#include <catch2/catch.hpp>

namespace quadrille::pipeline {

TEST_CASE("shader target: the compiler's default is the default machine's core") {
  const ShaderTarget ours, machine = MachineConfig().shader_target();
  CHECK(ours.warp_slots == machine.warp_slots);
  CHECK(ours.register_rows == machine.register_rows);
  CHECK(ours.timing.classes == machine.timing.classes);
}

TEST_CASE("shader target: a core's parameters reach the compiler") {
  MachineConfig machine;
  machine.set("core.warp_slots", "48", "test");
  machine.set("core.register_rows", "4096", "test");
  machine.set("core.simd_lanes", "16", "test");
  machine.set("core.alu_clk", "5", "test");
  const ShaderTarget target = machine.shader_target();
  CHECK(target.warp_slots == 48);
  CHECK(target.register_rows == 4096);
  CHECK(target.timing.of(models::Op::kFAdd) == models::IssueTiming::Class{2, 5});
}

}  // namespace quadrille::pipeline
