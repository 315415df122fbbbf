#include "models/texture/operation_places.h"

#include "models/texture/level_of_detail.h"

#include <algorithm>
#include <cmath>

namespace quadrille::models {
namespace {

/// Ratios that are this little above a whole number take that many samples.
constexpr float kRatioSlack = 1.0f / 256.0f;

/// A request of the operations that the ISA has an instruction for.
TextureOperation plain_operation(Op op) {
  TextureOperation operation;
  operation.level = op == Op::kTexLod    ? LevelFrom::kLevel
                    : op == Op::kTexBias ? LevelFrom::kBias
                                         : LevelFrom::kQuad;
  return operation;
}

}  // namespace

SamplerState sampler_for(const SamplerState& sampler, ViewKind kind) {
  SamplerState s = sampler;
  if (is_cube(kind)) s.wrap_u = s.wrap_v = Wrap::kClampToEdge;
  if (place_dimensions(kind) == 1) s.wrap_v = Wrap::kClampToEdge;
  return s;
}

OperationPlaces::OperationPlaces(const TextureView& view, const SamplerState& sampler,
                                 const TextureRequest& request, const Precision& precision)
    : view_(view),
      sampler_(sampler),
      request_(request),
      precision_(precision),
      operation_(request.operation != nullptr ? *request.operation : plain_operation(request.op)),
      words_(request.operation != nullptr ? words_of(operation_, view.kind) : TextureWords{-1, 2, -1}),
      dimensions_(static_cast<std::size_t>(place_dimensions(view.kind))) {}

void OperationPlaces::find() {
  for (std::size_t first = 0; first < kWarpLanes; first += kGroupLanes) find_group(first);
}

void OperationPlaces::find_levels(std::array<float, kWarpLanes>& samples) {
  for (std::size_t first = 0; first < kWarpLanes; first += kGroupLanes) level_of_detail(first, samples);
}

float OperationPlaces::size(std::size_t k) const {
  const TextureLayout& layout = view_.layout;
  return static_cast<float>(k == 0 ? layout.width[0] : k == 1 ? layout.height[0] : layout.slices[0]);
}

/// Changes of word `k` along x and y, of eight lanes: differences in their quads, or what is given.
void OperationPlaces::change_of(std::size_t k, std::size_t first, __m256& along_x, __m256& along_y) const {
  if (operation_.level == LevelFrom::kGradients) {
    const auto at = static_cast<std::size_t>(words_.level);
    along_x = finite_or_zero(load(request_.word(at + k), first));
    along_y = finite_or_zero(load(request_.word(at + dimensions_ + k), first));
    return;
  }
  alignas(32) std::array<float, kGroupLanes> x, y;
  const LaneFloats& word = request_.word(k);
  const auto finite = [](float v) { return std::isfinite(v) ? v : 0.0f; };
  for (std::size_t lane = 0; lane < kGroupLanes; ++lane) {
    const std::size_t quad = (first + lane) & ~std::size_t{3};
    x[lane] = finite(word[quad + 1]) - finite(word[quad]);
    y[lane] = finite(word[quad + 2]) - finite(word[quad]);
  }
  along_x = _mm256_load_ps(x.data());
  along_y = _mm256_load_ps(y.data());
}

bool OperationPlaces::stretches() const {
  return is_anisotropic(sampler_) && dimensions_ == 2 && operation_.level != LevelFrom::kLevel;
}

float OperationPlaces::most_anisotropy() const { return std::min(sampler_.max_anisotropy, kMaxAnisotropy); }

bool OperationPlaces::takes_ellipses() const {
  return stretches() && operation_.ask == TextureAsk::kSample &&
         precision_.anisotropic_footprint == AnisotropicFootprint::kEllipse;
}

TexelEllipse OperationPlaces::ellipse_of(std::size_t lane, std::int32_t width, std::int32_t height) const {
  const float across = static_cast<float>(width) / size(0), down = static_cast<float>(height) / size(1);
  return texel_ellipse({along_x_[0][lane] * across, along_x_[1][lane] * down},
                       {along_y_[0][lane] * across, along_y_[1][lane] * down}, most_anisotropy());
}

bool OperationPlaces::needs_changes() const {
  return operation_.level != LevelFrom::kLevel && operation_.ask != TextureAsk::kGather;
}

/// Places of eight lanes in texture sizes, slices, and changes of the places in texels.
void OperationPlaces::find_group(std::size_t first) {
  __m256 r[3];
  for (std::size_t k = 0; k < dimensions_; ++k) r[k] = finite_or_zero(load(request_.word(k), first));
  __m256 x[3] = {}, y[3] = {};
  for (std::size_t k = 0; needs_changes() && k < dimensions_; ++k) change_of(k, first, x[k], y[k]);
  __m256i layer = _mm256_setzero_si256();
  if (is_array(view_.kind)) layer = layer_of(first);
  if (is_cube(view_.kind)) {
    const CubeAxes axes = cube_axes(r);
    layer = _mm256_add_epi32(_mm256_mullo_epi32(layer, _mm256_set1_epi32(kCubeFaces)), cube_face(axes));
    to_face(axes, r, x, y);
  }
  store(slice, first, layer);
  const std::size_t used = is_cube(view_.kind) ? 2 : dimensions_;
  for (std::size_t k = 0; k < 3; ++k) {
    store(place[k], first, k < used ? r[k] : _mm256_set1_ps(0.5f));
    const __m256 texels = _mm256_set1_ps(k < used ? size(k) : 0.0f);
    store(along_x_[k], first, _mm256_mul_ps(x[k < used ? k : 0], texels));
    store(along_y_[k], first, _mm256_mul_ps(y[k < used ? k : 0], texels));
  }
}

/// To the nearest layer that there is, of two equally near the even one.
__m256i OperationPlaces::layer_of(std::size_t first) const {
  const int layers = view_.layout.slices[0] / (is_cube(view_.kind) ? static_cast<int>(kCubeFaces) : 1);
  const __m256 wanted = finite_or_zero(load(request_.word(dimensions_), first));
  const __m256 limited = _mm256_min_ps(_mm256_max_ps(wanted, _mm256_setzero_ps()),
                                       _mm256_set1_ps(static_cast<float>(layers - 1)));
  return _mm256_cvtps_epi32(limited);
}

/// Directions and their changes become places on the faces and theirs.
void OperationPlaces::to_face(const CubeAxes& axes, __m256 (&r)[3], __m256 (&x)[3], __m256 (&y)[3]) {
  const __m256 half = _mm256_set1_ps(0.5f), major = axes.along_major(r);
  const __m256 s = finite_or_zero(_mm256_div_ps(axes.along_s(r), major)),
               t = finite_or_zero(_mm256_div_ps(axes.along_t(r), major));
  for (__m256(*change)[3] : {&x, &y}) {
    const __m256 grows = finite_or_zero(_mm256_div_ps(axes.along_major(*change), major));
    const auto on_face = [&](__m256 at, __m256 moves) {
      const __m256 relative = finite_or_zero(_mm256_div_ps(moves, major));
      return _mm256_mul_ps(half, _mm256_sub_ps(relative, _mm256_mul_ps(at, grows)));
    };
    const __m256 ds = on_face(s, axes.along_s(*change)), dt = on_face(t, axes.along_t(*change));
    (*change)[0] = ds;
    (*change)[1] = dt;
  }
  r[0] = _mm256_add_ps(_mm256_mul_ps(half, s), half);
  r[1] = _mm256_add_ps(_mm256_mul_ps(half, t), half);
}

/// lambda of eight lanes; with anisotropy, also how many samples are taken along which line.
void OperationPlaces::level_of_detail(std::size_t first, std::array<float, kWarpLanes>& samples) {
  const __m256 zero = _mm256_setzero_ps();
  if (operation_.level == LevelFrom::kLevel) {
    const __m256 level = finite_or_zero(load(request_.word(static_cast<std::size_t>(words_.level)), first));
    store(plain_lambda, first, level);
    store(lambda, first, biased_lambda(level, zero, sampler_));
    return;
  }
  __m256 x2 = zero, y2 = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    const __m256 x = load(along_x_[k], first), y = load(along_y_[k], first);
    x2 = _mm256_add_ps(x2, _mm256_mul_ps(x, x));
    y2 = _mm256_add_ps(y2, _mm256_mul_ps(y, y));
  }
  const auto limited = [](__m256 v) {
    return _mm256_max_ps(_mm256_min_ps(v, _mm256_set1_ps(1e30f)), _mm256_set1_ps(1e-30f));
  };
  const __m256 half = _mm256_set1_ps(0.5f);
  __m256 base = _mm256_mul_ps(unit_log2(limited(_mm256_max_ps(x2, y2)), precision_), half);
  if (stretches()) base = stretch(first, limited(x2), limited(y2), samples);
  const __m256 bias = operation_.level == LevelFrom::kBias
                          ? finite_or_zero(load(request_.word(static_cast<std::size_t>(words_.level)), first))
                          : zero;
  store(plain_lambda, first, _mm256_add_ps(base, _mm256_set1_ps(sampler_.lod_bias)));
  store(lambda, first, biased_lambda(base, bias, sampler_));
}

