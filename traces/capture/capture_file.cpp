/// Header, options, blocks, compression.
#include "traces/capture/capture_file.h"

#include <lz4.h>
#include <zstd.h>

#include <bit>
#include <cstring>
#include <limits>

#include "models/base/error.h"
#include "traces/whole_file.h"

namespace quadrille::capture {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers of the file are copied as they lie");

constexpr std::uint32_t kFourCc = 0x52584647;  // "GFXR"
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30;
// What one block, and all of a file, may expand to: a bound on what a hostile file can ask for.
constexpr std::uint64_t kMaxBlockBytes = std::uint64_t{1} << 30;
constexpr std::uint64_t kMaxExpandedBytes = std::uint64_t{8} << 30;
constexpr std::uint32_t kMaxOptions = 64;
constexpr std::uint32_t kCompressionOption = 1;
constexpr std::uint32_t kPlain = 0, kLz4 = 1, kZstd = 3;
constexpr std::uint32_t kCompressedBit = 0x80000000u;
constexpr std::uint32_t kFrameMarkBlock = 1, kStateMarkBlock = 2, kMetaDataBlock = 3, kCallBlock = 4;
// LZ4 and Zstandard cannot shrink more than this; a block that says so is not what it says [G: 255 and 2^17]
constexpr std::uint64_t kMostLz4 = 255, kMostZstd = std::uint64_t{1} << 18;

void look_at_capture(const std::string& name, std::span<const std::byte> beginning) {
  std::uint32_t code = 0;
  if (beginning.size() >= sizeof(code)) std::memcpy(&code, beginning.data(), sizeof(code));
  if (code != kFourCc)
    throw user_error("{}: not a capture of gfxreconstruct (its first bytes are not GFXR)", name);
}

}  // namespace

template <class T>
T take_number(std::span<const std::byte>& bytes, const std::string& place) {
  if (bytes.size() < sizeof(T)) throw user_error("{}: ends within a number", place);
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  bytes = bytes.subspan(sizeof(T));
  return value;
}
template std::uint32_t take_number(std::span<const std::byte>&, const std::string&);
template std::uint64_t take_number(std::span<const std::byte>&, const std::string&);

CaptureFile::CaptureFile(const std::string& path)
    : CaptureFile(path,
                  traces::read_whole_file(path, kMaxFileBytes, [&](std::span<const std::byte> beginning) {
                    look_at_capture(path, beginning);
                  })) {}

CaptureFile::CaptureFile(std::string name, std::vector<std::byte> bytes)
    : name_(std::move(name)), bytes_(std::move(bytes)) {
  look_at_capture(name_, bytes_);
  read_header();
}

void CaptureFile::read_header() {
  const std::string place = name_ + ": header";
  std::span<const std::byte> rest(bytes_);
  (void)take_number<std::uint32_t>(rest, place);
  const auto major = take_number<std::uint32_t>(rest, place);
  (void)take_number<std::uint32_t>(rest, place);
  if (major != 0)
    throw user_error("{}: version {} of the format; this program reads version 0", place, major);
  const auto options = take_number<std::uint32_t>(rest, place);
  if (options > kMaxOptions)
    throw user_error("{}: {} options; at most {} are possible", place, options, kMaxOptions);
  for (std::uint32_t i = 0; i < options; ++i) {
    const auto key = take_number<std::uint32_t>(rest, place);
    const auto value = take_number<std::uint32_t>(rest, place);
    if (key == kCompressionOption) compression_ = value;
  }
  if (compression_ != kPlain && compression_ != kLz4 && compression_ != kZstd)
    throw user_error("{}: compression {}; 0 (none), 1 (LZ4) and 3 (Zstandard) can be read", place,
                     compression_);
  at_ = bytes_.size() - rest.size();
}

std::optional<Block> CaptureFile::next() {
  if (at_ == bytes_.size()) return std::nullopt;
  const std::string place = fmt::format("{}: block {}", name_, index_);
  std::span<const std::byte> rest = std::span<const std::byte>(bytes_).subspan(at_);
  const auto size = take_number<std::uint64_t>(rest, place);
  const auto type = take_number<std::uint32_t>(rest, place);
  if (size > rest.size())
    throw user_error("{}: {} bytes long where {} remain in the file", place, size, rest.size());
  at_ = bytes_.size() - rest.size() + size;
  Block block = read_block(type, rest.first(size));
  ++index_;
  return block;
}

