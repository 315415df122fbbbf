#include "studies/given_reference.h"

namespace quadrille::studies {
namespace {

namespace ref = models::reference;

ref::GivenTriangle given(const pipeline::RasterizedTriangle& t) {
  ref::GivenTriangle g{t.draw.index(), t.instance, t.primitive, {}, {}, {}, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    g.x[i] = t.vertices[i].x;
    g.y[i] = t.vertices[i].y;
    g.z[i] = static_cast<double>(t.vertices[i].z);
    g.inv_w[i] = static_cast<double>(t.vertices[i].inv_w);
    g.barycentric[i] = {static_cast<double>(t.weights[i].x), static_cast<double>(t.weights[i].y)};
  }
  return g;
}

}  // namespace

MachineAndReference render_with_reference(const traces::CommandStream& stream,
                                          const models::Precision& precision) {
  ref::Options options;
  options.mode = ref::Mode::kGiven;
  options.precision = {precision.subpixel_bits, precision.subtexel_bits, precision.lod_bits};
  const auto observe = [&](const pipeline::RasterizedTriangle& t) { options.given.push_back(given(t)); };
  MachineAndReference both;
  both.machine = pipeline::render_functional_frame(stream, precision, observe).image;
  both.reference = ref::render(stream, options);
  return both;
}

}  // namespace quadrille::studies
