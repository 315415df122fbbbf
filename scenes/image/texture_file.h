/// Textures that come in blocks and with their own levels: DDS and KTX2 files. Their bytes go to the machine as
/// they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/image/image_io.h"
#include "traces/command_stream.h"

namespace quadrille::scenes {

struct TextureFile {
  traces::Format format = traces::Format::kUndefined;  ///< as the file has it
  std::uint32_t width = 0, height = 0, levels = 1;
  std::vector<std::byte> texels;  ///< as `traces::Image::texels`
};

/// Is it one, by its first bytes? A DDS file also has to hold blocks of BC1 to BC7 and several levels: others
/// are pictures (scenes/image/image_io.h), for which levels are computed.
[[nodiscard]] bool is_texture_file(std::span<const std::byte> bytes);

/// Reads one: a single image of two dimensions, of a format of `models::kFileUse` that is known by name in the
/// file, with sides of 1..16384, `kMaxImagePixels` at most, and levels that lie within the file. KTX2 may be
/// compressed by Zstandard. Basis Universal (BasisLZ, UASTC) is refused by name. Throws `UserError` that
/// starts with `name`. [KTX2], [DDS]
[[nodiscard]] TextureFile read_texture_file(std::span<const std::byte> bytes, const std::string& name);

/// The finest level as a picture of eight bits: halves are rounded and clamped, components that lack are 0, alpha 1.
[[nodiscard]] Rgba8Image finest_level(const TextureFile& file);

/// The same format with sRGB encoding, or without, where both exist: glTF says by a texture's role which it is.
[[nodiscard]] traces::Format with_encoding(traces::Format format, bool srgb);

}  // namespace quadrille::scenes
