#include "models/reference/texture_operation.h"

#include <algorithm>
#include <cmath>

#include "models/reference/ellipse.h"

namespace quadrille::models::reference {
namespace {

constexpr double kRatioSlack = 1.0 / 256.0;

/// A place on a texture: in sizes of the image, and the layer, face or both. Changes are in texels of the
/// finest level.
struct Place {
  Vector at{0.5, 0.5, 0.5};
  std::int64_t slice = 0;
  Vector along_x{}, along_y{};
};

std::uint32_t slices_of(const TextureView& texture, std::uint32_t level) {
  const std::uint32_t l = texture.first_level + level;
  return texture.kind == ViewKind::k3D ? traces::level_depth(*texture.image, l) : texture.layers;
}

std::array<std::int64_t, 3> sizes_of(const TextureView& texture, std::uint32_t level) {
  const std::uint32_t l = texture.first_level + level;
  return {traces::level_width(*texture.image, l), traces::level_height(*texture.image, l),
          slices_of(texture, level)};
}

std::int64_t layer_of(double layer, std::int64_t layers) {
  return static_cast<std::int64_t>(
      std::nearbyint(std::clamp(finite_or_zero(layer), 0.0, static_cast<double>(layers - 1))));
}

/// The face that a direction meets: its number, and the axes that run along s, t and outwards, with signs.
struct Face {
  int number = 0;
  std::array<int, 3> axis{};
  std::array<double, 3> sign{};
  [[nodiscard]] Vector turned(const Vector& r) const {
    Vector v{};
    for (std::size_t k = 0; k < 3; ++k) v.at(k) = sign.at(k) * r.at(static_cast<std::size_t>(axis.at(k)));
    return v;
  }
};
constexpr std::array<Face, 6> kFaces{{{0, {2, 1, 0}, {-1, -1, 1}},
                                      {1, {2, 1, 0}, {1, -1, -1}},
                                      {2, {0, 2, 1}, {1, 1, 1}},
                                      {3, {0, 2, 1}, {1, -1, -1}},
                                      {4, {0, 1, 2}, {1, -1, 1}},
                                      {5, {0, 1, 2}, {-1, -1, -1}}}};

const Face& face_of(const Vector& r) {
  const double x = std::abs(r[0]), y = std::abs(r[1]), z = std::abs(r[2]);
  const std::size_t axis = z >= x && z >= y ? 2 : y >= x ? 1 : 0;
  return kFaces.at(2 * axis + (r.at(axis) < 0 ? 1 : 0));
}

/// [VK1.3 #textures-cube-map-coordinate-transformation, #textures-cube-map-derivative-transformation]
Place on_cube(const TextureQuestion& q, std::uint32_t size) {
  Vector r = q.at;
  for (double& c : r) c = finite_or_zero(c);
  const Face& face = face_of(r);
  const Vector v = face.turned(r);
  Place place;
  place.slice = face.number;
  for (std::size_t k = 0; k < 2; ++k) place.at.at(k) = 0.5 * finite_or_zero(v.at(k) / v[2]) + 0.5;
  for (const auto& [from, to] : {std::pair{&q.along_x, &place.along_x}, {&q.along_y, &place.along_y}}) {
    const Vector d = face.turned(*from);
    for (std::size_t k = 0; k < 2; ++k)
      to->at(k) = finite_or_zero(0.5 * (v[2] * d.at(k) - v.at(k) * d[2]) / (v[2] * v[2])) * size;
  }
  return place;
}

Place place_of(const TextureView& texture, const TextureQuestion& q) {
  const std::array<std::int64_t, 3> sizes = sizes_of(texture, 0);
  const bool cube = is_cube(texture.kind);
  Place place;
  if (cube) {
    place = on_cube(q, static_cast<std::uint32_t>(sizes[0]));
  } else {
    for (std::size_t k = 0; k < static_cast<std::size_t>(place_dimensions(texture.kind)); ++k) {
      place.at.at(k) = finite_or_zero(q.at.at(k));
      place.along_x.at(k) = q.along_x.at(k) * static_cast<double>(sizes.at(k));
      place.along_y.at(k) = q.along_y.at(k) * static_cast<double>(sizes.at(k));
    }
  }
  const std::int64_t faces = cube ? kCubeFaces : 1;
  if (is_array(texture.kind)) place.slice += faces * layer_of(q.layer, texture.layers / faces);
  return place;
}

double squared(const Vector& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

/// Samples along an axis (in texture sizes), and the level of detail of each; or the texels of an ellipse.
struct Footprint {
  double lambda = 0;
  int samples = 1;
  std::array<double, 2> axis{};
  bool ellipse = false;
};

Anisotropy anisotropy_of(const TextureView& texture) {
  return texture.precision != nullptr ? texture.precision->anisotropy : Anisotropy::kLongerDifference;
}

double most_anisotropy(const TextureView& texture) {
  return std::min(static_cast<double>(texture.sampler->max_anisotropy), 16.0);
}

Footprint footprint_of(const TextureView& texture, const TextureQuestion& q, const Place& place) {
  if (q.level) return {finite_or_zero(*q.level)};
  double long2 = std::max(squared(place.along_x), squared(place.along_y));
  if (!is_anisotropic(*texture.sampler) || place_dimensions(texture.kind) != 2)
    return {0.5 * std::log2(long2)};
  const double most = most_anisotropy(texture);
  const double x2 = squared(place.along_x), y2 = squared(place.along_y);
  double short2 = std::min(x2, y2);
  const Vector& longer = x2 >= y2 ? place.along_x : place.along_y;
  std::array<double, 2> axis{longer[0], longer[1]};
  if (anisotropy_of(texture) != Anisotropy::kLongerDifference) {
    const EllipseAxes axes =
        ellipse_axes({place.along_x[0], place.along_x[1]}, {place.along_y[0], place.along_y[1]});
    if (anisotropy_of(texture) == Anisotropy::kEllipse)
      return {std::log2(std::max(std::sqrt(short2), axes.longer / most)), 1, {}, true};
    axis = {axes.longer * axes.direction[0], axes.longer * axes.direction[1]};
    long2 = axes.longer * axes.longer;
    short2 = axes.shorter * axes.shorter;
  }
  Footprint f;
  const double ratio = long2 <= 1 ? 1.0 : short2 > 0 ? std::min(std::sqrt(long2 / short2), most) : most;
  f.samples = std::max(1, static_cast<int>(std::ceil(ratio - kRatioSlack)));
  f.lambda = 0.5 * std::log2(long2) - std::log2(ratio);
  const std::array<std::int64_t, 3> sizes = sizes_of(texture, 0);
  for (std::size_t k = 0; k < 2; ++k) f.axis.at(k) = axis.at(k) / static_cast<double>(sizes.at(k));
  return f;
}

/// What a comparison makes of a texel.
Texel compared(const TextureView& texture, const TextureQuestion& q, const Texel& texel) {
  if (!q.reference) return texel;
  const bool limited = format_info(texture.image->format).numeric == Numeric::kUnorm;
  const double reference = limited ? std::clamp(*q.reference, 0.0, 1.0) : *q.reference;
  bool passes = false;
  switch (texture.sampler->compare) {
    case CompareOp::kNever: break;
    case CompareOp::kLess: passes = reference < texel[0]; break;
    case CompareOp::kEqual: passes = reference == texel[0]; break;
    case CompareOp::kLessOrEqual: passes = reference <= texel[0]; break;
    case CompareOp::kGreater: passes = reference > texel[0]; break;
    case CompareOp::kNotEqual: passes = reference != texel[0]; break;
    case CompareOp::kGreaterOrEqual: passes = reference >= texel[0]; break;
    case CompareOp::kAlways: passes = true; break;
  }
  return {passes ? 1.0 : 0.0, 0, 0, 1};
}

/// The texel of a cube beyond one edge of a face.
Texel across_edge(const TextureView& texture, std::uint32_t level, std::int64_t i, std::int64_t j,
                  std::int64_t slice, std::int64_t n) {
  const Face& face = kFaces.at(static_cast<std::size_t>(slice % kCubeFaces));
  const Vector place{(2.0 * static_cast<double>(i) + 1) / static_cast<double>(n) - 1,
                     (2.0 * static_cast<double>(j) + 1) / static_cast<double>(n) - 1, 1};
  Vector r{};
  for (std::size_t k = 0; k < 3; ++k)
    r.at(static_cast<std::size_t>(face.axis.at(k))) = face.sign.at(k) * place.at(k);
  const Face& other = face_of(r);
  const Vector v = other.turned(r);
  const auto texel = [&](double c) {
    return std::clamp<std::int64_t>(floor_index((c / v[2] + 1) / 2 * static_cast<double>(n)), 0, n - 1);
  };
  return view_texel(texture, level, static_cast<std::uint32_t>(texel(v[0])),
                    static_cast<std::uint32_t>(texel(v[1])),
                    static_cast<std::uint32_t>(slice / kCubeFaces * kCubeFaces + other.number));
}

using Square = std::array<Texel, 4>;  ///< (0,0) (1,0) (0,1) (1,1)

/// A texel by its indices, wrapped; of a cube inside its face or beyond one edge.
Texel texel_at(const TextureView& texture, std::uint32_t level, std::int64_t i, std::int64_t j,
               std::int64_t slice) {
  const std::array<std::int64_t, 3> sizes = sizes_of(texture, level);
  if (is_cube(texture.kind)) {
    const bool inside = i >= 0 && i < sizes[0] && j >= 0 && j < sizes[1];
    if (!inside && !texture.sampler->seamless) {
      i = std::clamp<std::int64_t>(i, 0, sizes[0] - 1);
      j = std::clamp<std::int64_t>(j, 0, sizes[1] - 1);
    }
    return inside || !texture.sampler->seamless
               ? view_texel(texture, level, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j),
                            static_cast<std::uint32_t>(slice))
               : across_edge(texture, level, i, j, slice, sizes[0]);
  }
  const traces::Sampler& s = *texture.sampler;
  const bool line = place_dimensions(texture.kind) == 1, volume = texture.kind == ViewKind::k3D;
  const std::int64_t x = wrapped(i, sizes[0], s.wrap_u), y = line ? 0 : wrapped(j, sizes[1], s.wrap_v),
                     z = volume ? wrapped(slice, sizes[2], s.wrap_w) : slice;
  if (x == kBeyondBorder || y == kBeyondBorder || z == kBeyondBorder) return border_texel(texture, s.border);
  return view_texel(texture, level, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                    static_cast<std::uint32_t>(z));
}

Square square_at(const TextureView& texture, const TextureQuestion& q, std::uint32_t level, std::int64_t i,
                 std::int64_t j, std::int64_t slice) {
  const std::array<std::int64_t, 3> sizes = sizes_of(texture, level);
  Square square{};
  int missing = -1;
  for (int corner = 0; corner < 4; ++corner) {
    const std::int64_t x = i + corner % 2, y = j + corner / 2;
    const bool beside = x < 0 || x >= sizes[0], above = y < 0 || y >= sizes[1];
    if (is_cube(texture.kind) && texture.sampler->seamless && beside && above) missing = corner;
    else
      square.at(static_cast<std::size_t>(corner)) =
          compared(texture, q, texel_at(texture, level, x, y, slice));
  }
  if (missing < 0) return square;
  Texel mean{};
  for (int corner = 0; corner < 4; ++corner)
    for (std::size_t c = 0; corner != missing && c < 4; ++c)
      mean.at(c) += square.at(static_cast<std::size_t>(corner)).at(c) / 3;
  square.at(static_cast<std::size_t>(missing)) = mean;
  return square;
}

double texel_place(const TextureView& texture, double at, std::int64_t size, std::int64_t offset) {
  return quantised(at * static_cast<double>(size) - 0.5, texture.precision, &Precision::subtexel_bits) +
         static_cast<double>(offset);
}

Texel in_level(const TextureView& texture, const TextureQuestion& q, const Place& place, std::uint32_t level,
               traces::Filter filter) {
  const std::array<std::int64_t, 3> sizes = sizes_of(texture, level);
  const bool volume = texture.kind == ViewKind::k3D;
  if (filter == traces::Filter::kNearest) {
    std::array<std::int64_t, 3> index{};
    for (std::size_t k = 0; k < 3; ++k) {
      index.at(k) = floor_index(place.at.at(k) * static_cast<double>(sizes.at(k))) + q.offset.at(k);
      if (is_cube(texture.kind)) index.at(k) = std::clamp<std::int64_t>(index.at(k), 0, sizes.at(k) - 1);
    }
    return compared(texture, q,
                    texel_at(texture, level, index[0], index[1], volume ? index[2] : place.slice));
  }
  const double left = texel_place(texture, place.at[0], sizes[0], q.offset[0]),
               top = texel_place(texture, place.at[1], sizes[1], q.offset[1]),
               front = volume ? texel_place(texture, place.at[2], sizes[2], q.offset[2])
                              : static_cast<double>(place.slice);
  const auto plane = [&](std::int64_t slice) {
    const Square t = square_at(texture, q, level, floor_index(left), floor_index(top), slice);
    const double a = left - std::floor(left), b = top - std::floor(top);
    return mix(mix(t[0], t[1], a), mix(t[2], t[3], a), b);
  };
  const Texel first = plane(floor_index(front));
  const double behind = front - std::floor(front);
  return behind == 0 ? first : mix(first, plane(floor_index(front) + 1), behind);
}

Texel mean_in_level(const TextureView& texture, const TextureQuestion& q, const Place& place,
                    const Footprint& f, std::uint32_t level, traces::Filter filter) {
  if (f.samples == 1) return in_level(texture, q, place, level, filter);
  Texel sum{};
  for (int i = 1; i <= f.samples; ++i) {
    Place moved = place;
    for (std::size_t k = 0; k < 2; ++k) moved.at.at(k) += f.axis.at(k) * (i / (f.samples + 1.0) - 0.5);
    const Texel texel = in_level(texture, q, moved, level, filter);
    for (std::size_t c = 0; c < 4; ++c) sum.at(c) += texel.at(c) / f.samples;
  }
  return sum;
}

/// The texels of a level within the pixel's ellipse, by their weights.
Texel mean_in_ellipse(const TextureView& texture, const TextureQuestion& q, const Place& place,
                      std::uint32_t level) {
  const std::array<std::int64_t, 3> sizes = sizes_of(texture, level), finest = sizes_of(texture, 0);
  Change x{}, y{};
  Change centre{};
  for (std::size_t k = 0; k < 2; ++k) {
    const double part = static_cast<double>(sizes.at(k)) / static_cast<double>(finest.at(k));
    x.at(k) = place.along_x.at(k) * part;
    y.at(k) = place.along_y.at(k) * part;
    centre.at(k) = place.at.at(k) * static_cast<double>(sizes.at(k)) - 0.5;
  }
  const EllipseAxes ellipse = filtered_ellipse(ellipse_axes(x, y), most_anisotropy(texture));
  const auto reach = static_cast<std::int64_t>(std::ceil(ellipse.longer)) + 1;
  const std::int64_t column = floor_index(centre[0]), row = floor_index(centre[1]);
  Texel sum{};
  double weights = 0;
  for (std::int64_t j = row - reach; j <= row + reach; ++j)
    for (std::int64_t i = column - reach; i <= column + reach; ++i) {
      const double weight =
          ellipse_weight(ellipse, static_cast<double>(i) - centre[0], static_cast<double>(j) - centre[1]);
      if (weight == 0) continue;
      const Texel texel =
          compared(texture, q, texel_at(texture, level, i + q.offset[0], j + q.offset[1], place.slice));
      weights += weight;
      for (std::size_t c = 0; c < 4; ++c) sum.at(c) += weight * texel.at(c);
    }
  for (double& c : sum) c /= weights;
  return sum;
}

/// The level that a lambda reads: the finer one, and how much of the next.
double level_read(const TextureView& texture, double lambda) {
  const double level = std::clamp(lambda, 0.0, static_cast<double>(texture.levels - 1));
  return texture.sampler->mip == traces::Filter::kNearest ? std::max(std::ceil(level + 0.5) - 1, 0.0) : level;
}

}  // namespace

Texel filtered_texel(const TextureView& texture, const TextureQuestion& q) {
  const Place place = place_of(texture, q);
  const Footprint f = footprint_of(texture, q, place);
  const double lambda = final_lambda(texture, f.lambda, q.bias);
  const traces::Filter filter = lambda <= 0 ? texture.sampler->mag : texture.sampler->min;
  const double level = level_read(texture, lambda);
  const auto finer = static_cast<std::uint32_t>(level);
  if (f.ellipse) return mean_in_ellipse(texture, q, place, finer);
  const double weight = level - std::floor(level);
  const Texel a = mean_in_level(texture, q, place, f, finer, filter);
  return weight == 0 ? a : mix(a, mean_in_level(texture, q, place, f, finer + 1, filter), weight);
}

std::array<Texel, 4> gathered_texels(const TextureView& texture, const TextureQuestion& q) {
  const Place place = place_of(texture, q);
  const std::array<std::int64_t, 3> sizes = sizes_of(texture, 0);
  const double left = texel_place(texture, place.at[0], sizes[0], q.offset[0]),
               top = texel_place(texture, place.at[1], sizes[1], q.offset[1]);
  const Square t = square_at(texture, q, 0, floor_index(left), floor_index(top), place.slice);
  return {t[2], t[3], t[1], t[0]};
}

Texel fetched_texel(const TextureView& texture, const std::array<std::int64_t, 3>& place, std::int64_t level,
                    std::int64_t sample) {
  const Texel nothing = border_texel(texture, BorderColor::kTransparentBlack);
  if (level < 0 || level >= texture.levels || sample < 0 || sample >= texture.image->samples) return nothing;
  const auto l = static_cast<std::uint32_t>(level);
  const std::array<std::int64_t, 3> sizes = sizes_of(texture, l);
  for (std::size_t k = 0; k < 3; ++k)
    if (place.at(k) < 0 || place.at(k) >= sizes.at(k)) return nothing;
  return view_texel(texture, l, static_cast<std::uint32_t>(place[0]), static_cast<std::uint32_t>(place[1]),
                    static_cast<std::uint32_t>(place[2]), static_cast<std::uint32_t>(sample));
}

std::array<double, 2> queried_levels(const TextureView& texture, const TextureQuestion& q) {
  const Footprint f = footprint_of(texture, q, place_of(texture, q));
  const double bias = static_cast<double>(texture.sampler->lod_bias);
  return {level_read(texture, final_lambda(texture, f.lambda, 0)),
          std::clamp(f.lambda + bias, -128.0, 128.0)};
}

}  // namespace quadrille::models::reference
