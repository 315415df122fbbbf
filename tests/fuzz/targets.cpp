#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>

#include "models/base/error.h"

namespace quadrille::fuzz {
namespace {

constexpr std::array<Target, 6> kTargets{{{"scene", run_scene, mutate_scene},
                                          {"trace", run_trace, mutate_trace},
                                          {"capture", run_capture, mutate_raw},
                                          {"machine", run_machine, mutate_raw},
                                          {"spirv", run_spirv, mutate_spirv},
                                          {"image", run_image, mutate_raw}}};

}  // namespace

std::span<const Target> targets() { return kTargets; }

const Target& target(std::string_view name) {
  const auto* const found = std::ranges::find(kTargets, name, &Target::name);
  if (found == kTargets.end())
    throw user_error("target '{}' is unknown; there are scene, trace, capture, machine, spirv and image",
                     name);
  return *found;
}

Buffer mutate_raw(Bytes bytes, const RawMutation& raw, unsigned /*seed*/) {
  Buffer out(bytes.begin(), bytes.end());
  const std::size_t room = std::max<std::size_t>(64, 2 * bytes.size());
  out.resize(room);
  out.resize(raw(out.data(), bytes.size(), room));
  return out;
}

}  // namespace quadrille::fuzz
