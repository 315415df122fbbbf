/// Textures of every format, filter, wrap and border: the machine's numbers beside the reference's, and the
/// machine's laws.
#include "tests/pipeline/texture_card.h"
#include "studies/given_reference.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/random_machine.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace quadrille;
using namespace quadrille::pipeline::test;

namespace {

/// The largest difference of a component.
double worst(const studies::MachineAndReference& pictures) {
  double most = 0;
  for (std::size_t i = 0; i < pictures.machine.linear.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c)
      most = std::max(most, std::abs(static_cast<double>(pictures.machine.linear[i].at(c)) -
                                     pictures.reference.color_linear.at(4 * i + c)));
  return most;
}

constexpr models::Precision kEllipse{.anisotropic_footprint = models::AnisotropicFootprint::kEllipse};

}  // namespace

TEST_CASE("texture cards: every format has the reference's numbers with each filter and wrap") {
  for (const TextureCard& card : format_cards()) {
    const auto pictures = studies::render_with_reference(card_stream(card), {});
    REQUIRE(pictures.machine.linear.size() == kCardSide * kCardSide);
    INFO(name_of(card));
    CHECK(worst(pictures) <= card_tolerance(card));
  }
}

TEST_CASE("texture cards: random machines draw the functional run's pixels and keep all laws") {
  const std::vector<TextureCard> cards = format_cards();
  for (std::size_t i = 0; i < cards.size(); i += 11) {
    INFO(name_of(cards[i]));
    CHECK(machine_faults(card_stream(cards[i]), i + 1) == "");
  }
}

TEST_CASE("texture cards: every operation on every kind of image has the reference's numbers") {
  for (const TextureCard& card : operation_cards()) {
    const auto pictures = studies::render_with_reference(card_stream(card), {});
    INFO(name_of(card));
    CHECK(worst(pictures) <= card_tolerance(card));
  }
}

TEST_CASE("texture cards: samples along an axis are the reference's, by either axis") {
  for (const auto footprint :
       {models::AnisotropicFootprint::kLongerDifference, models::AnisotropicFootprint::kEllipseAxis})
    for (const TextureCard& card : anisotropy_cards()) {
      const auto pictures =
          studies::render_with_reference(card_stream(card), {.anisotropic_footprint = footprint});
      INFO(name_of(card) << " up to " << card.sampler.max_anisotropy << ", " << static_cast<int>(footprint));
      CHECK(worst(pictures) <= 2.0 / 255.0);
    }
}

TEST_CASE("texture cards: the texels of an ellipse are the reference's") {
  for (std::size_t wrap = 0; wrap <= static_cast<std::size_t>(models::kLastWrap); ++wrap)
    for (TextureCard& card : anisotropy_cards()) {
      card.sampler.wrap_u = static_cast<traces::Wrap>(wrap);
      card.sampler.wrap_v = static_cast<traces::Wrap>((2 * wrap + 1) % 5);
      card.sampler.border = models::BorderColor::kOpaqueWhite;
      const auto pictures = studies::render_with_reference(card_stream(card), kEllipse);
      INFO(name_of(card) << " up to " << card.sampler.max_anisotropy << ", wrap " << wrap);
      CHECK(worst(pictures) <= 0.5 / 255.0);
    }
}

TEST_CASE("texture cards: every operation on planes takes an ellipse's texels as the reference does") {
  std::size_t planes = 0;
  for (TextureCard& card : operation_cards()) {
    if (models::place_dimensions(card.view) != 2 || card.sampler.min == models::Filter::kNearest) continue;
    card.sampler.max_anisotropy = 16;
    card.sampler.mip = planes % 2 == 0 ? models::Filter::kLinear : models::Filter::kNearest;
    ++planes;
    INFO(name_of(card));
    CHECK(worst(studies::render_with_reference(card_stream(card), kEllipse)) <= card_tolerance(card));
  }
  CHECK(planes > 20);
}

TEST_CASE("texture cards: without seams joined, a cube's face ends at its own edge, as in the reference") {
  std::size_t cubes = 0;
  for (TextureCard& card : operation_cards()) {
    if (!models::is_cube(card.view)) continue;
    ++cubes;
    card.sampler.seamless = false;
    INFO(name_of(card));
    CHECK(worst(studies::render_with_reference(card_stream(card), {})) <= card_tolerance(card));
  }
  CHECK(cubes > 8);
}

TEST_CASE("texture cards: random machines draw the functional run's pixels of every operation") {
  std::vector<TextureCard> cards = operation_cards();
  for (const TextureCard& card : anisotropy_cards()) cards.push_back(card);
  for (std::size_t i = 0; i < cards.size(); i += 9) {
    INFO(name_of(cards[i]));
    CHECK(machine_faults(card_stream(cards[i]), i + 1) == "");
  }
}

TEST_CASE("texture cards: random machines that take ellipses draw the functional run's pixels") {
  const std::vector<TextureCard> cards = anisotropy_cards();
  for (std::size_t i = 0; i < cards.size(); i += 2) {
    const std::uint64_t seed = 6 * i + 4;
    pipeline::MachineConfig machine;
    randomize(machine, seed);
    REQUIRE(machine.gpu.anisotropic_footprint == models::AnisotropicFootprint::kEllipse);
    INFO(name_of(cards[i]) << " on machine " << seed);
    CHECK(machine_faults(card_stream(cards[i]), seed) == "");
  }
}
