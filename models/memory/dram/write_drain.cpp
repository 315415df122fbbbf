#include "models/memory/dram/write_drain.h"

namespace quadrille::models {

void DramWriteDrain::update(const DramQueue& queue) {
  const int reads = queue.count(false), writes = queue.count(true);
  if (draining_) draining_ = writes > 0 && (writes > low_ || reads == 0);
  else draining_ = writes >= high_ || (reads == 0 && writes > 0);
}

}  // namespace quadrille::models
