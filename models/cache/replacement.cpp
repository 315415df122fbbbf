/// The policies of replacement. A new one is its file and its name here.
#include "models/cache/replacement.h"

namespace quadrille::models {

PolicyList<ReplacementPolicy>& replacement_policies() {
  static PolicyList<ReplacementPolicy> all{&kLruReplacement, &kTreeReplacement, &kFifoReplacement,
                                           &kRandomReplacement, &kSrripReplacement};
  return all;
}

}  // namespace quadrille::models
