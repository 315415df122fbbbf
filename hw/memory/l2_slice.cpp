#include "hw/memory/l2_slice.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include "hw/memory/memory_port.h"
#include "models/memory/device_memory.h"

#include <algorithm>
#include <utility>

namespace quadrille::hw {

namespace {
bool writes_surface(MemoryClient client, MemoryRequest::Kind kind) {
  return (client == MemoryClient::kDepth || client == MemoryClient::kColor) &&
         (kind == MemoryRequest::Kind::kWrite || kind == MemoryRequest::Kind::kWritePart);
}

/// `texture_3` has the ports `texture_in_3` and `texture_out_3`: the number stays last, as in all ports of a
/// kind.
std::string port_name(const std::string& client, std::string_view side) {
  const std::size_t number = client.find_last_not_of("0123456789") + 1;
  if (number == client.size()) return fmt::format("{}_{}", client, side);
  return fmt::format("{}{}_{}", client.substr(0, number), side, client.substr(number));
}
}  // namespace

L2Slice::L2Slice(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                 const std::vector<Client>& clients)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      tags_(static_cast<std::uint32_t>(params.cache_lines.value()),
            static_cast<std::uint32_t>(params.cache_ways.value()),
            static_cast<std::uint32_t>(context.machine.channels), params.replacement.value()),
      misses_(tags_, static_cast<std::size_t>(params.cache_misses.value())),
      parts_(static_cast<std::size_t>(tags_.slots()), 0),
      answers_(clients.size()),
      answering_((clients.size() + 63) / 64, 0),
      interleave_(static_cast<std::uint32_t>(context.machine.channels)),
      write_back_(
          params.write_back.value().make({static_cast<std::uint32_t>(params.write_back_lines.value())})) {
  add_initiation_rate("rate");
  add_places("cache_misses", [this] { return misses_.full(); });
  for (const auto& [client, kind] : clients) {
    client_kinds_.push_back(kind);
    request_in.add(*this, port_name(client, "in").c_str());
    response_out.push_back(
        std::make_unique<FifoOut<MemoryResponse>>(*this, port_name(client, "out").c_str(), LinkRole::kReply));
  }
}

std::string L2Slice::state_text() const {
  return fmt::format("{} lines under way, {} requests for the channel", misses_.under_way(),
                     to_memory_.size());
}

bool L2Slice::can_look_up() const { return !stalled_ && to_memory_.size() < misses_.size(); }

Wake L2Slice::look_up_wake() const {
  if (!can_look_up()) return Wake::never(fill_in);
  return request_in.earliest(Wake(free_));
}

Wake L2Slice::next() const {
  Wake wake = look_up_wake();
  wake = Wake::sooner(wake, Wake().input(fill_in));
  if (!to_memory_.empty()) wake = Wake::sooner(wake, Wake(to_memory_.front().at).output(memory_out));
  if (answer_due_ < wake.at())
    visit_answering([&](std::size_t c) {
      wake = Wake::sooner(wake, Wake(answers_[c].front().at).output(*response_out[c]));
    });
  return wake;
}

void L2Slice::act(Tick now) {
  while (fill_in.ready_at(now)) take_fill(now);
  if (answer_due_ <= now) send_answers(now);
  if (can_look_up() && free_ <= now) {
    request_in.visit_holding(turn_, [&](std::size_t c, const FifoIn<MemoryRequest>& in) {
      if (!in.ready_at(now)) return false;
      look_up(now, static_cast<std::uint32_t>(c));
      return true;
    });
  }
  send_to_memory(now);
}

void L2Slice::send_to_memory(Tick now) {
  if (to_memory_.empty() || to_memory_.front().at > now || !memory_out.room_at(now)) return;
  memory_out.push(now, to_memory_.front().token);
  to_memory_.pop_front();
}

void L2Slice::send_answers(Tick now) {
  answer_due_ = kNever;
  visit_answering([&](std::size_t c) {
    Queue<Answer>& queue = answers_[c];
    if (queue.front().at <= now && response_out[c]->room_at(now)) {
      response_out[c]->push(now, queue.front().token);
      queue.pop_front();
    }
    if (queue.empty()) answering_[c / 64] ^= std::uint64_t{1} << (c % 64);
    else answer_due_ = std::min(answer_due_, queue.front().at);
  });
}

void L2Slice::look_up(Tick now, std::uint32_t client) {
  const MemoryRequest request = request_in[client].front();
  stats_.working_for(request.draw);
  bool taken = true;
  switch (request.kind) {
    case MemoryRequest::Kind::kRead: taken = read(now, client, request); break;
    case MemoryRequest::Kind::kWrite: taken = write(now, request); break;
    case MemoryRequest::Kind::kWritePart: taken = write_part(now, client, request); break;
    case MemoryRequest::Kind::kAtomic: taken = atomic(now, client, request); break;
    case MemoryRequest::Kind::kFence:
      answer(after(now, params_.hit_clk), client, {request.line, request.tag, 0});
      break;
  }
  if (!taken) {
    stalled_ = true;
    return;
  }
  if (request.kind != MemoryRequest::Kind::kFence) ++stats_.requests;
  if (writes_surface(client_kinds_[client], request.kind))
    stats_.surface_write_bytes += models::sector_bytes(request.sectors);
  (void)request_in[client].pop(now);
  turn_ = (client + 1) % request_in.size();
  free_ = after(now, 1);
  occupy(now, 1);
}

int L2Slice::place(Tick now, std::uint32_t line) {
  const models::TagArray::Allocation got = tags_.allocate(line);
  if (got.victim.valid && got.victim.dirty != 0) {
    write_back(now, got.victim.line, got.victim.dirty);
    write_back_others(now, got.victim.line);
  }
  return got.slot;
}

void L2Slice::write_back(Tick now, std::uint32_t line, std::uint8_t sectors) {
  stats_.writeback_bytes += models::sector_bytes(sectors);
  to_memory_.push_back({after(now, params_.hit_clk),
                        {line, 0, sectors, MemoryRequest::Kind::kWrite, MemoryClient::kWriteBack}});
}

void L2Slice::write_back_others(Tick now, std::uint32_t victim) {
  // In order of address.
  const WriteBack::Lines lines = write_back_->with(victim, interleave_);
  for (std::uint32_t within = lines.first; within < lines.last; ++within) {
    const std::uint32_t line = interleave_.line_of(interleave_.member_of(victim), within);
    const int slot = tags_.find(line);
    if (slot == models::TagArray::kNone || tags_.at(slot).dirty == 0) continue;
    write_back(now, line, tags_.at(slot).dirty);
    tags_.clean(slot);
    ++stats_.early_write_backs;
  }
}

bool L2Slice::read(Tick now, std::uint32_t client, const MemoryRequest& request) {
  const int slot = tags_.lookup(request.line);
  const MemoryResponse token{request.line, request.tag, request.sectors};
  if (slot != models::TagArray::kNone && (tags_.at(slot).valid & request.sectors) == request.sectors) {
    ++stats_.hits;
    answer(after(now, params_.hit_clk), client, token);
    return true;
  }
  const auto tag = fetch(now, client, request);
  if (!tag) return false;
  misses_.wait(*tag, {client, token});
  return true;
}

std::optional<std::uint32_t> L2Slice::fetch(Tick now, std::uint32_t client, const MemoryRequest& request) {
  const auto asked =
      misses_.ask(tags_.find(request.line), request.sectors, [&] { return place(now, request.line); });
  if (!asked) return {};
  if (asked->missing == 0) {
    ++stats_.merged;
    return asked->tag;
  }
  ++stats_.misses;
  stats_.fill_bytes += models::sector_bytes(asked->missing);
  to_memory_.push_back({after(now, params_.hit_clk),
                        {request.line, asked->tag, asked->missing, MemoryRequest::Kind::kRead,
                         client_kinds_[client], request.draw}});
  return asked->tag;
}

bool L2Slice::write(Tick now, const MemoryRequest& request) {
  int slot = tags_.lookup(request.line);
  if (slot == models::TagArray::kNone) slot = place(now, request.line);
  if (slot == models::TagArray::kNone) return false;
  tags_.mark_dirty(slot, request.sectors);
  ++stats_.hits;
  stats_.write_bytes += models::sector_bytes(request.sectors);
  return true;
}

bool L2Slice::all_there(const MemoryRequest& request) const {
  const int slot = tags_.find(request.line);
  return slot != models::TagArray::kNone && (tags_.at(slot).valid & request.sectors) == request.sectors;
}

std::optional<std::uint32_t> L2Slice::write_when_fetched(Tick now, std::uint32_t client,
                                                         const MemoryRequest& request) {
  const int slot = tags_.lookup(request.line);
  const auto there =
      static_cast<std::uint8_t>(slot == models::TagArray::kNone ? 0 : tags_.at(slot).valid & request.sectors);
  const auto tag = fetch(now, client, request);
  if (!tag) return {};
  const int place = misses_.slot_of(*tag);
  tags_.mark_dirty(place, there);
  std::uint8_t& parts = parts_[static_cast<std::size_t>(place)];
  parts = static_cast<std::uint8_t>(parts | (request.sectors & ~there));
  stats_.write_bytes += models::sector_bytes(request.sectors);
  return tag;
}

bool L2Slice::write_part(Tick now, std::uint32_t client, const MemoryRequest& request) {
  if (all_there(request)) return write(now, request);
  return write_when_fetched(now, client, request).has_value();
}

/// Needs the old words, so sectors that are not there are fetched first, as for a write of a part.
bool L2Slice::atomic(Tick now, std::uint32_t client, const MemoryRequest& request) {
  const MemoryResponse token{request.line, request.tag, request.sectors};
  if (all_there(request)) {
    answer(after(now, params_.hit_clk), client, token);
    return write(now, request);
  }
  const auto tag = write_when_fetched(now, client, request);
  if (tag) misses_.wait(*tag, {client, token});
  return tag.has_value();
}

void L2Slice::take_fill(Tick now) {
  const MemoryResponse fill = fill_in.pop(now);
  stalled_ = false;
  if (!misses_.arrive(fill.tag, fill.sectors)) return;
  const int slot = misses_.slot_of(fill.tag);
  tags_.mark_dirty(slot, std::exchange(parts_[static_cast<std::size_t>(slot)], std::uint8_t{0}));
  misses_.release(fill.tag, [&](const Waiter& w) { answer(now, w.client, w.answer); });
}

void L2Slice::answer(Tick at, std::uint32_t client, const MemoryResponse& token) {
  stats_.read_bytes += models::sector_bytes(token.sectors);
  Queue<Answer>& queue = answers_[client];
  queue.push_back({at, token});
  // Misses overtake hits that were looked up later but answer after a fixed latency: keep the queue in order
  // of time.
  for (std::size_t i = queue.size() - 1; i > 0 && queue[i - 1].at > at; --i)
    std::swap(queue[i - 1], queue[i]);
  answering_[client / 64] |= std::uint64_t{1} << (client % 64);
  answer_due_ = std::min(answer_due_, at);
}

void L2Slice::audit(Audit& audit) const {
  audit.both(laws::kL2, stats_.requests.value(),
             stats_.hits.value() + stats_.merged.value() + stats_.misses.value());
  audit.right(laws::kClientRequests, stats_.requests.value());
  audit.right(laws::kClientReads, stats_.read_bytes.value());
  audit.right(laws::kClientWrites, stats_.write_bytes.value());
  audit.right(laws::kSurfaceBytes, stats_.surface_write_bytes.value());
  audit.left(laws::kFills, stats_.fill_bytes.value());
  audit.left(laws::kWriteBacks, stats_.writeback_bytes.value());
}

void L2Slice::details(Details& details) const {
  details.by_draw(DrawCount::kL2Requests, stats_.requests);
  details.by_draw(DrawCount::kFillBytes, stats_.fill_bytes);
}

std::vector<Facet> L2Slice::row() const {
  return {count("requests", stats_.requests), share("hit", stats_.hits, stats_.requests),
          share("merged", stats_.merged, stats_.requests), share("missed", stats_.misses, stats_.requests)};
}

}  // namespace quadrille::hw
