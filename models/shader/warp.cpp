/// A warp's launch and the return of its texture results.
#include "models/shader/warp.h"

#include "models/base/error.h"
#include "models/shader/decode.h"
#include "models/shader/lanes.h"

#include <algorithm>

namespace quadrille::models {

void Warp::launch(const Program& p, const std::uint32_t* constant_file, LaneMask lanes) {
  if (p.decoded.get() == nullptr) prepare(p);
  program = &p;
  code = p.decoded.get();
  QUADRILLE_CHECK(code->code.size() == p.code.size(), "program '{}' changed after it was prepared", p.name);
  QUADRILLE_CHECK(p.constants.words == 0 || constant_file != nullptr, "program '{}' has no constant file",
                  p.name);
  QUADRILLE_CHECK(p.buffers.empty() || storage != nullptr, "program '{}' has no storage", p.name);
  QUADRILLE_CHECK(code->partial_outputs.empty() || outputs != nullptr, "program '{}' has no outputs", p.name);
  constants = constant_file;
  launched = exec = lanes;
  killed = 0;
  pc = 0;
  control_depth = 0;
  texture_count = access_count = 0;
  back_edges = 0;
  instructions = 0;
  regs.resize(static_cast<std::size_t>(p.num_regs));
  std::fill(regs.begin(), regs.end(), RegisterRow{});
  for (const std::uint16_t slot : code->partial_outputs) outputs[slot].fill(0);
}

void write_texture_result(Warp& warp, const TextureRequest& request, const std::array<LaneFloats, 4>& rgba) {
  for (int g = 0; g < kWarpGroups; ++g) {
    const Words active = expand_mask(request.active, g);
    for (std::size_t component = 0; component < rgba.size(); ++component) {
      std::uint32_t* at = warp.regs[request.dst + component].data() + g * kGroupLanes;
      store(at, choose(active, load_floats(rgba[component].data() + g * kGroupLanes), load_words(at)));
    }
  }
}

}  // namespace quadrille::models
