/// The line that came first, however often it was used.
#include "models/cache/replacement_stamps.h"

namespace quadrille::models {
namespace {

class FifoReplacement final : public StampReplacement {
 public:
  using StampReplacement::StampReplacement;
  void used(std::uint32_t /*slot*/) override {}
};

}  // namespace

constinit const ReplacementPolicy kFifoReplacement{
    "fifo", "the line that came first: a counter a set, and nothing to do at a hit",
    [](std::uint32_t sets, std::uint32_t ways) -> std::unique_ptr<Replacement> {
      return std::make_unique<FifoReplacement>(sets, ways);
    }};

}  // namespace quadrille::models
