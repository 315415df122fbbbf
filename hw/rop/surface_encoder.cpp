#include "hw/rop/surface_encoder.h"

#include "hw/frame/laws.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw {
namespace {

constexpr std::uint32_t kAllWords = 0xffffffffu;

/// Words of a line that hold pixels.
std::uint32_t words_of(const models::SurfaceLayout& layout) {
  return layout.line_sectors() == 0xf ? kAllWords : 0xffffu;
}
constexpr std::uint8_t first_sectors(std::uint32_t count) {
  return static_cast<std::uint8_t>((1u << count) - 1);
}

}  // namespace

SurfaceEncoder::SurfaceEncoder(StatGroup& stats, L1Cache& cache, models::DeviceMemory& memory,
                               const SurfaceCompression& compression)
    : cache_(cache), memory_(memory), compression_(compression), stats_(stats) {
  if (on()) cache_.store_through(*this);
}

void SurfaceEncoder::add(const AttachmentState& surface) {
  surfaces_.push_back(
      {surface.surface, models::LineCodec(surface.format, compression_.planes), surface.encodes});
}

const SurfaceEncoder::Surface& SurfaceEncoder::surface_of(std::uint32_t line) const {
  const std::uint64_t address = std::uint64_t{line} * models::kLineBytes;
  const auto found = std::ranges::find_if(surfaces_, [&](const Surface& s) {
    return address >= s.layout.base && address < s.layout.base + s.layout.bytes();
  });
  QUADRILLE_CHECK(found != surfaces_.end(), "line {} is of no surface of the pass", line);
  return *found;
}

bool SurfaceEncoder::is_open(std::uint32_t line) const {
  return std::ranges::find(open_, line) != open_.end();
}

std::span<const std::byte> SurfaceEncoder::pixels_of(const Surface& surface, std::uint32_t line) const {
  return std::as_const(memory_).read(std::uint64_t{line} * models::kLineBytes, surface.codec.line_bytes());
}

bool SurfaceEncoder::equal(const Surface& surface, std::uint32_t a, std::uint32_t b) const {
  return !is_open(a) && !is_open(b) && std::ranges::equal(pixels_of(surface, a), pixels_of(surface, b));
}

// --- Before a write ---

bool SurfaceEncoder::prepare_write(std::uint32_t line, std::uint32_t words, MemoryPort& port) {
  const Surface& surface = surface_of(line);
  if (!surface.encodes) return true;
  if (!is_open(line)) open_.push_back(line);
  if (!part_copies(surface, line, port)) return false;
  const bool whole = words == words_of(surface.layout);
  if (lines().is_copy(line)) {
    if (!whole) return part_from_original(surface, line, port);
    forget(line);
    return true;
  }
  if (whole || !lines().is_encoded(line) || cache_.has_place(line)) return true;
  return cache_.access(line, surface.layout.line_sectors(), kNobody, port) != L1Cache::Result::kStall;
}

/// The copies of a line become lines of their own.
bool SurfaceEncoder::part_copies(const Surface& surface, std::uint32_t original, MemoryPort& port) {
  if (!keeps_copies() || surface.sample_of(original) != 0) return true;
  for (std::uint32_t s = 1; s < surface.layout.samples; ++s) {
    const std::uint32_t line = original + s * surface.layout.plane_lines();
    if (lines().is_copy(line) && !part_from_original(surface, line, port)) return false;
  }
  return true;
}

bool SurfaceEncoder::part_from_original(const Surface& surface, std::uint32_t line, MemoryPort& port) {
  const std::uint8_t all = surface.layout.line_sectors();
  if (cache_.holds(lines().original_of(line), all) || cache_.has_place(line)) {
    if (!cache_.claim(line, all, port)) return false;
  } else if (cache_.access(line, all, kNobody, port) == L1Cache::Result::kStall) {
    return false;
  }
  cache_.write(line, words_of(surface.layout));
  forget(line);
  return true;
}

// --- When a line leaves ---

