/// Depth precision: what is stored beside exact arithmetic, and from where on two surfaces cannot be told
/// apart, by format, ratio of the planes and direction.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/base/format.h"
#include "pipeline/render.h"
#include "studies/experiments/experiment.h"
#include "studies/stability/stream_builder.h"

namespace quadrille::studies::experiments {
namespace {

using stability::Corners;
using stability::StreamBuilder;

constexpr std::uint32_t kColumns = 64, kRows = 32, kCell = 4;  ///< cells and their sides, pixels
constexpr double kNear = 0.5;
constexpr float kHalfRounding = 0x1p-24F;  ///< of a float32 operation, relative

struct Planes {
  double ratio = 10;  ///< far over near
  bool reversed = false;
  [[nodiscard]] double far() const { return kNear * ratio; }
  /// depth = a + b / distance, as the matrix has them.
  [[nodiscard]] float a() const {
    return static_cast<float>(reversed ? -kNear / (far() - kNear) : far() / (far() - kNear));
  }
  [[nodiscard]] float b() const {
    const double plane = far() * kNear / (far() - kNear);
    return static_cast<float>(reversed ? plane : -plane);
  }
  [[nodiscard]] double depth(double distance) const {
    return static_cast<double>(a()) + static_cast<double>(b()) / distance;
  }
};

/// Two surfaces in a cell: one at a distance, and behind it another that is farther by a part of that.
struct Cell {
  float near = 0, far = 0;
};

/// Distances grow from column to column, and from row to row the surfaces come closer.
Cell cell_at(std::uint32_t column, std::uint32_t row, const Planes& planes) {
  const double distance = kNear * std::pow(planes.ratio, (column + 0.5) / kColumns);
  const double apart = std::exp2(-1 - 0.75 * row);
  return {static_cast<float>(distance), static_cast<float>(std::min(distance * (1 + apart), planes.far()))};
}

/// Spacing of what the format can store around a depth.
double spacing(traces::Format format, double depth) {
  const models::FormatInfo& info = models::format_info(format);
  if (info.numeric != models::Numeric::kFloat) return 1 / (std::exp2(info.component[0].bits) - 1);
  const double magnitude = std::max(std::abs(depth), 0x1p-126);
  return std::exp2(std::floor(std::log2(magnitude)) - 23);
}

/// By how much a stored depth may be off: half a spacing, and what float32 loses in the products and the sum
/// of the matrix, each rounded once, and in the division by w.
double allowed(traces::Format format, const Planes& planes, double distance) {
  const double depth = planes.depth(distance);
  const double lost = 3 * std::abs(static_cast<double>(planes.a())) +
                      2 * std::abs(static_cast<double>(planes.b())) / distance + 3 * std::abs(depth);
  return 0.5 * spacing(format, depth) + static_cast<double>(kHalfRounding) * lost;
}

Corners sheets(const Planes& planes, bool farther, const glm::vec4& color) {
  Corners corners;
  corners.reserve(std::size_t{kColumns} * kRows * 6);
  for (std::uint32_t row = 0; row < kRows; ++row) {
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const Cell cell = cell_at(column, row, planes);
      const float distance = farther ? cell.far : cell.near;
      const glm::vec2 low(2.0F * static_cast<float>(column) / kColumns - 1,
                          2.0F * static_cast<float>(row) / kRows - 1);
      const glm::vec2 high = low + glm::vec2(2.0F / kColumns, 2.0F / kRows);
      for (stability::Corner corner : stability::quad(low, high, 0, color)) {
        corner.position.x *= distance;
        corner.position.y *= distance;
        corner.position.z = -distance;
        corner.position.w = 1;
        corners.push_back(corner);
      }
    }
  }
  return corners;
}

glm::mat4 projection(const Planes& planes) {
  glm::mat4 m(0);
  m[0][0] = m[1][1] = 1;
  m[2][2] = -planes.a();
  m[2][3] = -1;
  m[3][2] = planes.b();
  return m;
}

/// What a frame showed.
struct Outcome {
  double worst_spacings = 0;  ///< greatest error of a stored depth, in spacings of its format there
  double worst_allowed = 0;   ///< the same over what is allowed
  int fights_too_early = 0;   ///< cells whose exact depths are further apart than both errors
  int close = 0, fights = 0;  ///< cells less than a quarter of a spacing apart, and those that fight
  /// The least part of the distance that is told apart in the last column, as all greater ones are.
  double least_far = 0;
  double least_far_exact = 0;  ///< where exact depths are a spacing apart there
};

Outcome measure(traces::Format format, const Planes& planes) {
  StreamBuilder builder("depth-precision", kColumns * kCell, kRows * kCell, true,
                        planes.reversed ? 0.0F : 1.0F);
  const auto compare = planes.reversed ? traces::CompareOp::kGreaterOrEqual : traces::CompareOp::kLessOrEqual;
  builder.state({.depth = {true, true, compare}});
  builder.draw(sheets(planes, false, {1, 0, 0, 1}), projection(planes));
  builder.draw(sheets(planes, true, {0, 1, 0, 1}), projection(planes));
  traces::CommandStream stream = builder.finish();
  for (traces::Image& image : stream.images)
    if ((image.usage & traces::kDepthAttachment) != 0) image.format = format;
  const pipeline::FrameImage image = pipeline::render_functional_frame(stream, {}).image;
  Outcome outcome;
  bool fought = false;  // in the last column, in this row or one of surfaces further apart
  for (std::uint32_t row = 0; row < kRows; ++row) {
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const Cell cell = cell_at(column, row, planes);
      const double near = planes.depth(static_cast<double>(cell.near)),
                   far = planes.depth(static_cast<double>(cell.far));
      const std::size_t pixel =
          std::size_t{row * kCell + kCell / 2} * kColumns * kCell + std::size_t{column * kCell + kCell / 2};
      const bool fights = (image.color[pixel] & 0xffU) == 0;
      const double apart = std::abs(far - near), step = spacing(format, near);
      if (fights && apart > allowed(format, planes, static_cast<double>(cell.near)) +
                                allowed(format, planes, static_cast<double>(cell.far)))
        ++outcome.fights_too_early;
      if (apart < step / 4) {
        ++outcome.close;
        outcome.fights += fights ? 1 : 0;
      }
      if (!fights) {
        const double error = std::abs(static_cast<double>(image.depth[pixel]) - near);
        outcome.worst_spacings = std::max(outcome.worst_spacings, error / step);
        outcome.worst_allowed =
            std::max(outcome.worst_allowed, error / allowed(format, planes, static_cast<double>(cell.near)));
      }
      if (column + 1 == kColumns) {
        const double part = static_cast<double>(cell.far) / static_cast<double>(cell.near) - 1;
        fought = fought || fights;
        if (!fought) outcome.least_far = part;
        if (apart >= step) outcome.least_far_exact = part;
      }
    }
  }
  return outcome;
}

