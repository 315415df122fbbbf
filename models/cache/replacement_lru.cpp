/// The least recently used line, exactly.
#include "models/cache/replacement_stamps.h"

namespace quadrille::models {
namespace {

class LruReplacement final : public StampReplacement {
 public:
  using StampReplacement::StampReplacement;
  void used(std::uint32_t slot) override { stamp(slot); }
};

}  // namespace

constinit const ReplacementPolicy kLruReplacement{
    "lru", "the line that was used longest ago: the order of all ways is kept",
    [](std::uint32_t sets, std::uint32_t ways) -> std::unique_ptr<Replacement> {
      return std::make_unique<LruReplacement>(sets, ways);
    }};

}  // namespace quadrille::models
