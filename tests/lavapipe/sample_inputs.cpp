#include "tests/lavapipe/sample_inputs.h"

#include <spirv/unified1/spirv.hpp>

#include <set>

namespace quadrille::lavapipe {
namespace {

constexpr std::size_t kHeaderWords = 5;

/// Calls `visit(first word, operation, words)` for each instruction.
template <class Visit>
void visit_instructions(std::span<const std::uint32_t> spirv, const Visit& visit) {
  for (std::size_t at = kHeaderWords; at < spirv.size() && (spirv[at] >> 16) != 0; at += spirv[at] >> 16)
    visit(at, spirv[at] & 0xffffu, spirv.subspan(at, spirv[at] >> 16));
}

}  // namespace

std::vector<std::uint32_t> with_sample_inputs(std::span<const std::uint32_t> spirv) {
  std::set<std::uint32_t> inputs, located, flat;
  std::size_t first_decoration = 0;
  visit_instructions(spirv, [&](std::size_t at, std::uint32_t op, std::span<const std::uint32_t> words) {
    if (op == spv::OpVariable && words[3] == spv::StorageClassInput) inputs.insert(words[2]);
    if (op != spv::OpDecorate) return;
    if (first_decoration == 0) first_decoration = at;
    if (words[2] == spv::DecorationLocation) located.insert(words[1]);
    if (words[2] == spv::DecorationFlat) flat.insert(words[1]);
  });
  std::vector<std::uint32_t> out(spirv.begin(), spirv.begin() + kHeaderWords);
  out.insert(out.end(), {2u << 16 | spv::OpCapability, spv::CapabilitySampleRateShading});
  out.insert(out.end(), spirv.begin() + kHeaderWords,
             spirv.begin() + static_cast<std::ptrdiff_t>(first_decoration));
  for (const std::uint32_t id : inputs)
    if (located.contains(id) && !flat.contains(id))
      out.insert(out.end(), {3u << 16 | spv::OpDecorate, id, spv::DecorationSample});
  out.insert(out.end(), spirv.begin() + static_cast<std::ptrdiff_t>(first_decoration), spirv.end());
  return first_decoration == 0 ? std::vector(spirv.begin(), spirv.end()) : out;
}

}  // namespace quadrille::lavapipe