std::string part_text(double part) { return part > 0 ? fmt::format("{:.2g}", part) : "none"; }

}  // namespace

Result depth_precision(const Setting& setting) {
  Result result;
  result.table.head = {"format",
                       "far : near",
                       "depth",
                       "worst error, spacings",
                       "of what is allowed",
                       "told apart at the far end, part of the distance",
                       "by exact depths",
                       "within 1/4 spacing: fight"};
  double worst = 0, early = 0, close = 0, fights = 0;
  std::string data;
  for (const traces::Format format :
       {traces::Format::kD16Unorm, traces::Format::kD24UnormS8Uint, traces::Format::kD32Float}) {
    for (const bool reversed : {false, true}) {
      for (const double ratio : {1e1, 1e2, 1e3, 1e5, 1e7, 1e9}) {
        const Outcome o = measure(format, {ratio, reversed});
        setting.progress(fmt::format("{} {}", models::format_info(format).name, ratio));
        worst = std::max(worst, o.worst_allowed);
        early += o.fights_too_early;
        close += o.close;
        fights += o.fights;
        result.table.rows.push_back(
            {std::string(models::format_info(format).name), fmt::format("{:.0e}", ratio),
             reversed ? "reversed" : "standard", fmt::format("{:.3g}", o.worst_spacings),
             fmt::format("{:.2f}", o.worst_allowed), part_text(o.least_far), part_text(o.least_far_exact),
             fmt::format("{} of {}", o.fights, o.close)});
        data += fmt::format("{} {}\n", ratio, o.least_far > 0 ? o.least_far : 1.0);
      }
      data += "\n\n";
    }
  }
  result.verdicts = {{"worst error of a stored depth over what rounding allows", worst, 0, 1},
                     {"surfaces further apart than both errors that fight", early, 0, 0},
                     {"part of the surfaces within a quarter of a spacing that fight",
                      close > 0 ? fights / close : 0, 0.25, 1}};
  result.remarks = {
      "Two surfaces fight where the one behind, drawn later with \"less or equal\", replaces the one before "
      "it. "
      "A depth is a + b / distance; near the far plane of a wide range standard depths are all close to 1, "
      "where "
      "even floats are 2^-24 apart, while reversed ones are close to 0, where floats are dense. With 24 bits "
      "and more most of a standard depth's error is float32's, in the matrix and the division, and not the "
      "format's."};
  result.plot =
      "set logscale xy\nset format xy '%.0e'\nset xlabel 'far : near'\nset ylabel 'told apart at the far "
      "end, part of the "
      "distance'\nset grid\nset key outside\n$d << EOD\n" +
      data +
      "EOD\nplot for [i=0:5] $d index i with linespoints lw 2 title "
      "word('D16 D16-reversed D24 D24-reversed D32F D32F-reversed', i + 1)";
  return result;
}

}  // namespace quadrille::studies::experiments
