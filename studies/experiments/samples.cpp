/// Samples a pixel: what 2, 4 and 8 of them cost in cycles and bytes, and how much nearer the picture comes
/// to one of 64 samples; and the same when each sample is shaded for itself.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/rop/srgb.h"
#include "pipeline/render.h"
#include "studies/experiments/experiment.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

struct Way {
  std::uint32_t samples;
  bool supersampled;
};
constexpr Way kWays[] = {{1, false}, {2, false}, {4, false}, {8, false}, {2, true}, {4, true}, {8, true}};
constexpr std::size_t kMultisampled = 4;  ///< of them, before the others
constexpr int kIdealSide = 8;             ///< samples along a pixel's side

/// Linear values, three a pixel.
std::vector<double> linear_of(const std::vector<std::uint32_t>& pixels) {
  std::vector<double> linear;
  linear.reserve(3 * pixels.size());
  for (const std::uint32_t pixel : pixels)
    for (const int shift : {0, 8, 16})
      linear.push_back(models::decode_srgb8(static_cast<std::uint8_t>(pixel >> shift & 255u)));
  return linear;
}

std::vector<double> drawn(const traces::CommandStream& stream) {
  return linear_of(pipeline::render_functional_frame(stream, {}).image.color);
}

/// The mean of pictures whose viewports are moved by parts of a pixel: each is shaded for itself.
std::vector<double> ideal(const traces::CommandStream& stream) {
  std::vector<double> sum;
  traces::CommandStream shifted = stream;
  for (int place = 0; place < kIdealSide * kIdealSide; ++place) {
    const auto moved = [](int step) { return (static_cast<float>(step) + 0.5f) / kIdealSide - 0.5f; };
    for (std::size_t i = 0; i < stream.commands.size(); ++i) {
      const auto* const viewport = std::get_if<traces::SetViewport>(&stream.commands[i]);
      if (viewport == nullptr) continue;
      auto& to = std::get<traces::SetViewport>(shifted.commands[i]);
      to.x = viewport->x + moved(place % kIdealSide);
      to.y = viewport->y + moved(place / kIdealSide);
    }
    const std::vector<double> picture = drawn(shifted);
    sum.resize(picture.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += picture[i] / (kIdealSide * kIdealSide);
  }
  return sum;
}

double error_between(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, a.size())));
}

double megabytes(const Readings& r) { return (r["memory.read_bytes"] + r["memory.write_bytes"]) / 1e6; }

/// One scene in every way.
struct Curve {
  std::vector<double> cycles, bytes, error;
};

Curve measure(const traces::CommandStream& plain, const Setting& setting) {
  std::vector<traces::CommandStream> streams;
  std::vector<Frame> frames;
  streams.reserve(std::size(kWays));
  for (const Way& way : kWays) {
    streams.push_back(plain);
    traces::use_samples(streams.back(), way.samples);
    if (way.supersampled) traces::use_sample_shading(streams.back());
    frames.push_back({&streams.back(), {}});
  }
  const std::vector<Readings> readings = draw(frames, setting);
  setting.progress("64 samples a pixel");
  const std::vector<double> wanted = ideal(plain);
  Curve curve;
  for (std::size_t i = 0; i < std::size(kWays); ++i) {
    curve.cycles.push_back(readings[i]["frame.cycles"]);
    curve.bytes.push_back(megabytes(readings[i]));
    curve.error.push_back(error_between(drawn(streams[i]), wanted));
  }
  return curve;
}

/// The way with as many samples, each pixel shaded once.
std::size_t multisampled_beside(std::size_t way) {
  return static_cast<std::size_t>(std::ranges::find(kWays, kWays[way].samples, &Way::samples) - kWays);
}

/// What each way must be beside another one.
void judge(const std::string& scene, const Curve& curve, Result& result) {
  const auto beside = [&](std::size_t i, std::size_t j, const std::string& what, double most) {
    result.verdicts.push_back(
        {fmt::format("{}: error of {}", scene, what), curve.error[i] / curve.error[j], 0, 1});
    result.verdicts.push_back(
        {fmt::format("{}: cycles of {}", scene, what), curve.cycles[i] / curve.cycles[j], 1, most});
  };
  for (std::size_t i = 1; i < kMultisampled; ++i)
    beside(i, i - 1, fmt::format("{} samples over {}", kWays[i].samples, kWays[i - 1].samples), 2);
  for (std::size_t i = kMultisampled; i < std::size(kWays); ++i)
    beside(i, multisampled_beside(i), fmt::format("{} samples, supersampled over not", kWays[i].samples),
           kWays[i].samples);
}

}  // namespace

Result samples(const Setting& setting) {
  Result result;
  result.table.head = {"scene",     "samples", "shaded",  "cycles",      "over 1",
                       "memory MB", "over 1",  "error %", "of that of 1"};
  std::string data, plot;
  for (const auto& [name, load] : setting.scenes) {
    setting.progress(name);
    const Curve curve = measure(load(), setting);
    for (std::size_t i = 0; i < std::size(kWays); ++i) {
      if (i == 0 || i == kMultisampled) {
        data += fmt::format("$s{} << EOD\n", result.table.rows.size());
        plot += fmt::format("{}$s{} using 1:2 with linespoints pointtype {} title {}",
                            plot.empty() ? "" : ", ", result.table.rows.size(), i == 0 ? 7 : 6,
                            quoted(i == 0 ? name : name + ", supersampled"));
      }
      result.table.rows.push_back(
          {name, fmt::format("{}", kWays[i].samples), kWays[i].supersampled ? "each sample" : "each pixel",
           fmt::format("{:.0f}", curve.cycles[i]), fmt::format("{:.2f}", curve.cycles[i] / curve.cycles[0]),
           fmt::format("{:.2f}", curve.bytes[i]), fmt::format("{:.2f}", curve.bytes[i] / curve.bytes[0]),
           fmt::format("{:.3f}", 100 * curve.error[i]),
           fmt::format("{:.2f}", curve.error[i] / curve.error[0])});
      data += fmt::format("{} {}\n", curve.cycles[i] / curve.cycles[0], 100 * curve.error[i]);
      if (i + 1 == kMultisampled || i + 1 == std::size(kWays)) data += "EOD\n";
    }
    judge(name, curve, result);
  }
  result.remarks = {
      "The error is the root of the mean square difference of linear colour values, in per cent of the full "
      "range, from "
      "the mean of 64 pictures whose viewports are moved by eighths of a pixel. Each of these is shaded for "
      "itself, so what textures and lights do within a pixel is part of the error. No number of samples "
      "takes "
      "that away while a pixel is shaded once; shading each sample does, at the cost of as many fragments.",
      "Bytes are those of the memory channels. A small picture whose planes fit the L2 cache moves next to "
      "none, so its "
      "bytes leap where they do not fit any more; in a larger one they grow less than the samples, since the "
      "planes of a "
      "tile stay in the colour and depth caches while it is drawn, and what was resolved is not written "
      "back."};
  result.plot =
      "set xlabel 'cycles, over those of one sample'\nset ylabel 'error, % of the full range'\nset yrange "
      "[0:*]\nset grid\n" +
      data + "plot " + plot;
  return result;
}

}  // namespace quadrille::studies::experiments
