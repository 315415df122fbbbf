/// The loop over triangles and quads of a band of rows, one quad at a time.
#include "models/reference/fragments.h"

#include <algorithm>
#include <limits>

#include "models/reference/output.h"
#include "models/reference/parallel.h"
#include "models/reference/sample_tests.h"
#include "models/reference/transparency.h"

namespace quadrille::models::reference {
namespace {

constexpr int kBandRows = 16;

/// A fragment shader input and the vertex shader output that feeds it (number among the outputs; none: reads
/// zero).
struct Link {
  Port input;
  std::size_t output = 0;
  bool fed = false;
};

std::vector<Link> link_varyings(const ShaderProgram& vertex, const ShaderProgram& fragment) {
  std::vector<Link> links;
  for (const Port& input : fragment.inputs) {
    Link link{input, 0, false};
    for (std::size_t i = 0; i < vertex.outputs.size(); ++i) {
      if (vertex.outputs[i].location == input.location && vertex.outputs[i].component == input.component)
        link.output = i, link.fed = true;
    }
    links.push_back(link);
  }
  return links;
}

/// Samples of four pixels, a bit each.
using Samples = std::array<unsigned, kLanes>;

/// A place in the original triangle.
struct Place {
  double z = 0, inv_w = 0;
  std::array<double, 2> perspective{}, linear{};  ///< (b1, b2)
};

/// Four fragments: which are covered, and where they are in the original triangle.
struct Quad {
  int x = 0, y = 0;
  double from_centre_x = 0, from_centre_y = 0;  ///< where its fragments lie
  std::uint32_t sample = 0;                     ///< of fragments by sample
  Samples covered{};
  std::array<std::array<double, 8>, kLanes> sample_z{};
  std::array<Place, kLanes> at{}, centroid{};
  std::array<double, kLanes> part{};                  ///< covered by a smooth line
  std::array<std::array<double, 2>, kLanes> point{};  ///< coordinates within a point
};

/// Draws all triangles within one band after another, in order.
class BandWorker {
 public:
  BandWorker(const FragmentWork& work, Result& result)
      : work_(work), state_(*work.state), result_(result), tests_(state_, work.float_depth, result) {
    for (std::array<Slot, 4>& slots : color_slots_) slots.fill(kNoSlot);
    second_slots_.fill(kNoSlot);
    if (work.fragment_shader == nullptr) return;
    program_ = work.fragment_shader->program;
    lanes_ = work.fragment_shader->lanes();
    links_ = link_varyings(*work.vertex_shader->program, *program_);
    for (const Port& port : program_->outputs) {
      if (port.location >= kMaxColorAttachments || port.component >= 4) continue;
      (port.index == 1 ? second_slots_ : color_slots_[port.location])[port.component] = port.slot;
    }
  }

  void operator()(std::size_t band) {
    const int first = static_cast<int>(band) * kBandRows, last = first + kBandRows - 1;
    for (const WindowTriangle& t : work_.triangles) {
      if (t.last_y < first || t.first_y > last) continue;
      bias_ = tests_.bias_of(t);
      for (int y = std::max(first, t.first_y & ~1); y <= std::min(last, t.last_y); y += 2) {
        for (int x = t.first_x & ~1; x <= t.last_x; x += 2) draw_quad(t, x, y);
      }
    }
  }

 private:
  using Depths = std::array<std::array<double, 8>, kLanes>;  ///< by pixel and sample

  [[nodiscard]] bool in_bounds(const WindowTriangle& t, int x, int y) const {
    const PixelBounds& b = work_.bounds[t.viewport];
    return x >= b.first_x && x <= b.last_x && y >= b.first_y && y <= b.last_y;
  }

  void draw_quad(const WindowTriangle& t, int x, int y) {
    Quad quad;
    quad.x = x, quad.y = y;
    std::array<SamplePlace, kLanes> places;
    for (int lane = 0; lane < kLanes; ++lane) {
      const int px = x + (lane & 1), py = y + (lane >> 1);
      places[static_cast<std::size_t>(lane)] = locate_sample(t, {px, py});
      if (in_bounds(t, px, py)) cover(t, places[static_cast<std::size_t>(lane)], quad, lane);
    }
    if (!any(quad.covered)) return;
    if (by_sample()) return draw_samples(t, quad);
    place_quad(t, places, quad);
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      quad.centroid[lane] = centroid_of(t, quad, static_cast<int>(lane));
    shade_and_write(t, quad);
  }

