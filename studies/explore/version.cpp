#include "studies/explore/version.h"

#include <xxhash.h>

#include <cstdint>

#include <fmt/format.h>

#include "traces/whole_file.h"

namespace quadrille::studies::explore {

std::string program_version(const std::string& release) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 30;
  const std::vector<std::byte> program = traces::read_whole_file("/proc/self/exe", kMostBytes);
  return fmt::format("quadrille {} build {:016x}", release, XXH3_64bits(program.data(), program.size()));
}

}  // namespace quadrille::studies::explore