std::uint8_t SurfaceEncoder::store(const L1Cache::Leaving& leaving) {
  const Surface& surface = surface_of(leaving.line);
  const std::uint8_t all = surface.layout.line_sectors();
  std::uint8_t stored = leaving.dirty;
  if (surface.encodes && (leaving.present & all) == all) {
    stored = store_whole(surface, leaving);
  } else {
    QUADRILLE_CHECK(!lines().is_encoded(leaving.line), "a part of line {} leaves, which is encoded",
                    leaving.line);
    ++stats_.plain;
  }
  stats_.plain_bytes += models::sector_bytes(leaving.dirty) + models::sector_bytes(leaving.parts);
  stats_.stored_bytes += models::sector_bytes(stored) + models::sector_bytes(leaving.parts);
  return stored;
}

std::uint8_t SurfaceEncoder::store_whole(const Surface& surface, const L1Cache::Leaving& leaving) {
  const std::uint32_t sample = surface.sample_of(leaving.line);
  if (keeps_copies() && sample != 0) {
    const std::uint32_t first = leaving.line - sample * surface.layout.plane_lines();
    if (cache_.holds(first, surface.layout.line_sectors()) && equal(surface, first, leaving.line)) {
      memory_.stored_lines().set_copy(leaving.line, first);
      ++stats_.copied;
      return 0;
    }
  }
  if (keeps_copies() && sample == 0) find_copies(surface, leaving.line);
  return encode(surface, leaving);
}

/// The original leaves: those of its later samples that equal it have nothing to write any more.
void SurfaceEncoder::find_copies(const Surface& surface, std::uint32_t original) {
  const std::uint8_t all = surface.layout.line_sectors();
  for (std::uint32_t s = 1; s < surface.layout.samples; ++s) {
    const std::uint32_t line = original + s * surface.layout.plane_lines();
    if (!cache_.holds(line, all) || cache_.dirty_sectors(line) == 0 || !equal(surface, original, line))
      continue;
    stats_.plain_bytes += models::sector_bytes(cache_.dirty_sectors(line));
    cache_.clean(line);
    memory_.stored_lines().set_copy(line, original);
    ++stats_.copied;
  }
}

/// A line that is plain in memory, and of which little was written, stays plain where its encoding is longer
/// than that.
std::uint8_t SurfaceEncoder::encode(const Surface& surface, const L1Cache::Leaving& leaving) {
  const bool was_encoded = lines().is_encoded(leaving.line);
  const std::uint8_t all = surface.layout.line_sectors();
  const auto plainly = static_cast<std::uint8_t>(was_encoded ? all : leaving.dirty);
  models::EncodedLine encoded;
  if (!is_open(leaving.line)) encoded = surface.codec.encode(pixels_of(surface, leaving.line));
  if (encoded.encoding == models::LineEncoding::kPlain ||
      encoded.sectors() > static_cast<unsigned>(std::popcount(plainly))) {
    forget(leaving.line);
    ++stats_.plain;
    return plainly;
  }
  std::array<std::byte, models::kLineBytes> decoded{};
  const auto pixels = std::span(decoded).first(surface.codec.line_bytes());
  surface.codec.decode(encoded, pixels);
  QUADRILLE_CHECK(std::ranges::equal(pixels, pixels_of(surface, leaving.line)),
                  "line {} is not what its encoding says", leaving.line);
  memory_.stored_lines().set_encoded(leaving.line, encoded.sectors());
  ++(encoded.encoding == models::LineEncoding::kPlane ? stats_.plane : stats_.offset);
  return first_sectors(encoded.sectors());
}

std::uint8_t SurfaceEncoder::store_cleared(std::uint32_t line, bool with_first) {
  const Surface& surface = surface_of(line);
  const std::uint8_t all = surface.layout.line_sectors();
  std::uint8_t stored = 0;
  if (const std::uint32_t sample = surface.sample_of(line); keeps_copies() && with_first && sample != 0) {
    memory_.stored_lines().set_copy(line, line - sample * surface.layout.plane_lines());
    ++stats_.copied;
  } else {
    stored = encode(surface, {line, all, all});
  }
  stats_.plain_bytes += models::sector_bytes(all);
  stats_.stored_bytes += models::sector_bytes(stored);
  return stored;
}

void SurfaceEncoder::audit(Audit& audit, const MemoryPort& port) const {
  audit.left(laws::kSurfaceBytes, on() ? stats_.stored_bytes.value() : port.stats().write_bytes.value());
}

}  // namespace quadrille::hw
