#include "studies/given_reference.h"

namespace quadrille::studies {
namespace {

namespace ref = models::reference;

ref::GivenTriangle given(const pipeline::RasterizedPiece& t) {
  ref::GivenTriangle g;
  g.draw = t.draw.index(), g.instance = t.instance, g.primitive = t.primitive;
  for (std::size_t i = 0; i < 3; ++i) {
    const models::WindowVertex& v = t.piece.vertices[i];
    g.x[i] = v.x;
    g.y[i] = v.y;
    g.z[i] = static_cast<double>(v.z);
    g.inv_w[i] = static_cast<double>(v.inv_w);
    g.barycentric[i] = {static_cast<double>(t.piece.weights[i].x), static_cast<double>(t.piece.weights[i].y)};
  }
  g.point_size = static_cast<double>(t.piece.point_size);
  g.front = t.piece.front;
  return g;
}

ref::Anisotropy anisotropy(models::AnisotropicFootprint footprint) {
  switch (footprint) {
    case models::AnisotropicFootprint::kLongerDifference: break;
    case models::AnisotropicFootprint::kEllipseAxis: return ref::Anisotropy::kEllipseAxis;
    case models::AnisotropicFootprint::kEllipse: return ref::Anisotropy::kEllipse;
  }
  return ref::Anisotropy::kLongerDifference;
}

}  // namespace

MachineAndReference render_with_reference(const traces::CommandStream& stream,
                                          const models::Precision& precision) {
  ref::Options options;
  options.mode = ref::Mode::kGiven;
  options.precision = {precision.subpixel_bits, precision.subtexel_bits, precision.lod_bits,
                       anisotropy(precision.anisotropic_footprint)};
  const auto observe = [&](const pipeline::RasterizedPiece& t) { options.given.push_back(given(t)); };
  MachineAndReference both;
  both.machine = pipeline::render_functional_frame(stream, precision, observe).image;
  both.reference = ref::render(stream, options);
  return both;
}

}  // namespace quadrille::studies
