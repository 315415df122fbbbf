/// The policies of the memory controller. A new one is its file and its name here.
#include "models/memory/dram/mapping.h"
#include "models/memory/dram/page_policy.h"
#include "models/memory/dram/scheduler.h"
#include "models/memory/dram/write_drain.h"

namespace quadrille::models {

PolicyList<DramSchedulerPolicy>& dram_schedulers() {
  static PolicyList<DramSchedulerPolicy> all{&kInOrderScheduler, &kFirstReadyScheduler};
  return all;
}

PolicyList<DramWriteDrainPolicy>& dram_write_drains() {
  static PolicyList<DramWriteDrainPolicy> all{&kNoWriteDrain, &kWatermarkWriteDrain};
  return all;
}

PolicyList<DramPagePolicyEntry>& dram_page_policies() {
  static PolicyList<DramPagePolicyEntry> all{&kOpenPages, &kClosedPages, &kAdaptivePages};
  return all;
}

PolicyList<DramMappingPolicy>& dram_mappings() {
  static PolicyList<DramMappingPolicy> all{&kGroupMapping, &kRowMapping};
  return all;
}

}  // namespace quadrille::models
