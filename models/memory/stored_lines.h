/// How the lines of surfaces lie in memory: as they are, encoded in their first sectors, or not at all
/// because they equal another line.
///
/// The caches of depth and colour units write it down when a line leaves them, and whoever reads a line asks
/// it. It stands for tables that lie on the chip, and asking costs nothing (docs/deviations.md#D110). The
/// pixels themselves always lie plain in `DeviceMemory`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::models {

class StoredLines {
 public:
  /// What is to be read to have a line that is not plain.
  struct Place {
    std::uint32_t line = 0;
    std::uint8_t sectors = 0;  ///< bits 0..3
  };
  /// Is it to be read as a whole, because it is encoded or lies elsewhere?
  [[nodiscard]] bool is_encoded(std::uint32_t line) const { return code_of(line) != kPlain; }
  [[nodiscard]] bool is_copy(std::uint32_t line) const { return code_of(line) >= kCopy; }
  /// The line that a copy equals.
  [[nodiscard]] std::uint32_t original_of(std::uint32_t line) const {
    return line - (code_of(line) & ~std::uint32_t{kCopy});
  }
  [[nodiscard]] Place place_of(std::uint32_t line) const {
    if (is_copy(line)) line = original_of(line);
    const std::uint8_t sectors = code_of(line);
    return {line, static_cast<std::uint8_t>(sectors == kPlain ? kAllSectors : (1u << sectors) - 1)};
  }

  void set_plain(std::uint32_t line) {
    if (line < codes_.size()) codes_[line] = kPlain;
  }
  /// In so many sectors (1..3).
  void set_encoded(std::uint32_t line, std::uint32_t sectors) { set(line, sectors); }
  /// It equals an earlier line, at most 127 before it, that is no copy.
  void set_copy(std::uint32_t line, std::uint32_t original) { set(line, kCopy | (line - original)); }

 private:
  static constexpr std::uint8_t kPlain = 0, kCopy = 0x80, kAllSectors = 0xf;
  [[nodiscard]] std::uint8_t code_of(std::uint32_t line) const {
    return line < codes_.size() ? codes_[line] : kPlain;
  }
  void set(std::uint32_t line, std::uint32_t code) {
    if (line >= codes_.size()) codes_.resize(std::size_t{line} + 1, kPlain);
    codes_[line] = static_cast<std::uint8_t>(code);
  }

  std::vector<std::uint8_t> codes_;  ///< by line; those beyond the end are plain
};

}  // namespace quadrille::models
