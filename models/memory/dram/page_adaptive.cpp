/// Adaptive pages: a row closes when nobody asked for it for `idle` cycles.
#include "models/memory/dram/page_policy.h"

namespace quadrille::models {

namespace {

class AdaptivePages final : public DramPagePolicy {
 public:
  explicit AdaptivePages(std::int64_t idle) : idle_(idle) {}
  [[nodiscard]] bool times() const override { return true; }
  [[nodiscard]] std::int64_t closes_at(std::int64_t used) const override { return used + idle_; }

 private:
  std::int64_t idle_;
};

}  // namespace

constinit const DramPagePolicyEntry kAdaptivePages{
    "adaptive", "a row closes after page_idle cycles without use: between open and closed",
    [](const DramPageSetup& setup) -> std::unique_ptr<DramPagePolicy> {
      return std::make_unique<AdaptivePages>(setup.idle);
    }};

}  // namespace quadrille::models