/// Samples and their line, of pixels whose footprint is longer one way than the other; lambda is that of the
/// shorter way, as far as so many samples allow. A footprint within a texel takes one. Of ellipses there is
/// only lambda: that of the shorter difference, or where the ellipse is widened more, of its shorter axis.
__m256 OperationPlaces::stretch(std::size_t first, __m256 x2, __m256 y2,
                                std::array<float, kWarpLanes>& samples) {
  const __m256 x_longer = _mm256_cmp_ps(x2, y2, _CMP_GE_OQ);
  const __m256 shorter2 = _mm256_min_ps(x2, y2);
  __m256 long2 = _mm256_max_ps(x2, y2), short2 = shorter2;
  const __m256 along[2][2] = {{load(along_x_[0], first), load(along_y_[0], first)},
                              {load(along_x_[1], first), load(along_y_[1], first)}};
  __m256 line[2];
  for (std::size_t k = 0; k < 2; ++k) line[k] = _mm256_blendv_ps(along[k][1], along[k][0], x_longer);
  if (precision_.anisotropic_footprint != AnisotropicFootprint::kLongerDifference)
    ellipse(along, x2, y2, line, long2, short2);
  const __m256 most = _mm256_set1_ps(most_anisotropy()), one = _mm256_set1_ps(1.0f),
               half = _mm256_set1_ps(0.5f);
  if (precision_.anisotropic_footprint == AnisotropicFootprint::kEllipse) {
    const __m256 least2 = _mm256_div_ps(long2, _mm256_mul_ps(most, most));
    return _mm256_mul_ps(unit_log2(_mm256_max_ps(shorter2, least2), precision_), half);
  }
  const __m256 within = _mm256_cmp_ps(long2, one, _CMP_LE_OQ);
  const __m256 ratio =
      _mm256_blendv_ps(_mm256_min_ps(_mm256_sqrt_ps(_mm256_div_ps(long2, short2)), most), one, within);
  const __m256 count = _mm256_max_ps(_mm256_ceil_ps(_mm256_sub_ps(ratio, _mm256_set1_ps(kRatioSlack))), one);
  _mm256_storeu_ps(samples.data() + first, count);
  for (std::size_t k = 0; k < 2; ++k) store(axis[k], first, _mm256_div_ps(line[k], _mm256_set1_ps(size(k))));
  return _mm256_sub_ps(_mm256_mul_ps(unit_log2(long2, precision_), half), unit_log2(ratio, precision_));
}

