/// Textures that come with their own levels: KTX2 files, and DDS files of compressed blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/texture/block/block_code.h"
#include "scenes/image/image_io.h"

namespace quadrille::scenes {

struct TextureFile {
  std::optional<models::BlockCode> code;  ///< of its blocks; none: RGBA8
  std::uint32_t width = 0, height = 0, levels = 1;
  /// All levels, finest first, tightly packed: rows of texels, or of blocks, of which those at the right
  /// and lower edges may reach beyond the level.
  std::vector<std::byte> bytes;
};

/// Is it one, by its first bytes? A DDS file also has to hold blocks of BC1 to BC7 and several levels: others
/// are pictures (`decode_image`), for which levels are computed.
[[nodiscard]] bool is_texture_file(std::span<const std::byte> bytes);

/// Reads one: a single image of two dimensions, of RGBA8, BC1 to BC7, ETC2, EAC or ASTC, with sides of
/// 1..16384, at most
/// `kMaxImagePixels`, and levels that lie within the file. KTX2 may be compressed by Zstandard; Basis
/// Universal (BasisLZ, UASTC) is refused by name. Throws `UserError` that starts with `name`. [KTX2], [DDS]
[[nodiscard]] TextureFile read_texture_file(std::span<const std::byte> bytes, const std::string& name);

/// The bytes of a level as the file has them.
[[nodiscard]] std::span<const std::byte> stored_level(const TextureFile& file, std::uint32_t level);
/// A level as a sampler of eight bits sees it. Components that the code lacks are (0, 0, 0, 1), signed
/// numbers below 0 are 0, halves are clamped to 0..1.
[[nodiscard]] Rgba8Image decoded_level(const TextureFile& file, std::uint32_t level);

}  // namespace quadrille::scenes
