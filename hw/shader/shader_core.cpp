#include "hw/shader/shader_core.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include <algorithm>

namespace quadrille::hw {

namespace {

int hungriest_fragment_program(const Frame& frame) {
  int rows = 0;
  for (const DrawState& draw : frame.draws) rows = std::max(rows, draw.fragment.program->num_regs);
  return rows;
}

Simd::Cycle first_end(const std::vector<Simd>& simds) {
  Simd::Cycle first = Simd::kNever;
  for (const Simd& simd : simds) first = std::min(first, simd.next_end());
  return first;
}

}  // namespace

models::IssueTiming ShaderCore::issue_timing(const Params& params) {
  const auto cycles = [](int lanes) {
    return static_cast<std::uint32_t>((models::kWarpLanes + lanes - 1) / lanes);
  };
  const std::uint32_t plain = cycles(params.simd_lanes);
  models::IssueTiming timing;
  const auto set = [&](models::IssueClass issue_class, std::uint32_t issue, int latency) {
    timing.classes[static_cast<std::size_t>(issue_class)] = {issue, static_cast<std::uint32_t>(latency)};
  };
  set(models::IssueClass::kAlu, plain, params.alu_clk);
  set(models::IssueClass::kSfu, cycles(params.sfu_lanes), params.sfu_clk);
  set(models::IssueClass::kInterp, plain, params.interp_clk);
  set(models::IssueClass::kConst, plain, params.const_clk);
  set(models::IssueClass::kTex, plain, params.alu_clk);
  set(models::IssueClass::kControl, 1, params.branch_clk);
  set(models::IssueClass::kExport, plain, params.alu_clk);
  set(models::IssueClass::kStorage, plain, params.alu_clk);
  return timing;
}

ShaderCore::ShaderCore(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                       const Stores& stores, const Neighbours& neighbours)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      slots_(stores.slots),
      batches_(stores.batches),
      batches_of_front_end_(stores.batches.size() / static_cast<std::uint64_t>(context.machine.front_ends)),
      warps_(stores.warps),
      triangles_(stores.triangles),
      fragment_rows_(hungriest_fragment_program(context.frame)),
      free_rows_(params.register_rows),
      issue_timing_(issue_timing(params)),
      simd_warps_(static_cast<std::size_t>(params.simds.value()), 0) {
  for (int s = 0; s < params.simds; ++s) simds_.emplace_back(params.scheduler.value());
  add_rate_until("issue", [this](Tick at) {
    double issued = 0;
    for (const Simd& simd : simds_) issued += simd.issued(this->clock().edges_before(at));
    return issued / params_.simds;
  });
  add_rate("export", [this] {
    return static_cast<double>(stats_.exported_bytes.value()) / params_.export_bytes_per_clk;
  });
  add_places("warp_slots", [this] { return kept_out(true); });
  add_places("register_rows", [this] { return kept_out(false); });
  for (int f = 0; f < context.machine.front_ends; ++f) {
    const std::string port = context.front_end_port("vertex_out", f);
    vertex_out.push_back(
        std::make_unique<FifoOut<VertexDoneToken>>(*this, port.c_str(), LinkRole::kFlow, kVertexStream));
  }
  for (std::size_t p = 0; p < warps_.size(); ++p) {
    fragment_out.push_back(std::make_unique<FifoOut<FragmentDoneToken>>(
        *this, fmt::format("fragment_out_{}", p).c_str(), LinkRole::kFlow, kFragmentStream));
  }
  if (neighbours.texture) {
    texture_out = std::make_unique<FifoOut<TextureToken>>(*this, "texture_out");
    texture_in = std::make_unique<FifoIn<TextureToken>>(*this, "texture_in", LinkRole::kReply);
  }
  if (neighbours.load_store) {
    storage_out = std::make_unique<FifoOut<StorageToken>>(*this, "storage_out");
    storage_in = std::make_unique<FifoIn<StorageToken>>(*this, "storage_in", LinkRole::kReply);
  }
  for (std::uint64_t i = stores.slots.size(); i-- > 0;) free_slots_.push_back(static_cast<std::uint32_t>(i));
}

std::string ShaderCore::state_text() const {
  return fmt::format("{} of {} warp slots, {} of {} register rows in use, {} warps ready",
                     slots_.size() - free_slots_.size(), slots_.size(), params_.register_rows - free_rows_,
                     params_.register_rows.value(), ready_.size());
}

bool ShaderCore::fits(const models::Program& program, int kept_rows, int kept_slots) const {
  return static_cast<int>(free_slots_.size()) > kept_slots && free_rows_ >= program.num_regs + kept_rows;
}

// What a vertex warp leaves free is enough for one fragment warp, so fragments always drain.
bool ShaderCore::vertex_fits() const {
  return fits(*frame_.draw(vertex_in.front().draw).vertex.program, fragment_rows_, 1);
}

bool ShaderCore::fragment_fits() const {
  return fits(*frame_.draw(fragment_in.front().draw).fragment.program, 0, 0);
}

bool ShaderCore::kept_out(bool by_slots) const {
  const auto out = [&](int kept_slots) {
    return (static_cast<int>(free_slots_.size()) <= kept_slots) == by_slots;
  };
  return (fragment_in.ready() != kNever && !fragment_fits() && out(0)) ||
         (vertex_in.ready() != kNever && !vertex_fits() && out(1));
}

Wake ShaderCore::vertex_wake() const {
  const Wake wake = Wake(accept_free_).input(vertex_in);
  return vertex_in.ready() == kNever || vertex_fits() ? wake : Wake(kNever);
}

Wake ShaderCore::fragment_wake() const {
  const Wake wake = Wake(accept_free_).input(fragment_in);
  return fragment_in.ready() == kNever || fragment_fits() ? wake : Wake(kNever);
}

Wake ShaderCore::issue_wake() const { return Wake(ready_.empty() ? kNever : ready_.front().at); }

Wake ShaderCore::simd_wake() const {
  const Simd::Cycle first = first_end(simds_);
  return Wake(first == Simd::kNever ? kNever : clock().edge(first));
}

FifoOut<VertexDoneToken>& ShaderCore::vertex_out_for(const CoreSlot& slot) const {
  return *vertex_out[static_cast<std::size_t>(slot.batch / batches_of_front_end_)];
}

Wake ShaderCore::completion_wake(const Completion& done) const {
  Wake wake(done.at);
  const CoreSlot& slot = slots_[done.slot];
  if (done.end == models::ClauseEnd::kRequests) {
    if (slot.warp.texture_count > 0) wake.output(*texture_out);
    if (slot.warp.access_count > 0) wake.output(*storage_out);
    return wake;
  }
  return slot.stage == models::ShaderStage::kVertex
             ? wake.output(vertex_out_for(slot))
             : Wake(std::max(done.at, export_free_)).output(*fragment_out[slot.partition.index()]);
}

const ShaderCore::Completion* ShaderCore::next_completion(Wake& wake) const {
  const Completion* first = nullptr;
  wake = Wake(kNever);
  for (const Completion& c : completions_) {
    const Wake w = completion_wake(c);
    if (w.at() < wake.at()) {
      wake = w;
      first = &c;
    }
  }
  return first;
}

Wake ShaderCore::next() const {
  Wake wake;
  (void)next_completion(wake);
  wake = Wake::sooner(wake, issue_wake());
  wake = Wake::sooner(wake, simd_wake());
  wake = Wake::sooner(wake, vertex_wake());
  wake = Wake::sooner(wake, fragment_wake());
  if (texture_in) wake = Wake::sooner(wake, Wake().input(*texture_in));
  if (storage_in) wake = Wake::sooner(wake, Wake().input(*storage_in));
  if (wake.at() != kNever || wake.cause() != nullptr) return wake;
  const bool waits = ready_.empty() && free_slots_.size() < slots_.size();
  if (waits && texture_in) return Wake::never(*texture_in);
  return waits && storage_in ? Wake::never(*storage_in) : Wake::never(fragment_in);
}

void ShaderCore::act(Tick now) {
  if (texture_in && texture_in->ready_at(now)) take_texels(now);
  if (storage_in && storage_in->ready_at(now)) take_reply(now, storage_in->pop(now).slot, *storage_in);
  end_clauses(now);
  Wake wake;
  if (const Completion* done = next_completion(wake); done != nullptr && wake.at() <= now) {
    const Completion taken = *done;
    completions_.erase(completions_.begin() + (done - completions_.data()));
    complete(now, taken);
  }
  if (fragment_wake().at() <= now) accept_fragment(now);
  else if (vertex_wake().at() <= now) accept_vertex(now);
  while (issue_wake().at() <= now) issue(now);
  // The SIMDs issue at least until the first of their clauses ends.
  if (const Simd::Cycle until = first_end(simds_); until != Simd::kNever)
    occupy(now, until - clock().edges_before(now));
}

void ShaderCore::take_texels(Tick now) {
  const std::uint32_t index = texture_in->pop(now).slot;
  CoreSlot& slot = slots_[index];
  for (int i = 0; i < slot.warp.texture_count; ++i) {
    models::write_texture_result(slot.warp, slot.warp.textures[static_cast<std::size_t>(i)],
                                 slot.texels[static_cast<std::size_t>(i)]);
  }
  take_reply(now, index, *texture_in);
}

void ShaderCore::take_reply(Tick now, std::uint32_t index, const PortBase& port) {
  CoreSlot& slot = slots_[index];
  if (--slot.replies > 0) return;
  ready_.push_back({now, index});
  slot.leg_take = noted(leg_log(), {now, now, port.number(), false, slot.draw});
}

const models::ProgramTiming& ShaderCore::timing_of(const models::Program& program) {
  const auto found = timings_.find(&program);
  return found != timings_.end()
             ? found->second
             : timings_.emplace(&program, models::ProgramTiming(program, issue_timing_)).first->second;
}

void ShaderCore::issue(Tick now) {
  const std::uint32_t index = ready_.front().slot;
  ready_.pop_front();
  CoreSlot& slot = slots_[index];
  if (slot.stage == models::ShaderStage::kVertex) stats_.working_for(slot.draw);
  else stats_.working_for(slot.draw, slot.tile_x, slot.tile_y);
  warp_clock_.restart(timing_of(*slot.warp.program), slot.warp.program->num_regs);
  const models::ClauseResult result = models::run_clause(slot.warp, warp_clock_);
  const models::ClauseCost& cost = result.cost;
  slot.end = result.end;
  slot.drain = warp_clock_.drain() - warp_clock_.span();
  slot.leg_latency = warp_clock_.drain() - warp_clock_.work();
  simds_[slot.simd].add(clock().edges_before(now), index, warp_clock_.work(), warp_clock_.span());
  const auto textures = static_cast<std::uint32_t>(slot.warp.texture_count);
  const auto accesses = static_cast<std::uint32_t>(slot.warp.access_count);
  ++stats_.clauses;
  stats_.instructions += cost.instructions() + textures + accesses;
  stats_.alu += cost.alu + cost.interp + cost.constant + cost.exported;
  stats_.sfu += cost.sfu;
  stats_.texture += textures;
  stats_.storage += accesses;
  stats_.lane_operations += cost.lane_ops;
  stats_.simd_busy += warp_clock_.work();
  stats_.operand_waits += warp_clock_.span() - warp_clock_.work();
}

void ShaderCore::end_clauses(Tick now) {
  const Simd::Cycle cycle = clock().edges_before(now);
  std::uint32_t index = 0;
  for (Simd& simd : simds_) {
    while (simd.take_ended(cycle, index))
      completions_.push_back({after(now, slots_[index].drain), index, slots_[index].end});
  }
}

void ShaderCore::complete(Tick now, const Completion& done) {
  if (done.end != models::ClauseEnd::kRequests) return retire(now, done);
  CoreSlot& slot = slots_[done.slot];
  slot.replies = (slot.warp.texture_count > 0) + (slot.warp.access_count > 0);
  if (slot.warp.texture_count > 0) {
    note_leg(now, done, *texture_out);
    texture_out->push(now, {done.slot, slot.draw, slot.stage});
  }
  if (slot.warp.access_count > 0) {
    note_leg(now, done, *storage_out);
    storage_out->push(now, {done.slot, slot.draw, slot.stage});
  }
}

void ShaderCore::note_leg(Tick now, const Completion& done, const PortBase& out, bool exports) const {
  LegLog* log = leg_log();
  if (log == nullptr) [[likely]]
    return;
  const CoreSlot& slot = slots_[done.slot];
  log->end({slot.leg_take, 0, done.at, now, after(0, slot.leg_latency), out.number(), exports,
            done.end != models::ClauseEnd::kRequests});
}

void ShaderCore::audit(Audit& audit) const {
  audit.right(laws::kVerticesFetched, stats_.vertices.value());
  audit.left(laws::kVerticesShaded, stats_.vertices.value());
  audit.right(laws::kFragmentsPacked, stats_.fragments.value());
  audit.left(laws::kFragmentsShaded, stats_.fragments.value());
  audit.left(laws::kColorsExported, stats_.exported_bytes.value());
  if (texture_out) audit.left(laws::kTextureRequests, stats_.texture.value());
  if (storage_out) audit.left(laws::kStorageRequests, stats_.storage.value());
}

void ShaderCore::details(Details& details) const {
  details.by_draw(DrawCount::kVerticesShaded, stats_.vertices);
  details.by_draw(DrawCount::kShaded, stats_.fragments);
  details.total_of_tiles(TileCount::kShaded, stats_.fragments);
  details.by_draw(DrawCount::kTextureSent, stats_.texture);
  details.by_draw(DrawCount::kSimdBusy, stats_.simd_busy);
  details.shared_by_draws(&stats_.simd_busy);
  details.work({&stats_.simd_busy}, params_.simds);
}

std::vector<Facet> ShaderCore::row() const {
  return {rate("SIMDs held", stats_.simd_busy, params_.simds), count("instructions", stats_.instructions),
          mean("lanes/instruction", stats_.lane_operations, stats_.instructions),
          share("special function", stats_.sfu, stats_.instructions),
          share("texture", stats_.texture, stats_.instructions)};
}

}  // namespace quadrille::hw
