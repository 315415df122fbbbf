/// Copies that a frame asks for, on the contents that the capture brought.
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstring>

#include "models/base/error.h"
#include "traces/capture/device.h"
#include "traces/capture/texels.h"

namespace quadrille::capture {
namespace {

/// Rows of blocks of one level of an image; of formats without blocks, of texels.
struct LevelRows {
  std::vector<std::byte>* texels;
  TexelBlock block;
  std::size_t columns, rows, slices;  ///< blocks of a row, rows of a slice, slices of all layers

  [[nodiscard]] std::size_t row_bytes() const { return columns * block.bytes; }
  [[nodiscard]] std::byte* at(std::size_t slice, std::size_t row, std::size_t column) const {
    return texels->data() + ((slice * rows + row) * columns + column) * block.bytes;
  }
};

/// Blocks along a side of so many texels, of `along` each.
std::size_t blocks_of(std::size_t texels, std::uint32_t along) { return (texels + along - 1) / along; }

LevelRows rows_of(ImageObject& image, std::uint32_t level) {
  if (level >= image.levels) throw user_error("level {} of an image that has {}", level, image.levels);
  const TexelBlock block = texel_block(image.format);
  const auto side = [&](std::uint32_t size) { return std::size_t{std::max(1u, size >> level)}; };
  LevelRows rows{&image.texels[level], block, blocks_of(side(image.width), block.width),
                 blocks_of(side(image.height), block.height), side(image.depth) * image.layers};
  const std::size_t bytes = rows.row_bytes() * rows.rows * rows.slices;
  if (bytes > kMaxObjectBytes)
    throw user_error("an image of {} bytes a level; at most {} are possible", bytes, kMaxObjectBytes);
  if (rows.texels->size() < bytes) rows.texels->resize(bytes);
  return rows;
}

/// A box of blocks within a level.
struct Box {
  std::size_t x, y, slice, columns, rows, slices;
};

Box box_of(const ImageObject& image, const LevelRows& rows, const Value& part, const Value& offset,
           const Value& extent) {
  const std::uint32_t aspect = part["aspectMask"].u32();
  if (aspect != VK_IMAGE_ASPECT_COLOR_BIT && aspect != VK_IMAGE_ASPECT_DEPTH_BIT)
    throw user_error("of stencil values");
  const auto place = [](const Value& number) {
    if (number.i32() < 0) throw user_error("from a place before the image begins");
    return static_cast<std::size_t>(number.i32());
  };
  const bool volume = image.type == VK_IMAGE_TYPE_3D;
  const std::size_t layers = std::min(part["layerCount"].u32(), image.layers);
  const Box box{place(offset["x"]) / rows.block.width,
                place(offset["y"]) / rows.block.height,
                volume ? place(offset["z"]) : part["baseArrayLayer"].u32(),
                blocks_of(extent["width"].u32(), rows.block.width),
                blocks_of(extent["height"].u32(), rows.block.height),
                volume ? extent["depth"].u32() : layers};
  if (box.x + box.columns > rows.columns || box.y + box.rows > rows.rows ||
      box.slice + box.slices > rows.slices)
    throw user_error("of an area beyond the image");
  return box;
}

}  // namespace

void Device::copy_buffer(Handle source, Handle target, const Value& region) {
  const std::vector<std::byte> bytes = contents(object(buffers, source, "buffer"));
  const std::uint64_t from = region["srcOffset"].u64(), size = region["size"].u64();
  if (from > bytes.size() || size > bytes.size() - from)
    throw user_error("of bytes {}+{} of a buffer of {}", from, size, bytes.size());
  write_buffer(target, region["dstOffset"].u64(), std::span(bytes).subspan(from, size));
}

void Device::fill_buffer(const Value& call) {
  const Handle target = call["dstBuffer"].u64();
  const std::uint64_t begin = call["dstOffset"].u64(), size = object(buffers, target, "buffer").size;
  if (size > kMaxObjectBytes)
    throw user_error("a buffer of {} bytes; at most {} are possible", size, kMaxObjectBytes);
  if (begin > size) throw user_error("from byte {} of a buffer of {}", begin, size);
  const std::uint64_t wanted = call["size"].u64();
  const std::uint64_t words = (wanted == VK_WHOLE_SIZE ? size - begin : wanted) / sizeof(std::uint32_t);
  if (words > (size - begin) / sizeof(std::uint32_t))
    throw user_error("of bytes {}+{} of a buffer of {}", begin, wanted, size);
  const std::vector<std::uint32_t> filled(words, call["data"].u32());
  write_buffer(target, begin, std::as_bytes(std::span(filled)));
}

void Device::copy_to_image(Handle source, Handle target, const Value& region) {
  const std::vector<std::byte> bytes = contents(object(buffers, source, "buffer"));
  const auto found = images.find(target);
  if (found == images.end()) throw user_error("image {} was never created", target);
  const Value& part = region["imageSubresource"];
  const LevelRows to = rows_of(found->second, part["mipLevel"].u32());
  const Box box = box_of(found->second, to, part, region["imageOffset"], region["imageExtent"]);
  const auto given = [&](const char* name, std::size_t tight, std::uint32_t along) {
    const std::uint32_t texels = region[name].u32();
    return texels == 0 ? tight : blocks_of(texels, along);
  };
  const std::size_t pitch = given("bufferRowLength", box.columns, to.block.width) * to.block.bytes,
                    slice = given("bufferImageHeight", box.rows, to.block.height) * pitch,
                    row = box.columns * to.block.bytes, begin = region["bufferOffset"].u64();
  for (std::size_t z = 0; z < box.slices; ++z)
    for (std::size_t y = 0; y < box.rows; ++y) {
      const std::size_t at = begin + z * slice + y * pitch;
      if (at > bytes.size() || row > bytes.size() - at)
        throw user_error("of byte {} of a buffer of {}", at, bytes.size());
      std::memcpy(to.at(box.slice + z, box.y + y, box.x), bytes.data() + at, row);
    }
  found->second.from_memory = false;
  ++found->second.writes;
}

void Device::copy_image(Handle source, Handle target, const Value& region) {
  const auto from_image = images.find(source), to_image = images.find(target);
  if (from_image == images.end() || to_image == images.end())
    throw user_error("image {} or {} was never created", source, target);
  const Value &from_part = region["srcSubresource"], &to_part = region["dstSubresource"];
  const LevelRows from = rows_of(from_image->second, from_part["mipLevel"].u32());
  const LevelRows to = rows_of(to_image->second, to_part["mipLevel"].u32());
  if (from.block != to.block)
    throw user_error("between texels of {} and {} bytes", from.block.bytes, to.block.bytes);
  const Box a = box_of(from_image->second, from, from_part, region["srcOffset"], region["extent"]);
  const Box b = box_of(to_image->second, to, to_part, region["dstOffset"], region["extent"]);
  for (std::size_t z = 0; z < std::min(a.slices, b.slices); ++z)
    for (std::size_t y = 0; y < a.rows; ++y)
      std::memmove(to.at(b.slice + z, b.y + y, b.x), from.at(a.slice + z, a.y + y, a.x),
                   a.columns * from.block.bytes);
  to_image->second.from_memory = false;
  ++to_image->second.writes;
}

}  // namespace quadrille::capture
