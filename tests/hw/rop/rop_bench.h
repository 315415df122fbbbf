/// A ROP of one core and partition, whose warps are made by hand.
#pragma once

#include "hw/rop/rop.h"
#include "tests/hw/bench_stub.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::hw::bench {

struct RopBench final : Bench {
  struct Setup {
    std::vector<Timed<OrderToken>> order;
    std::vector<Timed<FragmentDoneToken>> done;
    std::vector<Timed<LateToken>> late{};
    bool blend = false, late_warps = false;
    models::LaneMask alive = ~0u;
    int lines = 256, ways = 8, misses = 32, memory_latency = 10;
    std::size_t colors = 1;
    int samples = 1;
    unsigned mask = ~0u;  ///< samples that the program has left
    models::LoadOp load = models::LoadOp::kClear;
    models::StoreOp store = models::StoreOp::kStore;
    models::Format format = models::Format::kR8G8B8A8Srgb;
    int half_blend_turns = 1, float_blend_turns = 1;
    models::TransparencyState transparency{};
  };
  /// The target has two tiles; even warps write the upper half of the left one, odd warps two quads of each
  /// row of the right one.
  RopBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v), warps(4) {
    PassState pass;
    DrawState draw;
    for (std::size_t i = 0; i < s.colors; ++i) {
      pass.color[i].surface = models::allocate_surface(device, 16, 8, static_cast<std::uint32_t>(s.samples),
                                                       models::format_info(s.format).bytes);
      pass.color[i].format = s.format;
      if (s.samples > 1) {
        pass.resolve[i].surface = models::allocate_surface(device, 16, 8);
        pass.resolve[i].load = models::LoadOp::kLoad;
        pass.resolved |= 1u << i;
      }
      pass.color[i].clear = {{0x80402010}};
      pass.color[i].load = s.load;
      pass.color[i].store = s.store;
      draw.color_outputs |= 0xfu << 4 * i;
      draw.blend[i].enable = s.blend;
      draw.blend[i].dst_color = models::BlendFactor::kOneMinusSrcAlpha;
    }
    pass.colors = s.colors;
    pass.samples = s.samples;
    draw.views[0].setup.samples = models::sample_grid(s.samples, 8);
    if (s.transparency.mode != models::Transparency::kNone) keep_fragments(s, pass, draw);
    frame.passes = {pass};
    frame.draws = {draw};
    for (std::uint32_t i = 0; i < 4; ++i) fill(warps[WarpSlotId(i)], i, s);
    set_cache(params, s.lines, s.ways, s.misses);
    params.half_blend_turns.set(s.half_blend_turns);
    params.float_blend_turns.set(s.float_blend_turns);
    unit = std::make_unique<Rop>("unit", context(), params, warps);
    add(*unit);
    feed(unit->order_in, s.order);
    feed(unit->done_in[0], s.done);
    feed(unit->late_in, s.late);
    late = &drain<LateToken>(unit->late_out, [](const LateToken& t) {
      return 100 * static_cast<unsigned>(t.kind) + t.slot.index();
    });
    released =
        &drain<WarpReleaseToken>(unit->release_out, [](const WarpReleaseToken& t) { return t.slot.index(); });
    drain<ReleaseToken>(unit->load_out, [](const ReleaseToken& t) { return t.slot; });
    synced = &drain<ReleaseToken>(unit->sync_out, [](const ReleaseToken& t) { return t.sequence; });
    retired = &drain<RetireToken>(unit->retire_out, [](const RetireToken& t) {
      return 100 * static_cast<unsigned>(t.kind) +
             (t.kind == TokenKind::kPassEnd ? t.part.pass().index() : t.part.draw().index());
    });
    memory = &serve(unit->memory_port(), s.memory_latency);
  }
  /// The draw is order-independent, and a pixel may have sixteen nodes of it.
  void keep_fragments(const Setup& s, PassState& pass, DrawState& draw) {
    draw.order_independent = true;
    draw.blend[0] = {true,
                     models::BlendFactor::kSrcAlpha,
                     models::BlendFactor::kOneMinusSrcAlpha,
                     models::BlendFactor::kOne,
                     models::BlendFactor::kOneMinusSrcAlpha,
                     models::BlendOp::kAdd,
                     models::BlendOp::kAdd,
                     0xf};
    TransparencyPass& kept = pass.transparency;
    kept.mode = s.transparency.mode;
    kept.layers = s.transparency.layers;
    for (AttachmentState* const state : {&kept.hidden, &kept.pool}) {
      state->store = models::StoreOp::kDiscard;
      state->read_later = state->encodes = false;
    }
    const auto planes = static_cast<std::uint32_t>(s.samples * kept.layers);
    kept.hidden.surface = models::allocate_surface(
        device, 16, 8, kept.lists() ? 1 : planes, kept.lists() ? models::kListHeadBytes : models::kNodeBytes);
    kept.pool.surface = models::allocate_surface(device, 8, 8 * 2 * 16, 1, models::kNodeBytes);
  }
  static void fill(WarpSlot& warp, std::uint32_t number, const Setup& s) {
    warp.quads = 8;
    warp.covered = ~0u;
    warp.alive = s.alive;
    warp.late = s.late_warps;
    warp.packed_samples = std::uint64_t{32} * static_cast<std::uint64_t>(s.samples);
    warp.samples.fill(static_cast<std::uint8_t>(((1u << s.samples) - 1) & s.mask));
    for (std::size_t q = 0; q < 8; ++q) {
      const auto i = static_cast<std::uint16_t>(q);
      if (number % 2 == 0)
        warp.quad[q] = {0, static_cast<std::uint16_t>(2 * (i % 4)), static_cast<std::uint16_t>(2 * (i / 4))};
      else
        warp.quad[q] = {0, static_cast<std::uint16_t>(8 + 4 * (i % 2)),
                        static_cast<std::uint16_t>(2 * (i / 2))};
    }
    for (std::size_t lane = 0; lane < 32; ++lane)
      warp.depth[lane] = static_cast<float>((3 * number + lane) % 5) / 5.0f;
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t lane = 0; lane < 32; ++lane)
        for (std::size_t color = 0; color < s.colors; ++color)
          warp.color[color][c][lane] = static_cast<float>((7 * number + 3 * c + lane + color) % 16) / 16.0f;
    }
  }
  [[nodiscard]] std::uint64_t image() const {
    std::string bytes;
    if (frame.passes[0].colors == 0) return 0;
    for (const std::uint8_t byte : models::detile_rgba8(device, frame.passes[0].picture().surface))
      bytes += static_cast<char>(byte);
    return std::hash<std::string>{}(bytes);
  }
  [[nodiscard]] std::uint64_t digest() const override { return Bench::digest() ^ image(); }
  Rop::Params params;
  WarpStore warps;
  std::unique_ptr<Rop> unit;
  StubSink<LateToken>* late = nullptr;
  StubSink<WarpReleaseToken>* released = nullptr;
  StubSink<ReleaseToken>* synced = nullptr;
  StubSink<RetireToken>* retired = nullptr;
  StubMemory* memory = nullptr;
};

inline OrderToken warp(std::uint32_t slot, std::uint64_t sync = 0) {
  return {TokenKind::kWork, DrawId(0), WarpSlotId(slot), sync};
}
inline const OrderToken kBegin{TokenKind::kPassBegin, PassId(0), {}, 0},
    kDrawEnd{TokenKind::kDrawEnd, DrawId(0), {}, 0}, kPassEnd{TokenKind::kPassEnd, PassId(0), {}, 0};
/// The warp in this slot is shaded.
inline Timed<FragmentDoneToken> done(std::int64_t cycle, std::uint32_t slot) {
  return {cycle, {WarpSlotId(slot)}};
}
inline std::string released(const RopBench& b) { return b.released->text(); }

/// Four warps, all shaded by cycle 20, and the depth unit's answer to the flush at cycle 300.
inline RopBench::Setup whole_pass() {
  return {
      .order =
          {{0, kBegin}, {0, warp(0)}, {0, warp(1)}, {0, warp(2)}, {0, warp(3)}, {0, kDrawEnd}, {0, kPassEnd}},
      .done = {done(20, 2), done(20, 0), done(20, 3), done(20, 1)},
      .late = {{300, {TokenKind::kPassEnd, {}}}}};
}

}  // namespace quadrille::hw::bench
