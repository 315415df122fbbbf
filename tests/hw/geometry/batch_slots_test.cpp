/// Slots of vertex batches: kept while a triangle on its way or the reuse needs them, and no longer.
#include "hw/geometry/batch_slots.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;

TEST_CASE(
    "batch_slots: a slot is free again when its batch is released, and when the last batch that names it "
    "is") {
  BatchSlots slots(0, 3);
  const std::unique_ptr<models::VertexReuse> made = models::kBatchReuse.make({});
  const models::VertexReuse& reuse = *made;
  const std::uint32_t first = slots.take(), second = slots.take();
  slots.note_use(first);  // the second batch names a vertex of the first
  (void)slots.take();
  CHECK_FALSE(slots.any_free());
  slots.release();
  slots.sweep(reuse);
  CHECK_FALSE(slots.any_free());
  slots.release();
  slots.sweep(reuse);
  CHECK(slots.free() == 2);
  slots.release();
  slots.sweep(reuse);
  CHECK(slots.free() == 3);
  CHECK(second != first);
}

TEST_CASE("batch_slots: a slot is kept while its vertices may be named again") {
  BatchSlots slots(0, 2);
  const std::unique_ptr<models::VertexReuse> made = models::kFifoReuse.make({32, 4});
  models::VertexReuse& reuse = *made;
  reuse.start_batch(slots.take());
  for (const std::uint32_t v : {0u, 1u, 2u}) (void)reuse.place(v);
  slots.release();
  slots.sweep(reuse);
  CHECK(slots.free() == 1);
  reuse.limit_slots(0);
  slots.sweep(reuse);
  CHECK(slots.free() == 2);
}
