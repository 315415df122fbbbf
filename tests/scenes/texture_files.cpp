#include "tests/scenes/texture_files.h"

#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <iterator>

namespace quadrille::scenes {

void put(FileBytes& bytes, std::size_t at, std::uint64_t value, std::size_t count) {
  std::memcpy(bytes.data() + at, &value, count);
}

namespace {

std::size_t area_bytes(BlockCodeOrNone code, std::uint32_t width, std::uint32_t height) {
  if (!code) return std::size_t{4} * width * height;
  const models::BlockCodeInfo& info = models::block_code_info(*code);
  const std::size_t columns = (width + info.width - 1) / info.width,
                    rows = (height + info.height - 1) / info.height;
  return info.bytes * columns * rows;
}

}  // namespace

FileBytes levels_of(BlockCodeOrNone code, std::uint32_t width, std::uint32_t height, std::uint32_t levels) {
  FileBytes all;
  std::uint32_t state = 1;
  for (std::uint32_t l = 0; l < levels; ++l) {
    const auto bytes = area_bytes(code, std::max(1u, width >> l), std::max(1u, height >> l));
    for (std::uint64_t i = 0; i < bytes; ++i) {
      state = state * 1664525u + 1013904223u;
      all.push_back(static_cast<std::byte>(state >> 24));
    }
  }
  return all;
}

FileBytes dds(const char* letters, std::uint32_t dxgi, std::uint32_t width, std::uint32_t height,
              std::uint32_t levels, const FileBytes& texels) {
  FileBytes file(dxgi == 0 ? 128 : 148);
  std::memcpy(file.data(), "DDS ", 4);
  put(file, 4, 124);
  put(file, 12, height);
  put(file, 16, width);
  put(file, 28, levels);
  put(file, 76, 32);
  put(file, 80, 4);
  std::memcpy(file.data() + 84, letters, 4);
  if (dxgi != 0) {
    put(file, 128, dxgi);
    put(file, 132, 3);
    put(file, 140, 1);
  }
  file.insert(file.end(), texels.begin(), texels.end());
  return file;
}

FileBytes ktx2(const Ktx& k, BlockCodeOrNone code, const FileBytes& texels) {
  constexpr std::uint8_t kMagic[12] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
  const std::size_t descriptor = 80 + std::size_t{24} * k.levels;
  FileBytes file(descriptor + 44);
  std::memcpy(file.data(), kMagic, sizeof kMagic);
  const std::uint32_t fields[] = {
      k.vk_format, 1,       k.width,  k.height, k.depth,
      k.layers,    k.faces, k.levels, k.scheme, static_cast<std::uint32_t>(descriptor),
      44};
  for (std::size_t i = 0; i < std::size(fields); ++i) put(file, 12 + 4 * i, fields[i]);
  put(file, descriptor + 12, k.color_model, 1);
  std::vector<FileBytes> parts;
  std::size_t at = 0;
  for (std::uint32_t l = 0; l < k.levels; ++l) {
    const auto bytes = area_bytes(code, std::max(1u, k.width >> l), std::max(1u, k.height >> l));
    parts.emplace_back(texels.begin() + static_cast<std::ptrdiff_t>(at),
                       texels.begin() + static_cast<std::ptrdiff_t>(at + bytes));
    put(file, 80 + 24 * l + 16, bytes, 8);
    at += bytes;
  }
  for (std::uint32_t l = k.levels; l-- > 0;) {
    FileBytes stored = parts[l];
    if (k.scheme == 2) {
      stored.resize(ZSTD_compressBound(parts[l].size()));
      stored.resize(ZSTD_compress(stored.data(), stored.size(), parts[l].data(), parts[l].size(), 1));
    }
    put(file, 80 + 24 * l, file.size(), 8);
    put(file, 80 + 24 * l + 8, stored.size(), 8);
    file.insert(file.end(), stored.begin(), stored.end());
  }
  return file;
}

}  // namespace quadrille::scenes
