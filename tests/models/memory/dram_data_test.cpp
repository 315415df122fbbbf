/// The data files of the DRAM standards (configs/memory) against the checker's own table of the same
/// standards.
#include "tests/models/memory/dram_numbers.h"

#include <toml++/toml.h>
#include <catch2/catch.hpp>

using namespace quadrille::models;

namespace {

toml::table memory_of(const std::string& standard) {
  const toml::table file =
      toml::parse_file(std::string(QUADRILLE_SOURCE_DIR) + "/configs/memory/" + standard + ".toml");
  REQUIRE(file["memory"].is_table());
  return *file["memory"].as_table();
}

const char* name_of(DramRefreshKind kind) {
  switch (kind) {
    case DramRefreshKind::kNone: return "none";
    case DramRefreshKind::kAllBank: return "all_bank";
    case DramRefreshKind::kPerBank: return "per_bank";
  }
  return "";
}

}  // namespace

TEST_CASE("dram data: every number of a file is that of the table typed in from the sources") {
  for (const std::string& standard : dram_standards()) {
    const toml::table memory = memory_of(standard);
    const DramNumbers numbers = dram_numbers(standard);
    for (const DramNumberName& number : dram_number_names()) {
      INFO(standard << ": " << number.name);
      CHECK(memory[number.name].value<int>() == numbers.*number.member);
    }
    INFO(standard);
    CHECK(memory["refresh"].value<std::string>() == name_of(numbers.refresh));
    CHECK(memory["separate_buses"].value<bool>() == numbers.separate_buses);
    CHECK(memory["shared_commands"].value<bool>() == numbers.shared_commands);
    CHECK(memory.size() == dram_number_names().size() + 3);
  }
}

TEST_CASE("dram data: the peak of each standard is that of its pins") {
  struct Peak {
    const char* standard;
    int pins;             // of all pseudo-channels
    int megabits;         // a second and pin
    int bytes_per_cycle;  // of the command clock
  };
  for (const Peak& p : {Peak{"ddr4", 64, 3200, 16}, Peak{"lpddr5", 32, 6400, 32}, Peak{"gddr6", 32, 8000, 32},
                        Peak{"hbm2", 128, 2000, 32}}) {
    INFO(p.standard);
    const DramNumbers n = dram_numbers(p.standard);
    CHECK(n.pseudo_channels * n.burst_bytes == p.bytes_per_cycle * n.t_burst);
    CHECK(p.pins / 8 * p.megabits == p.bytes_per_cycle * n.clock_mhz);
  }
}

TEST_CASE("dram data: capacities are those of the devices") {
  const auto mebibytes = [](const char* standard) {
    const DramNumbers n = dram_numbers(standard);
    return (static_cast<std::int64_t>(n.rows) * n.row_bytes * n.banks * n.ranks) >> 20;
  };
  CHECK(mebibytes("ddr4") == 2 * 8 * 1024);  // two ranks of eight devices of 8 Gb
  CHECK(mebibytes("lpddr5") == 1024);
  CHECK(mebibytes("gddr6") == 1024);
  CHECK(mebibytes("hbm2") == 256);
}
