/// Blending drift: ten thousand layers over one another, by format, beside exact arithmetic and what
/// rounding theory allows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/render.h"
#include "studies/experiments/experiment.h"
#include "studies/experiments/triangle_mesh.h"

namespace quadrille::studies::experiments {
namespace {

constexpr std::uint32_t kLayers = 10000, kSide = 16;

/// Layer k has colours of its own, and column x an alpha of its own.
constexpr const char* kLayerShader = R"(#version 450
layout(location = 0) out vec4 color;
void main() {
  float k = floor((1.0 - gl_FragCoord.z) * 16384.0);
  float alpha = exp2(-0.5 * floor(gl_FragCoord.x));
  color = vec4(fract(k * 0.375), fract(k * 0.28125), fract(k * 0.40625), alpha);
}
)";

std::array<double, 3> layer_color(std::uint32_t k) {
  const auto part = [&](double step) { return k * step - std::floor(k * step); };
  return {part(0.375), part(0.28125), part(0.40625)};
}

/// In single precision, as the shader's is.
double alpha_of(std::uint32_t column) {
  return static_cast<double>(std::exp2(-0.5F * static_cast<float>(column)));
}

/// Each before the ones that were drawn earlier; its depth is its number.
TriangleMesh layers_by_number() {
  TriangleMesh mesh{kSide, kSide, {}, {}};
  for (std::uint32_t k = 0; k < kLayers; ++k)
    mesh.rectangle(0, 0, kSide, kSide, 1 - (static_cast<float>(k) + 0.5F) / 16384);
  return mesh;
}

/// Half the spacing of what a channel can store below 1, and what blending in single precision may lose.
struct Target {
  traces::Format format;
  std::array<double, 3> half_spacing;
};
constexpr double kBlendLoss = 0x1p-23;  // two products and a sum, of at most 1 each

/// The worst drift of a column over all channels, and that over what theory allows.
struct Drift {
  double drift = 0, allowed = 0;
};

std::vector<Drift> measure(const Target& target) {
  const traces::CommandStream stream =
      stream_of(layers_by_number(),
                {.depth = true, .blends = true, .fragment_shader = kLayerShader, .format = target.format});
  const pipeline::FrameImage image = pipeline::render_functional_frame(stream, {}).image;
  std::vector<Drift> drifts(kSide);
  for (std::uint32_t x = 0; x < kSide; ++x) {
    const double alpha = alpha_of(x);
    for (std::size_t c = 0; c < 3; ++c) {
      double exact = 0;
      for (std::uint32_t k = 0; k < kLayers; ++k) exact = alpha * layer_color(k)[c] + (1 - alpha) * exact;
      const double stored = image.linear.empty() ? static_cast<double>(image.color[x] >> (8 * c) & 255U) / 255
                                                 : static_cast<double>(image.linear[x][c]);
      // Each layer adds its rounding and lets through 1 - alpha of what came before.
      const double allowed =
          (target.half_spacing[c] + kBlendLoss) * (1 - std::pow(1 - alpha, kLayers)) / alpha;
      const double drift = std::abs(stored - exact);
      if (drift / allowed >= drifts[x].drift / std::max(drifts[x].allowed, 1e-300))
        drifts[x] = {drift, allowed};
    }
  }
  return drifts;
}

}  // namespace

Result blend_drift(const Setting& setting) {
  const std::array<Target, 4> targets{{
      {traces::Format::kR8G8B8A8Unorm, {0.5 / 255, 0.5 / 255, 0.5 / 255}},
      {traces::Format::kB10G11R11Ufloat, {0x1p-8, 0x1p-8, 0x1p-7}},
      {traces::Format::kR16G16B16A16Float, {0x1p-12, 0x1p-12, 0x1p-12}},
      {traces::Format::kR32G32B32A32Float, {0x1p-25, 0x1p-25, 0x1p-25}},
  }};
  Result result;
  result.table.head = {"format", "alpha", "drift", "allowed", "part"};
  std::string data;
  for (const Target& target : targets) {
    const std::string name(models::format_info(target.format).name);
    setting.progress(name);
    const std::vector<Drift> drifts = measure(target);
    double worst = 0;
    for (std::uint32_t x = 0; x < kSide; ++x) {
      worst = std::max(worst, drifts[x].drift / drifts[x].allowed);
      data += fmt::format("{} {} {}\n", alpha_of(x), std::max(drifts[x].drift, 1e-12), drifts[x].allowed);
      if (x % 5 == 0)
        result.table.rows.push_back({name, fmt::format("{:.4g}", alpha_of(x)),
                                     fmt::format("{:.2g}", drifts[x].drift),
                                     fmt::format("{:.2g}", drifts[x].allowed),
                                     fmt::format("{:.2f}", drifts[x].drift / drifts[x].allowed)});
    }
    data += "\n\n";
    result.verdicts.push_back({name + ": worst drift over what rounding allows", worst, 0, 1});
  }
  result.remarks = {fmt::format(
      "{} layers, each with colours of its own, blended by *over*. A layer's rounding is at most half a "
      "spacing "
      "of the format, and each later layer lets 1 - alpha of it through: together at most half a spacing "
      "over "
      "alpha. Roundings of unlike colours cancel in part, so thin layers drift by about a tenth of that.",
      kLayers)};
  result.plot =
      "set logscale xy\nset xlabel 'alpha of a layer'\nset ylabel 'drift; thin: allowed'\nset grid\nset key "
      "outside\n$d << EOD\n" +
      data +
      "EOD\nplot for [i=0:3] $d index i using 1:2 with linespoints lw 2 lc i+1 title word('RGBA8 R11G11B10F "
      "RGBA16F RGBA32F', i + 1), for [i=0:3] $d index i using 1:3 with lines lw 1 lc i+1 notitle";
  return result;
}

}  // namespace quadrille::studies::experiments
