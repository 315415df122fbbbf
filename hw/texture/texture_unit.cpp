#include "hw/texture/texture_unit.h"

#include "hw/base/leg_log.h"
#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include <algorithm>
#include <array>
#include <bit>

namespace quadrille::hw {
namespace {

std::int64_t cycles_of(std::size_t work, int rate) {
  return static_cast<std::int64_t>((work + static_cast<std::size_t>(rate) - 1) /
                                   static_cast<std::size_t>(rate));
}

}  // namespace

TextureUnit::TextureUnit(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                         Store<CoreSlot>& slots)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      device_(context.memory),
      slots_(slots),
      port_(*this, stats_, context.machine.channels),
      cache_(stats_, params.cache_lines, params.cache_ways, params.cache_misses, params.replacement.value()),
      encoded_(stats_),
      sectors_(stats_) {
  cache_.read_encoded(device_.stored_lines(), encoded_);
  cache_.fetch_groups(1 << static_cast<int>(params.fetched_sectors.value()), sectors_);
  add_initiation_rate("address");
  add_rate("filter", [this] {
    return static_cast<double>(stats_.bilinear_quads.value()) / params_.filter_quads_per_clk;
  });
  add_rate("decode", [this] {
    return static_cast<double>(stats_.decode_slots.value()) / params_.decode_blocks_per_clk;
  });
  add_places("groups_in_flight",
             [this] { return groups_.size() >= static_cast<std::size_t>(params_.groups_in_flight.value()); });
  add_memory_places("cache_misses", [this] { return cache_.full(); });
}

std::string TextureUnit::state_text() const {
  return fmt::format("{} request groups, {} look-ups left", groups_.size(), lines_.size() - next_line_);
}

Wake TextureUnit::address_wake() const {
  if (next_line_ < lines_.size()) return stalled_ ? Wake::never(port_.response_in[0]) : Wake(address_free_);
  if (groups_.size() >= static_cast<std::size_t>(params_.groups_in_flight.value()))
    return Wake::never(response_out);
  return Wake(address_free_).input(request_in);
}

Wake TextureUnit::answer_wake() const {
  if (groups_.empty()) return Wake::never(request_in);
  const Group& head = groups_.front();
  const bool still_looking_up = groups_.size() == 1 && next_line_ < lines_.size();
  if (head.missing > 0 || still_looking_up) return Wake::never(port_.response_in[0]);
  return Wake(answered_at(head)).output(response_out);
}

Tick TextureUnit::answered_at(const Group& head) const {
  return after(std::max(head.ready, filter_free_), head.filter_cycles + params_.filter_clk);
}

Wake TextureUnit::next() const {
  Wake wake = Wake::sooner(address_wake(), answer_wake());
  wake = Wake::sooner(wake, port_.receive_wake());
  if (!port_.queue_empty()) wake = Wake::sooner(wake, port_.send_wake());
  return wake;
}

void TextureUnit::act(Tick now) {
  port_.receive(now, [&](const MemoryResponse& answer) {
    stalled_ = false;
    cache_.fill(answer, [&](std::uint32_t number) {
      groups_.answer(number, now);
      if (LegLog* log = leg_log(); log != nullptr) [[unlikely]]
        log->take_answer(groups_.numbered(number), now, port_.answers_of(answer.line).number());
    });
  });
  if (answer_wake().at() <= now) {
    if (leg_log() != nullptr) [[unlikely]]
      note_leg(now);
    response_out.push(now, groups_.front().token);
    stats_.latency.note(static_cast<std::uint64_t>(clock().edges_before(now) -
                                                   clock().edges_before(groups_.front().arrived)));
    filter_free_ = after(std::max(groups_.front().ready, filter_free_), groups_.front().filter_cycles);
    groups_.pop_front();
    ++stats_.groups_answered;
  }
  if (address_wake().at() <= now) {
    if (next_line_ < lines_.size()) look_up(now);
    else take(now);
  }
  port_.send(now);
}

void TextureUnit::plan(CoreSlot& slot, const TextureToken& token, Group& group,
                       std::int64_t& address_cycles) {
  const std::vector<TextureState>& textures = frame_.draw(token.draw).stage(token.stage).textures;
  std::uint32_t quads = 0;
  for (int i = 0; i < slot.warp.texture_count; ++i) {
    const models::TextureRequest& request = slot.warp.textures[static_cast<std::size_t>(i)];
    const TextureState& texture = textures[request.binding];
    models::plan_texture(texture.view, texture.sampler, request, frame_.precision, plan_);
    texture.need_texels(plan_);
    // Values are the same whenever they are computed: textures do not change within a pass. Only presence in
    // the cache takes time.
    models::filter_texture(plan_, device_, slot.texels[static_cast<std::size_t>(i)]);
    add_look_ups(group, texture.texture);
    if (use_) [[unlikely]]
      use_->note(texture.texture, texture.sampler, plan_);
    quads += plan_.bilinear_quads;
    ++stats_.requests;
    stats_.lanes += static_cast<std::uint64_t>(std::popcount(request.active));
    stats_.bilinear_quads += plan_.bilinear_quads;
    stats_.texels += plan_.texels;
  }
  address_cycles = std::max({std::int64_t{1}, cycles_of(quads, params_.address_quads_per_clk), tag_cycles()});
  group.filter_cycles =
      std::max({std::int64_t{1}, group.filter_cycles, cycles_of(quads, params_.filter_quads_per_clk)});
}

std::int64_t TextureUnit::tag_cycles() {
  const std::int64_t without_banks = cycles_of(lines_.size(), params_.tags_per_clk);
  const auto banks = static_cast<std::size_t>(params_.tag_banks.value());
  if (banks == 1) return without_banks;
  std::array<std::size_t, 64> in_bank{};
  for (const LookUp& look_up : lines_) {
    const std::uint32_t line = look_up.decoded.blocks == 0 ? look_up.line.line : look_up.decoded.line;
    // Lines of a tile are four in a row: 2x2 of them are neighbours.
    ++in_bank[(line + 2 * (line / 4)) % banks];
  }
  const std::size_t fullest = *std::ranges::max_element(in_bank);
  const int each = std::max(1, params_.tags_per_clk / params_.tag_banks);
  const std::int64_t cycles = std::max(without_banks, cycles_of(fullest, each));
  stats_.bank_conflict_clk += static_cast<std::uint64_t>(cycles - without_banks);
  return cycles;
}

void TextureUnit::add_look_ups(Group& group, std::uint32_t texture) {
  if (plan_.block_count == 0 || params_.blocks_held.value() == BlocksHeld::kCompressed) {
    for (int i = 0; i < plan_.line_count; ++i)
      lines_.push_back({plan_.lines[static_cast<std::size_t>(i)], {}, plan_.format, texture});
    decode(group, static_cast<std::uint32_t>(plan_.block_count), plan_.format);
    return;
  }
  decoded_lines_.clear();
  models::add_decoded_lines(plan_, decoded_lines_);
  for (const models::DecodedLine& line : decoded_lines_) lines_.push_back({{}, line, plan_.format, texture});
}

void TextureUnit::decode(Group& group, std::uint32_t blocks, models::Format format) {
  if (blocks == 0) return;
  const std::uint32_t slots = models::is_astc_format(format)
                                  ? blocks * static_cast<std::uint32_t>(params_.astc_decode_slots)
                                  : blocks;
  group.decode_slots += slots;
  stats_.blocks_decoded += blocks;
  stats_.decode_slots += slots;
  group.filter_cycles =
      std::max(group.filter_cycles, cycles_of(group.decode_slots, params_.decode_blocks_per_clk));
}

L1Cache::Result TextureUnit::access(const LookUp& line) {
  if (line.decoded.blocks == 0)
    return cache_.access(line.line.line, static_cast<std::uint8_t>(line.line.sectors), groups_.newest(),
                         port_);
  const std::uint64_t misses = cache_.stats().misses.value();
  const models::StoredLines::Place from{line.decoded.from.line,
                                        static_cast<std::uint8_t>(line.decoded.from.sectors)};
  const L1Cache::Result result =
      cache_.access_made(L1Cache::kMadeLines | line.decoded.line, from, groups_.newest(), port_);
  if (cache_.stats().misses.value() != misses) decode(groups_.back(), line.decoded.blocks, line.format);
  return result;
}

L1Cache::Result TextureUnit::access_for_use(const LookUp& line) {
  const std::uint64_t misses = cache_.stats().misses.value(), bytes = port_.stats().read_bytes.value();
  const L1Cache::Result result = access(line);
  if (result != L1Cache::Result::kStall)
    use_->note_look_up(line.texture, cache_.stats().misses.value() != misses,
                       port_.stats().read_bytes.value() - bytes);
  return result;
}

void TextureUnit::begin_pass(PassId pass) {
  if (pass == pass_) return;
  pass_ = pass;
  if (!frame_.pass(pass).samples_attachments) return;
  cache_.forget();
  ++stats_.cache_emptied;
}

void TextureUnit::note_leg(Tick now) const {
  const Group& group = groups_.front();
  leg_log()->end({group.leg_take, filter_free_ > group.ready ? filter_free_ : 0, answered_at(group), now,
                  after(0, params_.filter_clk), response_out.number(), false, true});
}

void TextureUnit::take(Tick now) {
  const Tick arrived = request_in.ready();
  const TextureToken token = request_in.pop(now);
  if (token.stage == models::ShaderStage::kVertex) stats_.working_for(token.draw);
  else stats_.working_for(token.draw, slots_[token.slot].tile_x, slots_[token.slot].tile_y);
  begin_pass(frame_.draw(token.draw).pass);
  lines_.clear();
  next_line_ = 0;
  Group group{token};
  group.arrived = arrived;
  group.leg_take = noted(leg_log(), {arrived, now, request_in.number(), true, token.draw});
  std::int64_t address_cycles = 0;
  plan(slots_[token.slot], token, group, address_cycles);
  ++stats_.groups;
  address_free_ = after(now, address_cycles);
  group.ready = after(now, address_cycles);
  occupy(now, address_cycles);
  groups_.push_back(group);
  look_up(now);
}

void TextureUnit::look_up(Tick now) {
  for (; next_line_ < lines_.size(); ++next_line_) {
    const LookUp& next = lines_[next_line_];
    switch (use_ ? access_for_use(next) : access(next)) {
      case L1Cache::Result::kHit: break;
      case L1Cache::Result::kPending: ++groups_.back().missing; break;
      case L1Cache::Result::kStall: stalled_ = true; return;
    }
  }
  groups_.back().ready = std::max(groups_.back().ready, now);
}

void TextureUnit::audit(Audit& audit) const {
  audit.right(laws::kTextureRequests, stats_.requests.value());
  audit.both(laws::kTextureGroups, stats_.groups.value(), stats_.groups_answered.value());
  cache_.stats().audit(audit, laws::kTextureCache);
  port_.audit(audit);
}

void TextureUnit::details(Details& details) const {
  details.by_draw(DrawCount::kTextureTaken, stats_.requests);
  details.by_draw(DrawCount::kSamples, stats_.lanes);
  details.by_draw(DrawCount::kTexels, stats_.texels);
  details.by_draw(DrawCount::kTextureMisses, cache_.stats().misses);
  details.by_tile(TileCount::kTextureMisses, cache_.stats().misses);
  details.work({&stats_.bilinear_quads}, params_.filter_quads_per_clk);
  details.work({&stats_.decode_slots}, params_.decode_blocks_per_clk);
  port_.details(details, DrawCount::kTextureBytes);
}

std::vector<Facet> TextureUnit::row() const {
  return {rate("bilinear quads", stats_.bilinear_quads, params_.filter_quads_per_clk),
          count("requests", stats_.requests), mean("lanes/request", stats_.lanes, stats_.requests),
          share("cache hit", cache_.stats().hits, cache_.stats().requests),
          share("merged", cache_.stats().merged, cache_.stats().requests)};
}

}  // namespace quadrille::hw
