#include "tests/pipeline/shrink_stream.h"

#include "models/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace quadrille::pipeline::test {
namespace {

using traces::Command;
using traces::CommandStream;
using traces::Pipeline;

/// A command that goes away: one of a draw, or a query around it.
bool of_a_draw(const Command& c) { return std::holds_alternative<traces::Draw>(c); }

/// Ways of making a pipeline simpler.
using Simpler = void (*)(Pipeline&);
constexpr std::array<Simpler, 18> kSimpler{
    [](Pipeline& p) { p.blend = {}; },
    [](Pipeline& p) {
      for (traces::BlendState& b : p.blend) b.enable = false;
    },
    [](Pipeline& p) {
      for (traces::BlendState& b : p.blend) b.write_mask = 0xf;
    },
    [](Pipeline& p) { p.blend_shared = {}; },
    [](Pipeline& p) { p.stencil = {}; },
    [](Pipeline& p) { p.stencil.front = {}; },
    [](Pipeline& p) { p.stencil.back = {}; },
    [](Pipeline& p) { p.depth = {}; },
    [](Pipeline& p) { p.depth.write = false; },
    [](Pipeline& p) { p.depth_bounds = {}; },
    [](Pipeline& p) { p.depth_bias = {}; },
    [](Pipeline& p) { p.depth_clamp = false; },
    [](Pipeline& p) { p.cull = traces::CullMode::kNone; },
    [](Pipeline& p) { p.sample_mask = ~0u; },
    [](Pipeline& p) { p.alpha_to_coverage = p.sample_shading = false; },
    [](Pipeline& p) { p.fragment_shader = 0; },
    [](Pipeline& p) { p.primitive_restart = false; },
    [](Pipeline& p) {
      p.primitive_restart = false;
      p.topology = traces::Topology::kTriangleList;
    },
};

class Shrinker {
 public:
  Shrinker(CommandStream stream, const std::function<bool(const CommandStream&)>& fails)
      : stream_(std::move(stream)), fails_(fails) {}

  CommandStream run() {
    drop_passes();
    drop_draws();
    simplify_draws();
    simplify_pipelines();
    drop_draws();
    return std::move(stream_);
  }

 private:
  /// Keeps a change that leaves the fault there.
  bool keep_if_it_fails(CommandStream changed) {
    if (changed == stream_) return false;
    try {
      traces::validate(changed);
      if (!fails_(changed)) return false;
    } catch (const UserError&) { return false; }
    stream_ = std::move(changed);
    return true;
  }

  void drop_passes() {
    for (std::size_t at = 0; at < stream_.commands.size(); ++at) {
      if (!std::holds_alternative<traces::BeginPass>(stream_.commands[at])) continue;
      std::size_t end = at;
      while (!std::holds_alternative<traces::EndPass>(stream_.commands[end])) ++end;
      CommandStream changed = stream_;
      // States that it sets stay.
      std::erase_if(changed.commands, [&, i = std::size_t{0}](const Command& c) mutable {
        const std::size_t number = i++;
        const bool bound = number == at || number == end || of_a_draw(c);
        return number >= at && number <= end && bound;
      });
      if (keep_if_it_fails(std::move(changed))) --at;
    }
  }

  /// Without draws number `first` to `first + count`.
  [[nodiscard]] CommandStream without(std::size_t first, std::size_t count) const {
    CommandStream changed = stream_;
    std::erase_if(changed.commands, [&, draw = std::size_t{0}](const Command& c) mutable {
      if (!of_a_draw(c)) return false;
      const std::size_t number = draw++;
      return number >= first && number < first + count;
    });
    return changed;
  }

  void drop_draws() {
    for (std::size_t part = draws_of(stream_); part > 0; part /= 2) {
      // The last ones first: what comes after the fault is of no account.
      for (std::size_t end = draws_of(stream_); end > 0; end -= std::min(end, part)) {
        const std::size_t first = end - std::min(end, part);
        (void)keep_if_it_fails(without(first, end - first));
      }
    }
  }

