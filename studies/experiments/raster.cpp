/// The end of the pipeline, one thing at a time: the bytes and fragments that Hi-Z, its least depth, fast
/// clear, blending and stencil save or cost, beside closed forms.
#include <fmt/format.h>

#include <algorithm>

#include "studies/experiments/experiment.h"
#include "studies/experiments/triangle_mesh.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

constexpr std::uint32_t kLayers = 4;

/// One figure of one frame, in bytes or fragments a pixel.
struct Case {
  std::string what, counter;
  traces::CommandStream stream;
  std::vector<std::string> settings;
  double expected = 0;
};

/// Layers of one triangle each, which reaches beyond the frame: no tile is drawn to twice.
TriangleMesh triangle_layers(std::uint32_t width, std::uint32_t height, bool front_first) {
  TriangleMesh mesh{width, height, {}, {}};
  const auto right = static_cast<std::int32_t>(2 * width) * kGrid,
             bottom = static_cast<std::int32_t>(2 * height) * kGrid;
  for (std::uint32_t i = 0; i < kLayers; ++i) {
    const std::uint32_t place = front_first ? i : kLayers - 1 - i;
    const float depth = (static_cast<float>(place) + 1) / (kLayers + 1);
    const auto first = static_cast<std::uint32_t>(mesh.corners.size());
    mesh.corners.insert(mesh.corners.end(), {{0, 0, depth}, {right, 0, depth}, {0, bottom, depth}});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

enum class Order : std::uint8_t { kFrontToBack, kBackToFront };

class Cases {
 public:
  Cases(std::uint32_t width, std::uint32_t height) : width_(width), height_(height) {}
  [[nodiscard]] const std::vector<Case>& all() const { return cases_; }

  void add_depth() {
    using enum Order;
    depth("back to front, cleared", kBackToFront, {}, {kLayers - 1, kLayers});
    depth("back to front, least depths kept", kBackToFront, {"coarse_raster.hiz_min=true"}, {0, kLayers});
    depth("front to back, Hi-Z", kFrontToBack, {}, {0, 1});
    depth("front to back, no Hi-Z", kFrontToBack, {"coarse_raster.hiz=false"}, {kLayers - 1, 1});
    // The second pass reads what the first one left, or clears it again.
    for (const bool loads : {false, true}) {
      traces::CommandStream stream = twice(layers_of(kBackToFront, {.depth = true}), loads);
      add(fmt::format("two passes, depth {}", loads ? "loaded" : "cleared"), "depth.read_bytes", stream,
          {"coarse_raster.hiz=false"}, 4.0 * (2 * (kLayers - 1) + (loads ? 1 : 0)));
    }
  }

  void add_color() {
    for (const bool blends : {false, true}) {
      for (const bool loads : {false, true}) {
        const double read_layers = blends ? 2 * (kLayers - 1) + (loads ? 1 : 0) : 0;
        add(fmt::format("two passes, colour {}, {}", loads ? "loaded" : "cleared",
                        blends ? "blended" : "opaque"),
            "rop.read_bytes", twice(layers_of(Order::kBackToFront, {.blends = blends}), loads), {},
            4 * read_layers);
      }
    }
  }

  /// A first layer writes 1 into the left half's stencil; the others pass there alone.
  void add_stencil() {
    traces::CommandStream stream =
        layers_of(Order::kBackToFront, {.depth = true, .depth_format = traces::Format::kD24UnormS8Uint});
    traces::Pipeline& mask = stream.pipelines[0];
    mask.stencil.test = true;
    mask.stencil.front = {.compare = traces::CompareOp::kAlways, .pass = traces::StencilOp::kReplace};
    mask.stencil.front.reference = 1;
    mask.stencil.back = mask.stencil.front;
    mask.depth = {false, false, traces::CompareOp::kAlways};
    traces::Pipeline masked = mask;
    masked.stencil.front = {.compare = traces::CompareOp::kEqual};
    masked.stencil.front.reference = 1;
    masked.stencil.back = masked.stencil.front;
    masked.depth = {true, true, traces::CompareOp::kLess};
    stream.pipelines.push_back(masked);
    const auto draw = std::ranges::find_if(
        stream.commands, [](const auto& command) { return std::holds_alternative<traces::Draw>(command); });
    traces::Draw first = std::get<traces::Draw>(*draw);
    first.count = 3;
    const std::vector<traces::Command> before{traces::SetScissor{0, 0, width_ / 2, height_}, first,
                                              traces::SetScissor{0, 0, width_, height_},
                                              traces::BindPipeline{1}};
    stream.commands.insert(draw, before.begin(), before.end());
    add("stencil passes in half the frame", "frame.fragments_shaded", stream, {}, 0.5 + 0.5 * kLayers);
    add("stencil passes in half the frame", "depth.early_killed", stream, {}, 0.5 * kLayers);
    add("stencil passes in half the frame", "depth.stencil_written", stream, {}, 0.5);
  }

 private:
  struct Traffic {
    double read, written;  ///< layers
  };
  [[nodiscard]] traces::CommandStream layers_of(Order order, const DrawOptions& options) const {
    return stream_of(triangle_layers(width_, height_, order == Order::kFrontToBack), options);
  }
  /// The pass again, which loads its attachments or clears them; equal depths pass.
  [[nodiscard]] static traces::CommandStream twice(traces::CommandStream stream, bool loads) {
    stream.pipelines[0].depth.compare = traces::CompareOp::kLessOrEqual;
    std::vector<traces::Command> again = stream.commands;
    auto& pass = std::get<traces::BeginPass>(again.front());
    if (loads) pass.depth.load = pass.colors[0].load = traces::LoadOp::kLoad;
    if (loads && pass.depth.image != traces::kNone) reset_depths(again, stream);
    stream.commands.insert(stream.commands.end(), again.begin(), again.end());
    return stream;
  }
  /// Loaded depths are those of the last layer: a pipeline of its own draws the layers over them.
  static void reset_depths(std::vector<traces::Command>& commands, traces::CommandStream& stream) {
    traces::Pipeline over = stream.pipelines[0];
    over.depth.compare = traces::CompareOp::kGreaterOrEqual;
    stream.pipelines.push_back(over);
    for (traces::Command& command : commands)
      if (auto* bind = std::get_if<traces::BindPipeline>(&command)) bind->pipeline = 1;
  }
  void depth(const std::string& what, Order order, const std::vector<std::string>& settings,
             const Traffic& traffic) {
    const traces::CommandStream stream = layers_of(order, {.depth = true});
    add(what, "depth.read_bytes", stream, settings, 4 * traffic.read);
    add(what, "depth.write_bytes", stream, settings, 4 * traffic.written);
  }
  void add(const std::string& what, const std::string& counter, const traces::CommandStream& stream,
           std::vector<std::string> settings, double expected) {
    settings.insert(settings.end(), {"gpu.channels=8"});
    cases_.push_back({what, counter, stream, std::move(settings), expected});
  }

  std::uint32_t width_, height_;
  std::vector<Case> cases_;
};

}  // namespace

Result raster(const Setting& setting) {
  Cases cases(setting.width, setting.height);
  cases.add_depth();
  cases.add_color();
  cases.add_stencil();
  std::vector<Frame> frames;
  frames.reserve(cases.all().size());
  for (const Case& c : cases.all()) frames.push_back({&c.stream, c.settings});
  const std::vector<Readings> read = draw(frames, setting);
  const double pixels = double{1} * setting.width * setting.height;
  Result result;
  result.table.head = {"case", "figure", "a pixel", "closed form", "over it", "cycles"};
  std::string data;
  for (std::size_t i = 0; i < cases.all().size(); ++i) {
    const Case& c = cases.all()[i];
    const double value = read[i][c.counter] / pixels;
    result.table.rows.push_back({c.what, c.counter, fmt::format("{:.3f}", value),
                                 fmt::format("{:.3f}", c.expected),
                                 c.expected > 0 ? fmt::format("{:.4f}", value / c.expected) : "",
                                 fmt::format("{:.0f}", read[i]["frame.render_cycles"])});
    result.verdicts.push_back(
        {c.what + ": " + c.counter + " a pixel" + (c.expected > 0 ? ", over closed form" : ""),
         c.expected > 0 ? value / c.expected : value, c.expected > 0 ? 0.98 : 0, c.expected > 0 ? 1.02 : 0});
    data += quoted(c.what + ": " + c.counter) + fmt::format(" {} {}\n", value, c.expected);
  }
  result.remarks = {fmt::format(
      "{} layers over the whole frame, larger than the caches: each layer that is tested reads 4 bytes a "
      "pixel "
      "unless Hi-Z decides for the tile or a clear is still a mark, and each that passes writes 4. Blending "
      "reads the colour of every layer but the first after a clear.",
      kLayers)};
  result.plot =
      "set style data histograms\nset style fill solid 0.8\nset ylabel 'bytes or fragments a pixel'\nset "
      "yrange "
      "[0:*]\nset xtics rotate by -30 font ',7'\nset grid y\nset key outside top center horizontal\n$d << "
      "EOD\n" +
      data + "EOD\nplot $d using 2:xtic(1) title 'simulated', '' using 3 title 'closed form'";
  return result;
}

}  // namespace quadrille::studies::experiments
