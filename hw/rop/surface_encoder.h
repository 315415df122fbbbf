/// How the lines of a pass's surfaces are stored when they leave a depth or colour cache: as they are, or
/// encoded in fewer sectors (models/rop/line_encoding.h).
///
/// A line is encoded when all of it is in the cache. From memory it is then read whole, so a write to a part
/// of it asks for the encoding first. Of several samples a pixel, the line of a later sample that equals the
/// one of the first sample moves nothing: it is a *copy*. Before the original changes, its copies become
/// lines of their own in the cache.
///
/// Not modelled: cycles of encoder and decoder; traffic of the line states (docs/deviations.md#D110).
#pragma once

#include "hw/frame/frame.h"
#include "hw/memory/l1_cache.h"
#include "models/rop/line_encoding.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille::hw {

enum class DepthCompression : std::uint8_t { kNone, kOffset, kPlaneOffset };
enum class ColorCompression : std::uint8_t { kNone, kOffset, kSamplesOffset };

/// What may be done to lines.
struct SurfaceCompression {
  bool lines = false;    ///< encoded by themselves
  bool planes = false;   ///< also by planes
  bool samples = false;  ///< lines of later samples that equal those of the first are copies
  [[nodiscard]] static SurfaceCompression of(DepthCompression c) {
    return {c != DepthCompression::kNone, c == DepthCompression::kPlaneOffset, false};
  }
  [[nodiscard]] static SurfaceCompression of(ColorCompression c) {
    return {c != ColorCompression::kNone, false, c == ColorCompression::kSamplesOffset};
  }
};

/// They count only while lines are encoded.
struct SurfaceEncoderStats {
  explicit SurfaceEncoderStats(StatGroup& group)
      : plain{group, "plain_lines", "line",
              "Lines written back as they are, whole or in part, by a cache that encodes lines"},
        offset{group, "offset_lines", "line", "Lines written back as offsets from their least codes"},
        plane{group, "plane_lines", "line", "Lines written back as a plane and what it misses by"},
        copied{group, "copied_lines", "line", "Lines that equal those of the first sample: nothing moves"},
        plain_bytes{group, "unencoded_write_bytes", "byte", "What those lines would have moved as they are"},
        stored_bytes{group, "encoded_write_bytes", "byte", "What they moved"} {}
  Counter plain, offset, plane, copied, plain_bytes, stored_bytes;
};

class SurfaceEncoder final : public L1Cache::Store {
 public:
  /// Of this cache, which outlives it.
  SurfaceEncoder(StatGroup& stats, L1Cache& cache, models::DeviceMemory& memory,
                 const SurfaceCompression& compression);
  /// Lines are encoded.
  [[nodiscard]] bool on() const { return compression_.lines; }
  [[nodiscard]] bool keeps_copies() const { return compression_.samples; }
  /// The surfaces of the last pass are forgotten; those of the next are added one by one.
  void begin_pass() { surfaces_.clear(); }
  void add(const AttachmentState& surface);

  [[nodiscard]] const models::StoredLines& lines() const { return memory_.stored_lines(); }
  /// The next write of the line is the first: what is stored of it does not matter.
  void forget(std::uint32_t line) { memory_.stored_lines().set_plain(line); }
  /// Words of a line are about to be written: sees that what else there is of it, and of its copies, is in
  /// the cache or on its way there. False when there is no place for it now: try again after a fill. Until
  /// `pixels_written` the line counts as not known.
  bool prepare_write(std::uint32_t line, std::uint32_t words, MemoryPort& port);
  /// The pixels of all that was prepared are in memory.
  void pixels_written() { open_.clear(); }

  std::uint8_t store(const L1Cache::Leaving& leaving) override;
  /// The line, which is not in the cache, is written as the pass has cleared it. `with_first`: so is the line
  /// of its first sample.
  std::uint8_t store_cleared(std::uint32_t line, bool with_first);
  /// The bytes of what was written, line by line; where nothing is encoded, those of the port.
  void audit(Audit& audit, const MemoryPort& port) const;

  /// As who waits for a line: nobody.
  static constexpr std::uint32_t kNobody = 0xfffffffeu;

 private:
  struct Surface {
    models::SurfaceLayout layout;
    models::LineCodec codec;
    bool encodes = true;
    [[nodiscard]] std::uint32_t first_line() const {
      return static_cast<std::uint32_t>(layout.base / models::kLineBytes);
    }
    /// Of the line's plane.
    [[nodiscard]] std::uint32_t sample_of(std::uint32_t line) const {
      return (line - first_line()) / layout.plane_lines() % layout.samples;
    }
  };
  [[nodiscard]] const Surface& surface_of(std::uint32_t line) const;
  [[nodiscard]] bool is_open(std::uint32_t line) const;
  [[nodiscard]] bool equal(const Surface& surface, std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] std::span<const std::byte> pixels_of(const Surface& surface, std::uint32_t line) const;
  std::uint8_t store_whole(const Surface& surface, const L1Cache::Leaving& leaving);
  std::uint8_t encode(const Surface& surface, const L1Cache::Leaving& leaving);
  void find_copies(const Surface& surface, std::uint32_t original);
  bool part_copies(const Surface& surface, std::uint32_t original, MemoryPort& port);
  bool part_from_original(const Surface& surface, std::uint32_t line, MemoryPort& port);

  L1Cache& cache_;
  models::DeviceMemory& memory_;
  const SurfaceCompression compression_;
  SurfaceEncoderStats stats_;
  std::vector<Surface> surfaces_;
  std::vector<std::uint32_t> open_;  ///< lines that are being written, whose pixels memory does not hold yet
};

}  // namespace quadrille::hw
