/// How far apart are two images? Metrics for `quadrille diff` and for tests against another renderer; they
/// know nothing of how an image was made.
///
/// Colours are compared as stored (8 bits a channel, encoded as the file or target has them), so one unit is
/// one least significant bit.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::models::reference {

/// An RGBA8 image, row-major, row 0 at the top, red in bits 0..7. Borrowed.
struct ImageView {
  std::uint32_t width = 0, height = 0;
  std::span<const std::uint32_t> rgba;
};

inline constexpr int kBlockSide = 8;
inline constexpr int kBlockLimit = 8;  ///< a pixel of a block is off if a channel differs by more than this

struct ImageDifference {
  std::uint64_t pixels = 0;  ///< compared
  /// [channel][d]: pixels whose channel differs by d
  std::array<std::array<std::uint64_t, 256>, 4> histogram{};
  /// [d]: pixels whose largest channel difference is d
  std::array<std::uint64_t, 256> max_histogram{};
  int max_lsb = 0;  ///< largest difference of any channel
  /// over red, green and blue, peak 255; infinity for equal images
  double psnr_db = 0;
  /// 8x8 blocks with more than a quarter of their pixels off by more than 8; and all blocks
  std::uint64_t bad_blocks = 0, blocks = 0;
  /// block column and row with the most pixels off; (0, 0) if none is
  std::array<std::uint32_t, 2> worst_block{};

  /// Fraction (0..1) of the pixels whose every channel differs by at most `lsb`; 1 for an empty image.
  [[nodiscard]] double fraction_within(int lsb) const;
};

/// Compares two images of the same size; `UserError` if they are not. Pixels with a nonzero `excluded` entry
/// (empty: none) are left out of everything: they are the listed ties. Alpha is in the histograms only if
/// `with_alpha`.
[[nodiscard]] ImageDifference compare_images(ImageView a, ImageView b,
                                             std::span<const std::uint8_t> excluded = {},
                                             bool with_alpha = true);

struct CoverageDifference {
  std::uint64_t pixels = 0;
  std::uint64_t only_a = 0, only_b = 0;  ///< covered in one, background in the other
  std::uint64_t both = 0;                ///< covered in both
  std::uint64_t other_triangle = 0;      ///< covered in both, by different triangles

  [[nodiscard]] double coverage_fraction() const;  ///< (only_a + only_b) / pixels
  [[nodiscard]] double triangle_fraction() const;  ///< other_triangle / pixels
};

/// Compares which triangle each pixel shows. `background` marks a pixel that none covers.
[[nodiscard]] CoverageDifference compare_triangles(std::span<const std::uint64_t> a,
                                                   std::span<const std::uint64_t> b, std::uint64_t background,
                                                   std::span<const std::uint8_t> excluded = {});

/// A picture of the difference, RGBA8: grey of the first image, dimmed, where equal; then blue (1 LSB)
/// through green (about 8) and yellow to red (64 and more).
[[nodiscard]] std::vector<std::uint32_t> difference_heat_map(ImageView a, ImageView b);

}  // namespace quadrille::models::reference