  [[nodiscard]] bool by_sample() const {
    return state_.samples > 1 &&
           (state_.pipeline->sample_shading || (program_ != nullptr && program_->by_sample));
  }

  /// A quad for each sample, of those pixels that have it.
  void draw_samples(const WindowTriangle& t, const Quad& all) {
    for (std::uint32_t s = 0; s < state_.samples; ++s) {
      Quad quad = all;
      quad.sample = s;
      std::array<SamplePlace, kLanes> places;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        quad.covered[lane] &= 1u << s;
        const SampleAt at = sample_of_lane(quad, static_cast<int>(lane), s);
        quad.from_centre_x = at.from_centre_x, quad.from_centre_y = at.from_centre_y;
        places[lane] = locate_sample(t, at);
      }
      if (!any(quad.covered)) continue;
      place_quad(t, places, quad);
      quad.centroid = quad.at;
      shade_and_write(t, quad);
    }
  }

  [[nodiscard]] SampleAt sample_of_lane(const Quad& quad, int lane, std::uint32_t sample) const {
    return sample_at(quad.x + (lane & 1), quad.y + (lane >> 1), state_.samples, sample);
  }

  static void place_quad(const WindowTriangle& t, const std::array<SamplePlace, kLanes>& places, Quad& quad) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      quad.at[lane] = place_of(t, places[lane].weights);
      quad.part[lane] = places[lane].part, quad.point[lane] = places[lane].point;
    }
  }

  /// The first covered sample, unless all are.
  [[nodiscard]] Place centroid_of(const WindowTriangle& t, const Quad& quad, int lane) const {
    const auto l = static_cast<std::size_t>(lane);
    const unsigned covered = quad.covered[l];
    if (covered == 0 || covered == (1u << state_.samples) - 1) return quad.at[l];
    const auto first = static_cast<std::uint32_t>(std::countr_zero(covered));
    return place_of(t, locate_sample(t, sample_of_lane(quad, lane, first)).weights);
  }

  [[nodiscard]] static bool any(const Samples& samples) {
    return std::ranges::any_of(samples, [](unsigned s) { return s != 0; });
  }

  /// Which samples of a pixel, and their depths.
  void cover(const WindowTriangle& t, const SamplePlace& centre, Quad& quad, int lane) {
    const auto l = static_cast<std::size_t>(lane);
    for (std::uint32_t s = 0; s < state_.samples; ++s) {
      if ((state_.pipeline->sample_mask >> s & 1u) == 0) continue;
      const SampleAt at = sample_of_lane(quad, lane, s);
      const SamplePlace place = state_.samples == 1 ? centre : locate_sample(t, at);
      if (!place.covered) continue;
      quad.covered[l] |= 1u << s;
      quad.sample_z[l][s] = bias_;
      for (std::size_t i = 0; i < 3; ++i) quad.sample_z[l][s] += place.weights[i] * t.z[i];
    }
  }

  /// [VK1.3 #primsrast-polygons-basic: interpolation of data across polygons]
  static Place place_of(const WindowTriangle& t, const std::array<double, 3>& weights) {
    Place at;
    for (std::size_t i = 0; i < 3; ++i) {
      at.z += weights[i] * t.z[i];
      at.inv_w += weights[i] * t.inv_w[i];
    }
    for (std::size_t b = 0; b < 2; ++b) {
      for (std::size_t i = 0; i < 3; ++i) {
        at.perspective[b] += weights[i] * t.inv_w[i] * t.barycentric[i][b];
        at.linear[b] += weights[i] * t.screen_barycentric[i][b];
      }
      at.perspective[b] /= at.inv_w;
    }
    return at;
  }

  void shade_and_write(const WindowTriangle& t, const Quad& quad) {
    Samples alive = quad.covered;
    Depths depth{};
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      for (std::uint32_t s = 0; s < state_.samples; ++s)
        depth[lane][s] = tests_.final_depth(quad.sample_z[lane][s], bias_ != 0, t.viewport);
    const bool early = program_ != nullptr && program_->early_fragment_tests;
    const bool shader_depth = program_ != nullptr && program_->builtins.frag_depth != kNoSlot && !early;
    const bool late =
        !early && (shader_depth || limits_coverage() || (program_ != nullptr && program_->discards));
    if (!late) alive = test_and_write_depth(t, quad, depth, alive);
    if (!any(alive)) return;
    if (program_ != nullptr) {
      shade(t, quad);
      if (shader_depth) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          const double z = lanes_.at(program_->builtins.frag_depth)->f(static_cast<int>(lane));
          depth[lane].fill(tests_.final_depth(z, false, t.viewport));
        }
      }
      note_discards(quad);
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        if ((lanes_.killed >> lane & 1u) != 0) alive[lane] = 0;
      if (limits_coverage())
        for (std::size_t lane = 0; lane < kLanes; ++lane) alive[lane] &= kept_samples(static_cast<int>(lane));
    }
    if (late) alive = test_and_write_depth(t, quad, depth, alive);
    write(t, quad, alive, depth);
  }

  /// May a fragment lose samples when it has been shaded?
  [[nodiscard]] bool limits_coverage() const {
    return program_ != nullptr &&
           (state_.pipeline->alpha_to_coverage || program_->builtins.sample_mask != kNoSlot);
  }
  [[nodiscard]] unsigned kept_samples(int lane) {
    unsigned kept = ~0u;
    if (program_->builtins.sample_mask != kNoSlot) kept = lanes_.at(program_->builtins.sample_mask)->u(lane);
    const Slot alpha = color_slots_[0][3];
    if (!state_.pipeline->alpha_to_coverage || alpha == kNoSlot) return kept;
    for (std::uint32_t s = 0; s < state_.samples; ++s) {
      const double least = state_.samples == 1 ? 0.5 : static_cast<double>(s) / state_.samples;
      if (!(lanes_.at(alpha)->f(lane) > least)) kept &= ~(1u << s);
    }
    return kept;
  }

  [[nodiscard]] std::size_t pixel(const Quad& quad, std::size_t lane) const {
    return (static_cast<std::size_t>(quad.y) + lane / 2) * result_.width + static_cast<std::size_t>(quad.x) +
           lane % 2;
  }

  /// Samples that pass.
  Samples test_and_write_depth(const WindowTriangle& t, const Quad& quad, const Depths& depth,
                               Samples alive) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      for (std::uint32_t s = 0; s < state_.samples; ++s) {
        if ((alive[lane] >> s & 1u) == 0) continue;
        if (!tests_.test_and_write(t.front, pixel(quad, lane) * state_.samples + s, depth[lane][s]))
          alive[lane] &= ~(1u << s);
      }
    }
    return alive;
  }

  void note_discards(const Quad& quad) {
    if (!program_->discards) return;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (quad.covered[lane] == 0) continue;
      const std::size_t at = pixel(quad, lane);
      result_.alpha_margin[at] =
          std::min(result_.alpha_margin[at], static_cast<float>(lanes_.discard_margin[lane]));
    }
  }

  void shade(const WindowTriangle& t, const Quad& quad) {
    for (const Link& link : links_) feed(link, t, quad);
    feed_builtins(t, quad);
    lanes_.killed = 0;
    lanes_.discard_margin.fill(std::numeric_limits<double>::infinity());
    execute(*program_, lanes_, kAllLanes);
  }

  void feed(const Link& link, const WindowTriangle& t, const Quad& quad) {
    Cell& cell = *lanes_.at(link.input.slot);
    const auto bits = [&](std::size_t corner) {
      return link.fed ? work_.vertices->outputs[t.vertices[corner] * work_.vertices->ports + link.output]
                      : std::uint64_t{0};
    };
    if (link.input.kind != ScalarKind::kFloat || link.input.interpolation == Interpolation::kFlat) {
      cell.bits.fill(bits(0));  // the provoking vertex is the first
      return;
    }
    const double a0 = std::bit_cast<double>(bits(0)), a1 = std::bit_cast<double>(bits(1)),
                 a2 = std::bit_cast<double>(bits(2));
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Place& at = link.input.centroid ? quad.centroid[lane] : quad.at[lane];
      const auto& place = link.input.interpolation == Interpolation::kLinear ? at.linear : at.perspective;
      cell.set_f(static_cast<int>(lane), a0 + place[0] * (a1 - a0) + place[1] * (a2 - a0));
    }
  }

  void feed_builtins(const WindowTriangle& t, const Quad& quad) {
    const BuiltinSlots& b = program_->builtins;
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      if (b.frag_coord != kNoSlot) {
        Cell* coord = lanes_.at(b.frag_coord);
        coord[0].set_f(lane, quad.x + (lane & 1) + 0.5 + quad.from_centre_x);
        coord[1].set_f(lane, quad.y + (lane >> 1) + 0.5 + quad.from_centre_y);
        coord[2].set_f(lane, quad.at[l].z + bias_);
        coord[3].set_f(lane, quad.at[l].inv_w);
      }
      if (b.point_coord != kNoSlot) {
        lanes_.at(b.point_coord)[0].set_f(lane, quad.point[l][0]);
        lanes_.at(b.point_coord)[1].set_f(lane, quad.point[l][1]);
      }
      if (b.sample_id != kNoSlot) lanes_.at(b.sample_id)->set_u(lane, quad.sample);
      if (b.sample_position != kNoSlot) {
        lanes_.at(b.sample_position)[0].set_f(lane, 0.5 + quad.from_centre_x);
        lanes_.at(b.sample_position)[1].set_f(lane, 0.5 + quad.from_centre_y);
      }
      if (b.sample_mask_in != kNoSlot) lanes_.at(b.sample_mask_in)->set_u(lane, quad.covered[l]);
      if (b.front_facing != kNoSlot) lanes_.at(b.front_facing)->set_u(lane, t.front ? 1u : 0u);
      if (b.primitive_id != kNoSlot) lanes_.at(b.primitive_id)->set_u(lane, t.primitive);
    }
  }

  void write(const WindowTriangle& t, const Quad& quad, const Samples& alive, const Depths& depth) {
    if (program_ == nullptr) return;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      for (std::uint32_t s = 0; s < state_.samples; ++s) {
        if ((alive[lane] >> s & 1u) == 0) continue;
        const std::size_t at = pixel(quad, lane) * state_.samples + s;
        for (std::size_t color = 0; color < state_.colors.size(); ++color)
          write_color(t, color, at, static_cast<int>(lane), quad.part[lane], depth[lane][s]);
      }
    }
  }

  /// An attachment that the program has no output for keeps what it holds.
  void write_color(const WindowTriangle& t, std::size_t color, std::size_t at, int lane, double part,
                   double depth) {
    const std::array<Slot, 4>& slots = color_slots_[color];
    const traces::BlendState& state = state_.pipeline->blend[color];
    if (state.write_mask == 0 || std::ranges::all_of(slots, [](Slot s) { return s == kNoSlot; })) return;
    ColorTarget& target = *state_.colors[color];
    const bool integers = traces::is_integer_format(target.format);
    std::array<double, 4> source{};
    const auto output = [&](Slot slot) {
      if (slot == kNoSlot) return 0.0;
      const Cell& cell = *lanes_.at(slot);
      return integers ? integer_value(target.format, cell.u(lane)) : cell.f(lane);
    };
    std::array<double, 4> second{};
    for (std::size_t c = 0; c < 4; ++c) source[c] = output(slots[c]), second[c] = output(second_slots_[c]);
    if (!integers) source[3] *= part;
    if (color == 0)
      result_.triangle_id[at / state_.samples] = std::uint64_t{state_.number} << 32 | t.primitive;
    if (state_.pipeline->order_independent)
      return keep_fragment(state, target.format, depth, source, (*state_.kept)[at]);
    const auto linear = target.linear.begin() + static_cast<std::ptrdiff_t>(4 * at);
    StoredColor before{target.code[at], {}};
    std::copy_n(linear, 4, before.linear.begin());
    const StoredColor after =
        blend(state, state_.pipeline->blend_shared, target.format, source, second, before);
    target.code[at] = after.code;
    std::copy_n(after.linear.begin(), 4, linear);
  }

  double bias_ = 0;  ///< of the triangle in work
  const FragmentWork& work_;
  const DrawState& state_;
  Result& result_;
  SampleTests tests_;
  const ShaderProgram* program_ = nullptr;
  Lanes lanes_;
  std::vector<Link> links_;
  std::array<std::array<Slot, 4>, kMaxColorAttachments> color_slots_;  ///< by attachment and component
  std::array<Slot, 4> second_slots_;  ///< of the second colour for attachment 0
};

}  // namespace

void draw_fragments(const FragmentWork& work, Result& result) {
  if (work.triangles.empty()) return;
  int first = std::numeric_limits<int>::max(), last = 0;
  for (const WindowTriangle& t : work.triangles)
    first = std::min(first, t.first_y), last = std::max(last, t.last_y);
  const int first_band = first / kBandRows, bands = last / kBandRows - first_band + 1;
  run_tasks(static_cast<std::size_t>(bands), work.threads, [&] {
    return [worker = BandWorker(work, result), first_band](std::size_t band) mutable {
      worker(band + static_cast<std::size_t>(first_band));
    };
  });
}

}  // namespace quadrille::models::reference
