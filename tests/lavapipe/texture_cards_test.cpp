/// Textures of every format, filter, wrap and border: the functional run's numbers beside the driver's.
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <string_view>

#include "pipeline/render.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/texture_card.h"

namespace quadrille::lavapipe {
namespace {

using pipeline::test::TextureCard;

/// Components that differ by more than the tolerance, and the largest difference.
struct Difference {
  std::size_t components = 0;
  double most = 0;
};

Difference difference(const traces::CommandStream& stream, const models::Precision& precision,
                      const Rendered& theirs, double tolerance) {
  const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, precision);
  Difference found;
  for (std::size_t i = 0; i < ours.image.linear.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double apart =
          std::abs(static_cast<double>(ours.image.linear[i].at(c)) -
                   static_cast<double>(std::bit_cast<float>(theirs.targets[0].at(i).word.at(c))));
      found.most = std::max(found.most, apart);
      if (!(apart <= tolerance)) ++found.components;
    }
  }
  return found;
}

Difference difference(VulkanRenderer& vulkan, const TextureCard& card, double tolerance) {
  const traces::CommandStream stream = pipeline::test::card_stream(card);
  return difference(stream, {.linear_log2 = true}, vulkan.render(stream), tolerance);
}

/// What a step of an sRGB code is at most in linear light: at white. [VK1.3 #textures-format-conversion]
constexpr double kSteepestSrgb = 2.4 / 1.055;
constexpr double kGreatestHalf = 65504;

/// Steps of 255 by which the driver is off; a signed one is two.
double block_steps(traces::Format format) {
  const bool is_signed = format == traces::Format::kBc4Snorm || format == traces::Format::kBc5Snorm;
  return is_signed ? 2 * 255.0 / 127.0 : format < traces::Format::kBc3Unorm ? 1 : 2;
}

/// The driver decodes sRGB by a polynomial, widens components of less than 8 bits to 8, and decodes BC1 to
/// BC5 by reciprocals of few bits (block_codes_test.cpp).
double tolerance_of(const TextureCard& card) {
  using traces::Format;
  const double ours = pipeline::test::card_tolerance(card);
  const Format format = card.image.format;
  // Their cards are of random blocks: halves of any size, and weights round as they do for numbers up to 1.
  if (format == Format::kBc6hUfloat || format == Format::kBc6hSfloat) return ours * kGreatestHalf;
  const bool srgb = models::is_srgb_format(format);
  if (format >= Format::kBc1RgbUnorm && format <= Format::kBc5Snorm)
    return ours + (srgb ? kSteepestSrgb * block_steps(format) + 1 : block_steps(format)) / 255.0;
  const models::FormatInfo& info = models::format_info(format);
  const bool narrow = info.numeric == models::Numeric::kUnorm && info.component[0].bits < 8;
  return ours + (narrow || srgb ? 1.0 / 255.0 : 0.0);
}

}  // namespace

TEST_CASE("lavapipe: textures of every format have the driver's numbers with each filter and wrap") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  std::set<std::string_view> lacking;
  for (const TextureCard& card : pipeline::test::format_cards()) {
    if (!vulkan->samples(card.image.format)) {
      lacking.insert(models::format_info(card.image.format).name);
      continue;
    }
    const Difference found = difference(*vulkan, card, tolerance_of(card));
    INFO(pipeline::test::name_of(card) << ": by up to " << found.most);
    CHECK(found.components == 0);
  }
  for (const std::string_view name : lacking) {
    INFO(name);
    // tests/lavapipe/gles_blocks_test.cpp holds the codes that the driver lacks.
    const bool other_blocks =
        name.starts_with("ETC2_") || name.starts_with("EAC_") || name.starts_with("ASTC_");
    CHECK((other_blocks || name == "R8_SRGB" || name == "R8G8_SRGB" || name == "R4G4_UNORM_PACK8" ||
           name == "R4G4B4A4_UNORM_PACK16"));
  }
}

TEST_CASE("lavapipe: every operation on every kind of image has the driver's numbers") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  std::size_t drawn = 0;
  for (const TextureCard& card : pipeline::test::operation_cards()) {
    if (!vulkan->samples(card.image.format)) continue;  // which may lack is said above
    ++drawn;
    // The weights between levels and between slices are rounded too.
    const bool exact = pipeline::test::card_tolerance(card) < 1.0 / 255.0;
    const Difference found = difference(*vulkan, card, tolerance_of(card) + (exact ? 0.0 : 1.0 / 255.0));
    INFO(pipeline::test::name_of(card) << ": by up to " << found.most << " in " << found.components);
    CHECK(found.components == 0);
  }
  CHECK(drawn >= 100);
}

/// The driver limits no ellipse by the sampler's greatest anisotropy, so all are held beside ours of 16.
/// Where gradients are given it still takes the ellipse of its own differences.
TEST_CASE("lavapipe: an anisotropic filter weighs the texels of an ellipse as the driver does") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  std::size_t drawn = 0;
  for (TextureCard& card : pipeline::test::anisotropy_cards()) {
    if (card.sample.starts_with("textureGrad") || !vulkan->samples(card.image.format)) continue;
    ++drawn;
    const Rendered theirs = vulkan->render(pipeline::test::card_stream(card));
    card.sampler.max_anisotropy = 16;
    const Difference found =
        difference(pipeline::test::card_stream(card),
                   {.anisotropic_footprint = models::AnisotropicFootprint::kEllipse}, theirs, 0.5 / 255.0);
    INFO(pipeline::test::name_of(card) << ": by up to " << found.most << " in " << found.components);
    CHECK(found.components == 0);
  }
  CHECK(drawn == 9);
}

}  // namespace quadrille::lavapipe
