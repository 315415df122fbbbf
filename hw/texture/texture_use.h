/// What the requests of a texture unit asked of each texture of the frame: how many lanes, with which filter,
/// at which level, along how many samples, and what that took of the cache and of the L2 cache. Kept only
/// where it is asked for; no cycle depends on it.
#pragma once

#include "models/base/sampler.h"
#include "models/texture/sample.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::hw {

struct TextureUse {
  std::uint64_t requests = 0, lanes = 0, texels = 0;
  /// Lanes that read one texel of a level, and 2x2 of it. Together with those that only ask for a level of
  /// detail they are all lanes.
  std::uint64_t nearest = 0, linear = 0;
  std::uint64_t two_levels = 0;       ///< lanes whose texels are of two levels
  std::uint64_t several_samples = 0;  ///< lanes with more than one sample along an axis
  std::array<std::uint64_t, models::kMaxTextureLevels>
      levels{};                            ///< lanes, by the finer level that they read
  std::uint64_t look_ups = 0, misses = 0;  ///< of lines in the first-level cache
  std::uint64_t read_bytes = 0;            ///< asked of the L2 cache
  void add(const TextureUse& other);
};

class TextureUseLog {
 public:
  explicit TextureUseLog(std::size_t textures) : by_texture_(textures) {}
  /// A request was planned.
  void note(std::uint32_t texture, const models::SamplerState& sampler, const models::TexturePlan& plan);
  /// A look-up of a line got through, which read so many bytes.
  void note_look_up(std::uint32_t texture, bool missed, std::uint64_t read_bytes) {
    TextureUse& use = by_texture_[texture];
    ++use.look_ups;
    use.misses += missed ? 1 : 0;
    use.read_bytes += read_bytes;
  }
  [[nodiscard]] const std::vector<TextureUse>& by_texture() const { return by_texture_; }

 private:
  std::vector<TextureUse> by_texture_;
};

}  // namespace quadrille::hw