/// Axes of the ellipse that a circle becomes: of J = (x y), the longer is J v with v the eigenvector of J'J.
void OperationPlaces::ellipse(const __m256 (&along)[2][2], __m256 x2, __m256 y2, __m256 (&axis)[2],
                              __m256& long2, __m256& short2) {
  const __m256 c =
      _mm256_add_ps(_mm256_mul_ps(along[0][0], along[0][1]), _mm256_mul_ps(along[1][0], along[1][1]));
  const __m256 difference = _mm256_sub_ps(x2, y2), twice = _mm256_add_ps(c, c), half = _mm256_set1_ps(0.5f);
  const __m256 root =
      _mm256_sqrt_ps(_mm256_add_ps(_mm256_mul_ps(difference, difference), _mm256_mul_ps(twice, twice)));
  const __m256 sum = _mm256_add_ps(x2, y2);
  // v = (root + x2 - y2, 2 c) where x is the longer of the two, else (2 c, root + y2 - x2)
  const __m256 x_longer = _mm256_cmp_ps(difference, _mm256_setzero_ps(), _CMP_GE_OQ);
  const __m256 larger = _mm256_add_ps(root, _mm256_andnot_ps(_mm256_set1_ps(-0.0f), difference));
  const __m256 v[2] = {_mm256_blendv_ps(twice, larger, x_longer), _mm256_blendv_ps(larger, twice, x_longer)};
  const __m256 length = _mm256_sqrt_ps(_mm256_add_ps(_mm256_mul_ps(v[0], v[0]), _mm256_mul_ps(v[1], v[1])));
  const __m256 turned = _mm256_cmp_ps(length, _mm256_set1_ps(1e-30f), _CMP_GT_OQ);
  for (std::size_t k = 0; k < 2; ++k) {
    const __m256 along_axis = _mm256_div_ps(
        _mm256_add_ps(_mm256_mul_ps(along[k][0], v[0]), _mm256_mul_ps(along[k][1], v[1])), length);
    axis[k] = _mm256_blendv_ps(axis[k], along_axis, turned);
  }
  const __m256 area =
      _mm256_sub_ps(_mm256_mul_ps(along[0][0], along[1][1]), _mm256_mul_ps(along[1][0], along[0][1]));
  long2 = _mm256_max_ps(_mm256_mul_ps(half, _mm256_add_ps(sum, root)), _mm256_set1_ps(1e-30f));
  short2 = _mm256_max_ps(_mm256_div_ps(_mm256_mul_ps(area, area), long2), _mm256_set1_ps(1e-30f));
}

}  // namespace quadrille::models
