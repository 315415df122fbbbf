#include "hw/geometry/vertex_fetch.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/indices.h"
#include "hw/frame/laws.h"

#include <algorithm>

namespace quadrille::hw {

namespace {

/// Front ends have equal parts of the store, one behind the other.
BatchSlots slots_of(const UnitContext& context, const Store<BatchSlot>& batches) {
  const auto slots =
      static_cast<std::uint32_t>(batches.size()) / static_cast<std::uint32_t>(context.machine.front_ends);
  return {static_cast<std::uint32_t>(context.number) * slots, slots};
}

}  // namespace

VertexFetch::VertexFetch(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                         Store<BatchSlot>& batches)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      device_(context.memory),
      batches_(batches),
      released_by_(static_cast<std::size_t>(context.machine.engines), 0),
      port_(*this, stats_, context.machine.channels),
      cache_(stats_, params.cache_lines, params.cache_ways, params.cache_misses),
      reuse_(params.reuse.value().make({params.batch_vertices, params.reuse_entries})),
      shares_(static_cast<std::uint32_t>(context.number),
              static_cast<std::uint32_t>(context.machine.front_ends),
              static_cast<std::uint32_t>(params.range_primitives.value())),
      slots_(slots_of(context, batches)) {
  for (int e = 0; e < context.machine.engines; ++e) {
    const std::string port = port_name("release_in", static_cast<std::size_t>(e), released_by_.size());
    release_in.add(*this, port.c_str(), LinkRole::kReply);
  }
  add_initiation_rate("rates");
  add_places("batch_slots", [this] { return slots_.free() == 0; });
  add_memory_places("cache_misses", [this] { return cache_.full(); });
}

std::string VertexFetch::state_text() const {
  return fmt::format("draw {}, primitive {}, {} batches on their way, {} free slots", draw_.index(),
                     walk_.primitive(), pending_.size(), slots_.free());
}

Wake VertexFetch::build_wake() const {
  if (next_line_ < lines_.size()) {
    if (stalled_) return Wake::never(port_.response_in[0]);
    return Wake(free_);
  }
  if (!drawing_) return Wake(free_).input(draw_in);
  if (!slots_.any_free()) return Wake::never(release_in[0]);
  return Wake(free_);
}

Wake VertexFetch::leave_wake() const {
  if (pending_.empty()) return Wake::never(draw_in);
  const Pending& head = pending_.front();
  const bool still_looking_up = pending_.size() == 1 && next_line_ < lines_.size();
  if (head.missing > 0 || still_looking_up) return Wake::never(port_.response_in[0]);
  Wake wake(head.ready);
  if (shades(head)) wake.output(warp_out);
  return wake.output(batch_out);
}

Wake VertexFetch::next() const {
  Wake wake = Wake::sooner(build_wake(), leave_wake());
  wake = Wake::sooner(wake, port_.receive_wake());
  if (!port_.queue_empty()) wake = Wake::sooner(wake, port_.send_wake());
  return Wake::sooner(wake, release_in.earliest());
}

void VertexFetch::act(Tick now) {
  take_releases(now);
  port_.receive(now, [&](const MemoryResponse& answer) {
    stalled_ = false;
    cache_.fill(answer, [&](std::uint32_t number) { pending_.answer(number, now); });
  });
  if (build_wake().at() <= now) build(now);
  if (leave_wake().at() <= now) leave(now);
  port_.send(now);
}

void VertexFetch::take_releases(Tick now) {
  release_in.take_ready(now, [&](std::size_t engine, const ReleaseToken&) { ++released_by_[engine]; });
  const std::uint64_t released = *std::min_element(released_by_.begin(), released_by_.end());
  if (released == released_) return;
  for (; released_ < released; ++released_) slots_.release();
  slots_.sweep(*reuse_);
}

void VertexFetch::build(Tick now) {
  if (next_line_ < lines_.size()) return look_up(now);
  if (drawing_) return form_batch(now);
  const DrawToken token = draw_in.pop(now);
  stats_.working_for(token.part.draw());
  if (token.kind == TokenKind::kWork) {
    start_draw(token.part.draw());
  } else if (token.kind == TokenKind::kDrawEnd ? shares_.ends_draw() : shares_.has_turn()) {
    pending_.push_back({token.kind, token.part, 0, 0, now});
  }
  free_ = after(now, 1);
  occupy(now, 1);
}

void VertexFetch::start_draw(DrawId draw) {
  draw_ = draw;
  passed_.clear();
  const DrawState& state = frame_.draw(draw);
  shares_.start_draw(state.instances, models::primitive_count(state.topology, state.count), !state.restarts);
  instance_ = kNoInstance;
  drawing_ = start_range();
}

bool VertexFetch::start_range() {
  if (shares_.done()) return false;
  if (shares_.instance() != instance_) {
    instance_ = shares_.instance();
    start_instance();
  }
  range_end_ = shares_.end();
  if (!primitive_left()) return false;
  walk_.skip_to(shares_.first());
  return true;
}

void VertexFetch::start_instance() {
  const DrawState& draw = frame_.draw(draw_);
  walk_.start(draw.topology, draw.count, draw.restarts);
  reuse_->start_draw();
}

bool VertexFetch::primitive_left() {
  if (walk_.primitive() >= range_end_) return false;
  const DrawState& draw = frame_.draw(draw_);
  return walk_.look([&](std::uint32_t position) { return is_restart(draw, device_, position); },
                    [&](std::uint32_t position) { passed_.push_back(position); });
}

void VertexFetch::fetch_passed() {
  for (const std::uint32_t position : passed_) fetch_index(position);
  passed_.clear();
}

void VertexFetch::fetch_index(std::uint32_t position) {
  const DrawState& draw = frame_.draw(draw_);
  ++indices_;
  if (draw.indexed) touch_bytes(index_address(draw, position), draw.index_bytes);
}

void VertexFetch::touch_bytes(std::uint64_t address, std::uint32_t bytes) {
  for (std::uint64_t a = address / models::kSectorBytes; a <= (address + bytes - 1) / models::kSectorBytes;
       ++a) {
    const auto sector = static_cast<std::uint8_t>(1u << (a % models::kLineSectors));
    lines_[touched_line(static_cast<std::uint32_t>(a / models::kLineSectors))].sectors |= sector;
  }
}

/// Vertices lie one after the other, and their next attribute in the same lines in the same order: so most
/// often it is the line touched last, or the next one.
std::size_t VertexFetch::touched_line(std::uint32_t line) {
  const auto is_it = [line](const Line& l) { return l.line == line; };
  const auto found_here = [&] { return last_touched_ < lines_.size() && is_it(lines_[last_touched_]); };
  if (found_here()) return last_touched_;
  ++last_touched_;
  if (found_here()) return last_touched_;
  last_touched_ = static_cast<std::size_t>(std::ranges::find_if(lines_, is_it) - lines_.begin());
  if (last_touched_ == lines_.size()) lines_.push_back({line, 0});
  return last_touched_;
}

void VertexFetch::fetch_attributes(BatchSlot& batch) {
  const DrawState& draw = frame_.draw(draw_);
  for (const AttributeFetch& fetch : draw.attributes) {
    const std::uint32_t bytes = models::format_bytes(fetch.format);
    for (int lane = 0; lane < batch.lanes; ++lane) {
      const std::uint32_t element =
          fetch.per_instance ? draw.first_instance + instance_ : reuse_->index(lane);
      const std::uint64_t address = fetch.address + std::uint64_t{element} * fetch.stride;
      touch_bytes(address, bytes);
      ++fetches_;
      std::uint32_t value[4];
      models::decode_attribute(fetch.format, device_.read(address, bytes).data(), value);
      for (std::size_t c = 0; c < 4; ++c) {
        if (fetch.input_row[c] < 0) continue;
        batch.attributes[static_cast<std::size_t>(fetch.input_row[c])][static_cast<std::size_t>(lane)] =
            value[c];
      }
    }
  }
}

void VertexFetch::take_primitives(BatchSlot& batch) {
  const DrawState& draw = frame_.draw(draw_);
  const std::size_t corners = draw.primitives.corners();
  while (batch.triangles.size() < static_cast<std::size_t>(params_.batch_triangles.value()) &&
         primitive_left()) {
    const auto position = walk_.positions();
    std::array<std::uint32_t, 3> vertex{};
    for (std::size_t i = 0; i < corners; ++i) vertex[i] = vertex_number(draw, device_, position[i]);
    // If it does not fit it is the first of the next batch, which pays for its indices.
    if (!reuse_->fits(std::span(vertex).first(corners))) break;
    BatchSlot::Triangle primitive{{}, walk_.primitive()};
    for (std::size_t i = 0; i < corners; ++i) {
      fetch_index(position[i]);
      primitive.corner[i] = reuse_->place(vertex[i]);
      slots_.note_use(primitive.corner[i].slot);
    }
    for (std::size_t i = corners; i < 3; ++i) primitive.corner[i] = primitive.corner[corners - 1];
    batch.triangles.push_back(primitive);
    walk_.advance();
  }
}

void VertexFetch::form_batch(Tick now) {
  const DrawState& draw = frame_.draw(draw_);
  const std::uint32_t slot = slots_.take();
  BatchSlot& batch = batches_[slot];
  batch.draw = draw_;
  batch.triangles.clear();
  batch.attributes.resize(draw.vertex.program->vertex_inputs.size());
  batch.outputs.resize(static_cast<std::size_t>(models::vertex_outputs(*draw.vertex.program)));
  lines_.clear();
  next_line_ = last_touched_ = 0;
  fetches_ = 0;
  indices_ = 0;
  fetch_passed();
  reuse_->start_batch(slot);
  take_primitives(batch);
  batch.lanes = reuse_->size();
  for (int lane = 0; lane < batch.lanes; ++lane) {
    batch.inputs.vertex_index[static_cast<std::size_t>(lane)] = reuse_->index(lane);
    batch.inputs.instance_index[static_cast<std::size_t>(lane)] = draw.first_instance + instance_;
  }
  fetch_attributes(batch);
  batch.inputs.attributes = batch.attributes.data();
  const bool range_done = !primitive_left();
  batch.ends_range = range_done && shares_.hands_on();
  if (range_done) {
    shares_.advance();
    drawing_ = start_range();
  }
  fetch_passed();
  // One slot is for the next batch, whatever is remembered.
  reuse_->limit_slots(static_cast<int>(slots_.size()) - 1);
  slots_.sweep(*reuse_);
  stats_.indices += indices_;
  stats_.vertices += static_cast<std::uint64_t>(batch.lanes);
  stats_.attribute_fetches += fetches_;
  ++stats_.batches;
  stats_.triangles += batch.triangles.size();
  const auto per = [](std::uint32_t work, int rate) { return (static_cast<int>(work) + rate - 1) / rate; };
  const int cycles =
      std::max({1, per(indices_, params_.indices_per_clk), per(fetches_, params_.attributes_per_clk)});
  free_ = after(now, cycles);
  occupy(now, cycles);
  pending_.push_back({TokenKind::kWork, draw_, slot, 0, free_});
  look_up(now);
}

void VertexFetch::look_up(Tick now) {
  for (; next_line_ < lines_.size(); ++next_line_) {
    switch (cache_.access(lines_[next_line_].line, lines_[next_line_].sectors, pending_.newest(), port_)) {
      case L1Cache::Result::kHit: break;
      case L1Cache::Result::kPending: ++pending_.back().missing; break;
      case L1Cache::Result::kStall: stalled_ = true; return;
    }
  }
  pending_.back().ready = std::max(pending_.back().ready, now);
}

bool VertexFetch::shades(const Pending& head) const {
  return head.kind == TokenKind::kWork && batches_[head.slot].lanes > 0;
}

void VertexFetch::leave(Tick now) {
  const Pending head = pending_.front();
  pending_.pop_front();
  if (shades(head)) warp_out.push(now, {head.part.draw(), head.slot});
  batch_out.push(now, {head.kind, head.part, head.slot});
}

void VertexFetch::audit(Audit& audit) const {
  audit.left(laws::kVerticesFetched, stats_.vertices.value());
  audit.left(laws::kTrianglesFetched, stats_.triangles.value());
  cache_.stats().audit(audit, laws::kVertexCache);
  port_.audit(audit);
}

void VertexFetch::details(Details& details) const {
  details.by_draw(DrawCount::kIndices, stats_.indices);
  details.by_draw(DrawCount::kVerticesFetched, stats_.vertices);
  details.by_draw(DrawCount::kTrianglesFetched, stats_.triangles);
  port_.details(details, DrawCount::kVertexBytes);
}

std::vector<Facet> VertexFetch::row() const {
  return {rate("indices", stats_.indices, params_.indices_per_clk),
          mean("indices/vertex", stats_.indices, stats_.vertices),
          rate("attributes", stats_.attribute_fetches, params_.attributes_per_clk),
          share("cache hit", cache_.stats().hits, cache_.stats().requests)};
}

}  // namespace quadrille::hw
