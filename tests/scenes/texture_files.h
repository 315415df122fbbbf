/// DDS and KTX2 files in memory, made for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "models/texture/block/block_code.h"

namespace quadrille::scenes {

using FileBytes = std::vector<std::byte>;
using BlockCodeOrNone = std::optional<models::BlockCode>;  ///< none: RGBA8

/// Overwrites so many bytes by a little-endian number.
void put(FileBytes& bytes, std::size_t at, std::uint64_t value, std::size_t count = 4);
/// Levels of chance: finest first.
[[nodiscard]] FileBytes levels_of(BlockCodeOrNone code, std::uint32_t width, std::uint32_t height,
                                  std::uint32_t levels);
/// A DDS file of blocks: by the code of four letters, or by the number of DXGI_FORMAT if it is not 0.
[[nodiscard]] FileBytes dds(const char* letters, std::uint32_t dxgi, std::uint32_t width,
                            std::uint32_t height, std::uint32_t levels, const FileBytes& texels);

struct Ktx {
  std::uint32_t vk_format = 133, width = 20, height = 12, levels = 5, scheme = 0, depth = 0, layers = 0,
                faces = 1, color_model = 0;
};
/// Levels lie coarsest first, as the format asks.
[[nodiscard]] FileBytes ktx2(const Ktx& k, BlockCodeOrNone code, const FileBytes& texels);

}  // namespace quadrille::scenes
