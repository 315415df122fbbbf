/// Textures of every format, filter, wrap and border: the functional run's numbers beside the driver's.
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

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

Difference difference(VulkanRenderer& vulkan, const TextureCard& card, double tolerance) {
  const traces::CommandStream stream = pipeline::test::card_stream(card);
  const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {.linear_log2 = true});
  const Rendered theirs = vulkan.render(stream);
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

/// Steps of 255 by which the driver is off; a signed one is two.
double block_steps(traces::Format format) {
  const bool is_signed = format == traces::Format::kBc4Snorm || format == traces::Format::kBc5Snorm;
  return is_signed ? 2 * 255.0 / 127.0 : format < traces::Format::kBc3Unorm ? 1 : 2;
}

/// The driver decodes sRGB by a polynomial, and BC1 to BC5 by reciprocals of few bits (block_codes_test.cpp).
double tolerance_of(const TextureCard& card) {
  using traces::Format;
  const double ours = pipeline::test::card_tolerance(card);
  const Format format = card.image.format;
  if (format >= Format::kBc1RgbUnorm && format <= Format::kBc5Snorm)
    return ours + block_steps(format) / 255.0;
  return models::is_srgb_format(format) ? std::max(ours, 1.0 / 255.0) : ours;
}

}  // namespace

TEST_CASE("lavapipe: textures of every format have the driver's numbers with each filter and wrap") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  for (const TextureCard& card : pipeline::test::format_cards()) {
    const Difference found = difference(*vulkan, card, tolerance_of(card));
    INFO(pipeline::test::name_of(card) << ": by up to " << found.most);
    CHECK(found.components == 0);
  }
}

}  // namespace quadrille::lavapipe
