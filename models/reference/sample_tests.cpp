#include "models/reference/sample_tests.h"

#include <algorithm>
#include <cmath>

#include "models/reference/output.h"

namespace quadrille::models::reference {
namespace {

/// What depths are apart in an attachment; of floats, those of this size.
double depth_step(traces::Format format, double size) {
  constexpr int kMantissaBits = 23;
  const FormatInfo& info = format_info(format);
  if (info.numeric != Numeric::kFloat) return std::ldexp(1.0, -info.component[0].bits);
  return size > 0 ? std::ldexp(1.0, std::ilogb(size) - kMantissaBits) : 0.0;
}

/// The greater of the slopes of depth in x and in y, a pixel.
double depth_slope(const WindowTriangle& t) {
  const double x1 = t.x[1] - t.x[0], y1 = t.y[1] - t.y[0], z1 = t.z[1] - t.z[0];
  const double x2 = t.x[2] - t.x[0], y2 = t.y[2] - t.y[0], z2 = t.z[2] - t.z[0];
  const double area = x1 * y2 - x2 * y1;
  return std::max(std::abs((z1 * y2 - z2 * y1) / area), std::abs((z2 * x1 - z1 * x2) / area));
}

}  // namespace

double SampleTests::bias_of(const WindowTriangle& t) const {
  const traces::DepthBias& bias = state_.pipeline->depth_bias;
  if (!bias.enable || t.shape != Shape::kTriangle || !has_attachment()) return 0;
  const double greatest = std::max({std::abs(t.z[0]), std::abs(t.z[1]), std::abs(t.z[2])});
  const double offset = static_cast<double>(bias.slope) * depth_slope(t) +
                        static_cast<double>(bias.constant) * depth_step(state_.depth_format, greatest);
  const auto clamp = static_cast<double>(bias.clamp);
  if (clamp > 0) return std::min(offset, clamp);
  return clamp < 0 ? std::max(offset, clamp) : offset;
}

double SampleTests::final_depth(double z, bool biased, std::uint32_t viewport) const {
  const traces::SetViewport& v = state_.viewports[viewport];
  const double low = v.min_depth, high = v.max_depth;
  if (state_.pipeline->depth_clamp) z = std::clamp(z, std::min(low, high), std::max(low, high));
  if (biased) z = std::clamp(z, 0.0, 1.0);
  if (float_depth_) z = static_cast<double>(static_cast<float>(z));
  return has_attachment() ? held_depth(state_.depth_format, z) : z;
}

bool SampleTests::test(bool front, std::size_t place, double depth) {
  const traces::Pipeline& pipeline = *state_.pipeline;
  const double stored = (*state_.depth)[place];
  const traces::DepthBoundsTest& bounds = pipeline.depth_bounds;
  if (bounds.test &&
      !(stored >= static_cast<double>(bounds.least) && stored <= static_cast<double>(bounds.most)))
    return false;
  if (pipeline.depth.test) {
    float& margin = result_.depth_margin[place / state_.samples];
    margin = std::min(margin, static_cast<float>(float_ulps(depth, stored)));
  }
  const bool passes = !pipeline.depth.test || depth_passes(pipeline.depth.compare, depth, stored);
  if (!pipeline.stencil.test || !has_stencil(state_.depth_format)) return passes;
  const traces::StencilFace& face = front ? pipeline.stencil.front : pipeline.stencil.back;
  std::uint8_t& value = (*state_.stencil)[place];
  const bool stencil = stencil_passes(face, value);
  value = stencil_after(face, !stencil ? face.fail : passes ? face.pass : face.depth_fail, value);
  return stencil && passes;
}

bool SampleTests::test_and_write(bool front, std::size_t place, double depth) {
  if (!has_attachment()) return true;
  if (!test(front, place, depth)) return false;
  if (state_.pipeline->depth.test && state_.pipeline->depth.write) (*state_.depth)[place] = depth;
  return true;
}

}  // namespace quadrille::models::reference
