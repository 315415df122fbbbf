#include "studies/stability/machine_picture.h"

#include <array>
#include <cmath>

#include "pipeline/report/unit_facets.h"

namespace quadrille::studies::stability {

namespace {

constexpr std::uint32_t kBar = 5, kGap = 2;

struct Share {
  std::int64_t pipeline::UnitFigures::*member;
  std::array<std::uint8_t, 4> color;
};
constexpr std::array<Share, 5> kShares{{{&pipeline::UnitFigures::busy, {60, 170, 90, 255}},
                                        {&pipeline::UnitFigures::waiting, {160, 210, 120, 255}},
                                        {&pipeline::UnitFigures::starved, {70, 120, 220, 255}},
                                        {&pipeline::UnitFigures::blocked, {220, 70, 60, 255}},
                                        {&pipeline::UnitFigures::idle, {150, 150, 150, 255}}}};

void draw_bar(scenes::Rgba8Image& out, std::uint32_t top, const pipeline::UnitGroup& group) {
  double from = 0;
  for (const Share& share : kShares) {
    const double part = static_cast<double>(group.sum(share.member)) /
                        static_cast<double>(std::max<std::int64_t>(1, group.cycles()));
    const auto left = static_cast<std::uint32_t>(from * out.width),
               right = static_cast<std::uint32_t>(std::lround((from + part) * out.width));
    for (std::uint32_t y = top; y < top + kBar; ++y) {
      for (std::uint32_t x = left; x < std::min(right, out.width); ++x)
        std::copy(share.color.begin(), share.color.end(),
                  out.pixels.begin() + static_cast<std::ptrdiff_t>(4 * (std::size_t{y} * out.width + x)));
    }
    from += part;
  }
}

}  // namespace

scenes::Rgba8Image machine_picture(const Observed& o) {
  scenes::Rgba8Image out = as_picture(o.image());
  const std::vector<pipeline::UnitGroup> groups = pipeline::group_units(o.exact.figures.units, true);
  std::uint32_t top = out.height + kGap;
  out.height = top + static_cast<std::uint32_t>(groups.size()) * (kBar + kGap);
  out.pixels.resize(std::size_t{4} * out.width * out.height, 255);
  for (const pipeline::UnitGroup& group : groups) {
    draw_bar(out, top, group);
    top += kBar + kGap;
  }
  return out;
}

}  // namespace quadrille::studies::stability
