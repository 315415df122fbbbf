/// `memory.kind`: the default machine is its own kind's data file, and another kind brings its clock and its
/// numbers.
#include "pipeline/machine/machine_config.h"

#include "models/base/error.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using pipeline::MachineConfig;

namespace {

std::string text_of(const MachineConfig& config, const std::string& key) {
  const hw::ParamBase* const param = config.find(key);
  return param == nullptr ? "none" : param->value_text();
}

}  // namespace

TEST_CASE("memory kind: the default machine has the values of its kind's data file") {
  const MachineConfig config;
  for (const auto& [key, value] : pipeline::memory_kind_values("gddr6")) {
    INFO(key);
    CHECK(text_of(config, key) == value);
  }
}

TEST_CASE(
    "memory kind: setting it sets the clock and all that its file holds, but for what the same layer sets") {
  for (const std::string kind : {"ddr4", "lpddr5", "gddr6", "hbm2"}) {
    MachineConfig before, after;
    before.begin_layer();
    before.set("memory.t_rcd", "99", "test");
    before.set("memory.kind", kind, "test");
    after.begin_layer();
    after.set("memory.kind", kind, "test");
    after.set("memory.t_rcd", "99", "test");
    for (const auto& [key, value] : pipeline::memory_kind_values(kind)) {
      INFO(kind << ", " << key);
      const std::string expected = key == "memory.t_rcd" ? "99" : value;
      CHECK(text_of(before, key) == expected);
      CHECK(text_of(after, key) == expected);
    }
    // A layer above overrides what lies below it.
    before.begin_layer();
    before.set("memory.kind", kind, "test");
    CHECK(text_of(before, "memory.t_rcd") != "99");
    CHECK_NOTHROW(before.check());
  }
}

TEST_CASE(
    "memory kind: words are in quotes in a machine file, numbers are not, and a kind that is not there is "
    "refused with the list") {
  const auto refusal = [](const char* text) {
    MachineConfig config;
    try {
      pipeline::apply_machine_text(config, text, "m.toml");
    } catch (const UserError& e) { return std::string(e.what()); }
    return std::string("accepted");
  };
  CHECK(refusal("[memory]\nkind = \"hbm2\"\npage = \"closed\"") == "accepted");
  CHECK(refusal("[memory]\nkind = 3") == "m.toml:2: memory.kind: a word in quotes is expected");
  CHECK(refusal("[gpu]\ncores = \"3\"") == "m.toml:2: gpu.cores: a number or true/false is expected");
  CHECK_THAT(refusal("[memory]\nkind = \"ddr9\""), Catch::Contains("ddr4, lpddr5, gddr6, hbm2"));
}

TEST_CASE("memory kind: a geometry that cannot be is refused") {
  for (const auto& [key, value] : {std::pair{"memory.bank_groups", "3"},
                                   {"memory.burst_bytes", "96"},
                                   {"memory.row_bytes", "200"},
                                   {"memory.write_low", "95"}}) {
    INFO(key);
    MachineConfig config;
    config.set(key, value, "test");
    CHECK_THROWS_AS(config.check(), UserError);
  }
}
