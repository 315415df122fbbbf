/// The policies of the memory's units. A new one is its file and its name here.
#include "hw/memory/write_back.h"

namespace quadrille::hw {

PolicyList<WriteBackPolicy>& write_back_policies() {
  static PolicyList<WriteBackPolicy> all{&kVictimWriteBack, &kRowWriteBack};
  return all;
}

}  // namespace quadrille::hw