  void simplify_draws() {
    for (std::size_t at = 0; at < stream_.commands.size(); ++at) {
      if (!of_a_draw(stream_.commands[at])) continue;
      const auto change = [&](auto&& simpler) {
        CommandStream changed = stream_;
        simpler(std::get<traces::Draw>(changed.commands[at]));
        return keep_if_it_fails(std::move(changed));
      };
      change([](traces::Draw& d) { d.instances = std::min(d.instances, 1u); });
      while (change([](traces::Draw& d) { d.count = d.count > 5 ? d.count / 6 * 3 : d.count; })) {}
      while (change([](traces::Draw& d) {
        if (d.count <= 3) return;
        d.first += 3;
        d.count -= 3;
      })) {}
      while (change([](traces::Draw& d) { d.count -= std::min(d.count, 1u); })) {}
    }
  }

  void simplify_pipelines() {
    for (std::size_t i = 0; i < stream_.pipelines.size(); ++i) {
      for (const Simpler simpler : kSimpler) {
        CommandStream changed = stream_;
        simpler(changed.pipelines[i]);
        (void)keep_if_it_fails(std::move(changed));
      }
    }
  }

  CommandStream stream_;
  const std::function<bool(const CommandStream&)>& fails_;
};

}  // namespace

std::string states_of(const CommandStream& stream) {
  std::string text;
  traces::Index bound = traces::kNone;
  const auto say = [&](const char* what, auto value, auto usual) {
    if (value != usual) text += fmt::format(" {} {}", what, value);
  };
  const auto say_blend = [&](std::size_t i, const traces::BlendState& b) {
    if (b.enable)
      text +=
          fmt::format(" blend[{}] {}*{}+{}, {}*{}+{}", i, static_cast<int>(b.src_color),
                      static_cast<int>(b.dst_color), static_cast<int>(b.color), static_cast<int>(b.src_alpha),
                      static_cast<int>(b.dst_alpha), static_cast<int>(b.alpha));
    if (b.write_mask != 0xf) text += fmt::format(" mask[{}] {:#x}", i, b.write_mask);
  };
  for (const traces::Image& image : stream.images)
    if (image.is_attachment() && image.samples == 1)
      text += fmt::format("{} ", models::format_info(image.format).name);
  for (const Command& c : stream.commands) {
    if (const auto* bind = std::get_if<traces::BindPipeline>(&c)) bound = bind->pipeline;
    const auto* const draw = std::get_if<traces::Draw>(&c);
    if (draw == nullptr) continue;
    const Pipeline& p = stream.pipelines[bound];
    text += fmt::format("draw of {}, shader {}:", draw->count, p.fragment_shader);
    say("topology", static_cast<int>(p.topology), 0);
    say("cull", static_cast<int>(p.cull), 0);
    say("depth test", p.depth.test, false);
    say("depth write", p.depth.write, false);
    say("depth compare", static_cast<int>(p.depth.compare), static_cast<int>(Pipeline{}.depth.compare));
    say("depth bias", p.depth_bias.enable, false);
    say("stencil", p.stencil.test, false);
    say("logic", p.blend_shared.logic ? static_cast<int>(p.blend_shared.logic_op) : -1, -1);
    say("sample mask", p.sample_mask, ~0u);
    say("alpha to coverage", p.alpha_to_coverage, false);
    say("sample shading", p.sample_shading, false);
    for (std::size_t i = 0; i < p.blend.size(); ++i) say_blend(i, p.blend[i]);
    text += "; ";
  }
  return text;
}

std::size_t draws_of(const CommandStream& stream) {
  return static_cast<std::size_t>(std::ranges::count_if(stream.commands, of_a_draw));
}

CommandStream shrink(CommandStream stream, const std::function<bool(const CommandStream&)>& fails) {
  return Shrinker(std::move(stream), fails).run();
}

}  // namespace quadrille::pipeline::test