Block CaptureFile::read_block(std::uint32_t type, std::span<const std::byte> body) {
  Block block;
  block.index = index_;
  const std::string place = fmt::format("{}: block {}", name_, index_);
  const bool compressed = (type & kCompressedBit) != 0;
  const std::uint32_t kind = type & ~kCompressedBit;
  if (kind == kCallBlock) {
    read_call(block, body, compressed);
  } else if (kind == kMetaDataBlock) {
    read_meta_data(block, body, compressed);
  } else if (kind == kFrameMarkBlock || kind == kStateMarkBlock) {
    block.kind = kind == kFrameMarkBlock ? BlockKind::kFrameMark : BlockKind::kStateMark;
    block.id = take_number<std::uint32_t>(body, place);
  }
  return block;
}

void CaptureFile::read_call(Block& block, std::span<const std::byte> body, bool compressed) {
  const std::string place = fmt::format("{}: block {}", name_, index_);
  block.kind = BlockKind::kCall;
  block.id = take_number<std::uint32_t>(body, place);
  (void)take_number<std::uint64_t>(body, place);  // thread
  block.data = body;
  if (!compressed) return;
  const auto size = take_number<std::uint64_t>(body, place);
  expand(block, body, size);
}

void CaptureFile::read_meta_data(Block& block, std::span<const std::byte> body, bool compressed) {
  const std::string place = fmt::format("{}: block {}", name_, index_);
  const auto take = [&] { block.numbers.push_back(take_number<std::uint64_t>(body, place)); };
  const auto take_short = [&] { block.numbers.push_back(take_number<std::uint32_t>(body, place)); };
  block.kind = BlockKind::kMetaData;
  block.id = take_number<std::uint32_t>(body, place) & 0xffff;  // above: the API
  if (block.id == kDeviceProperties) {
    (void)take_number<std::uint64_t>(body, place);  // thread
    take();                                         // physical device
    for (int i = 0; i < 5; ++i) take_short();       // versions of API and driver, vendor, device, kind
    return;
  }
  if (block.id != kFillMemory && block.id != kInitBuffer && block.id != kInitImage) return;
  (void)take_number<std::uint64_t>(body, place);  // thread
  // memory, offset, size; or device, buffer or image, size
  for (int i = 0; i < 3; ++i) take();
  const std::uint64_t size = block.numbers[2];
  if (block.id == kInitImage) {
    for (int i = 0; i < 3; ++i) take_short();  // aspect, layout, levels
    const std::uint64_t levels = block.numbers[5];
    if (levels > 32) throw user_error("{}: an image of {} levels; at most 32 are possible", place, levels);
    for (std::uint64_t i = 0; i < levels; ++i) take();
  }
  block.data = body;
  if (compressed && size > 0) expand(block, body, size);
  if (block.data.size() < size)
    throw user_error("{}: {} bytes of contents where {} are announced", place, block.data.size(), size);
  block.data = block.data.first(size);
}

void CaptureFile::expand(Block& block, std::span<const std::byte> packed, std::uint64_t size) {
  const std::string place = fmt::format("{}: block {}", name_, index_);
  if (compression_ == kPlain) throw user_error("{}: compressed in a file without compression", place);
  const std::uint64_t most = compression_ == kLz4 ? kMostLz4 : kMostZstd;
  expanded_ += size;
  if (size > kMaxBlockBytes || expanded_ > kMaxExpandedBytes || size / most > packed.size())
    throw user_error("{}: {} bytes would expand to {}", place, packed.size(), size);
  block.held = std::make_shared<std::vector<std::byte>>(size);
  bool whole = false;
  if (compression_ == kLz4) {
    constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<int>::max());
    whole = packed.size() <= kMost &&
            LZ4_decompress_safe(reinterpret_cast<const char*>(packed.data()),
                                reinterpret_cast<char*>(block.held->data()), static_cast<int>(packed.size()),
                                static_cast<int>(size)) == static_cast<int>(size);
  } else {
    whole = ZSTD_decompress(block.held->data(), size, packed.data(), packed.size()) == size;
  }
  if (!whole) throw user_error("{}: its compressed bytes are damaged", place);
  block.data = *block.held;
}

}  // namespace quadrille::capture
