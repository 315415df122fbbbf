/// libFuzzer's entry points for one target, which the build names. See scripts/fuzz.
#include <algorithm>
#include <cstring>

#include "tests/fuzz/targets.h"

extern "C" {

std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

/// SystemC's library refers to it; nothing here simulates.
int sc_main(int, char**) { return 0; }

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  quadrille::fuzz::target(QUADRILLE_FUZZ_TARGET).run(std::as_bytes(std::span(data, size)));
  return 0;
}

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                    unsigned seed) {
  const auto raw = [](std::byte* bytes, std::size_t used, std::size_t room) {
    return LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes), used, room);
  };
  const quadrille::fuzz::Buffer out =
      quadrille::fuzz::target(QUADRILLE_FUZZ_TARGET).mutate(std::as_bytes(std::span(data, size)), raw, seed);
  const std::size_t kept = std::min(out.size(), max_size);
  std::memcpy(data, out.data(), kept);
  return kept;
}
}
