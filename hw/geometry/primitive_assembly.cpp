#include "hw/geometry/primitive_assembly.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

namespace quadrille::hw {

PrimitiveAssembly::PrimitiveAssembly(sc_core::sc_module_name name, const UnitContext& context,
                                     const Params& params, const Store<BatchSlot>& batches)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      batches_(batches),
      shaded_(static_cast<std::size_t>(batches.size()), false),
      rate_(context.clock) {
  add_initiation_rate("rate");
  for (int i = 0; i < context.machine.cores; ++i) done_in.add(*this, fmt::format("done_in_{}", i).c_str());
}

std::string PrimitiveAssembly::state_text() const {
  return fmt::format("triangle {} of the batch at its head", next_triangle_);
}

Wake PrimitiveAssembly::emit_wake() const {
  Wake wake = Wake(free_).input(batch_in);
  if (batch_in.ready() == kNever) return wake;
  const BatchToken& head = batch_in.front();
  if (head.kind == TokenKind::kWork && batches_[head.slot].lanes > 0 && !shaded_[head.slot])
    return Wake::never(done_in[0]);
  return wake.output(primitive_out);
}

Wake PrimitiveAssembly::next() const {
  return Wake::sooner(emit_wake(), done_in.earliest(Wake().output(load_out)));
}

void PrimitiveAssembly::act(Tick now) {
  done_in.visit_holding(0, [&](std::size_t core, FifoIn<VertexDoneToken>& in) {
    for (; in.ready_at(now) && load_out.room_at(now);
         load_out.push(now, {static_cast<std::uint32_t>(core), 0}))
      shaded_[in.pop(now).slot] = true;
    return false;
  });
  if (emit_wake().at() <= now) emit(now);
}

void PrimitiveAssembly::emit(Tick now) {
  const BatchToken head = batch_in.front();
  if (next_triangle_ == 0) stats_.working_for(head.part.draw());
  free_ = rate_.charge(now, WorkRate::cost(params_.triangles_per_clk));
  occupy(now, rate_.cycles());
  if (head.kind != TokenKind::kWork) {
    primitive_out.push(now, {head.kind, head.part, 0, 0, {}});
    (void)batch_in.pop(now);
    return;
  }
  const BatchSlot& batch = batches_[head.slot];
  if (next_triangle_ < batch.triangles.size()) {
    const BatchSlot::Triangle& t = batch.triangles[next_triangle_++];
    primitive_out.push(
        now, {TokenKind::kWork, head.part, head.slot, t.primitive, {t.corner[0], t.corner[1], t.corner[2]}});
    ++stats_.triangles;
    return;
  }
  primitive_out.push(
      now, {batch.ends_range ? TokenKind::kRangeEnd : TokenKind::kBatchEnd, head.part, head.slot, 0, {}});
  ++stats_.batches;
  stats_.vertices += static_cast<std::uint64_t>(batch.lanes);
  shaded_[head.slot] = false;
  next_triangle_ = 0;
  (void)batch_in.pop(now);
}

void PrimitiveAssembly::audit(Audit& audit) const {
  audit.right(laws::kVerticesShaded, stats_.vertices.value());
  audit.right(laws::kTrianglesFetched, stats_.triangles.value());
  audit.left(laws::kTrianglesAssembled, stats_.triangles.value());
}

void PrimitiveAssembly::details(Details& details) const {
  details.by_draw(DrawCount::kTrianglesIn, stats_.triangles);
  details.by_draw(DrawCount::kVerticesAssembled, stats_.vertices);
}

std::vector<Facet> PrimitiveAssembly::row() const {
  return {count("triangles", stats_.triangles), mean("vertices/batch", stats_.vertices, stats_.batches),
          mean("triangles/batch", stats_.triangles, stats_.batches)};
}

}  // namespace quadrille::hw
