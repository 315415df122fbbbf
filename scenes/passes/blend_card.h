/// Where the fields of the test card of blending lie, and what is mixed in them.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace quadrille::scenes {

/// Colours of a field's upper and lower edge, alphas of its left and right one; linear between them.
struct Ramp {
  glm::vec3 top{0}, bottom{0};
  float left = 1, right = 1;
};

class BlendCard {
 public:
  static constexpr Ramp kBackground{{0.9F, 0.75F, 0.2F}, {0.25F, 0.6F, 0.85F}, 1, 1};
  /// What the first row mixes with it.
  static constexpr Ramp kSource{{0.8F, 0.15F, 0.2F}, {0.3F, 0.5F, 0.1F}, 0, 1};
  /// The two layers of the second row.
  static constexpr Ramp kLower{{0.1F, 0.7F, 0.3F}, {0.7F, 0.1F, 0.6F}, 0.1F, 0.9F};
  static constexpr Ramp kUpper{{0.9F, 0.2F, 0.1F}, {0.2F, 0.3F, 0.9F}, 0.8F, 0.2F};
  static constexpr int kColumns = 6, kRows = 3;
  /// Fields of the second row; those of the first are the six ways of the lectures.
  static constexpr int kStraight = 6, kPremultiplied = 7, kStraightGroup = 8, kPremultipliedGroup = 9,
                       kFrontToBack = 10, kDividedGroup = 11;
  /// The first of the third row: levels 0, 2 and 4 of the mask, straight and premultiplied.
  static constexpr int kMasks = 12;
  static constexpr std::uint32_t kMaskSide = 32, kMaskLevels = 6;

  /// On a picture of so many pixels, at least a column and row for each field.
  BlendCard(std::uint32_t width, std::uint32_t height);
  struct Place {
    int x = 0, y = 0;
  };
  /// The upper left pixel of a field, counted row by row.
  [[nodiscard]] Place place(int field) const;
  [[nodiscard]] int side() const { return side_; }  ///< of a field, in pixels
  [[nodiscard]] static const char* name(int field);
  /// Of the largest level.
  [[nodiscard]] static glm::vec4 mask_texel(std::uint32_t x, std::uint32_t y, bool premultiplied);

 private:
  int width_, height_, pitch_, side_;
};

}  // namespace quadrille::scenes
