/// The container: header, chunks, checksums, compression, and a file that appears whole or not at all.
#include "traces/trace_file.h"

#include <xxhash.h>
#include <zstd.h>

#include <array>
#include <cstring>
#include <string_view>

#include "models/base/error.h"
#include "traces/trace_codec.h"
#include "traces/whole_file.h"

namespace quadrille::traces {
namespace {

constexpr std::array<char, 8> kMagic{'\x89', 'Q', 'T', 'R',
                                     // the first byte shows transfers that are not 8-bit clean
                                     'A', 'C', 'E', '\n'};
// zstd level: most of a trace is texels, which gain little from more [G: quick to write matters more]
constexpr int kCompression = 1;

struct FileHeader {
  std::array<char, 8> magic;
  std::uint32_t version, chunks;
};
static_assert(sizeof(FileHeader) == 16);

struct ChunkHeader {
  std::array<char, 4> tag;
  std::uint32_t version;  ///< of the chunk; files of version 1 have 0 here and version 1 of each
  std::uint64_t stored_bytes, decoded_bytes;
  std::uint64_t checksum;  ///< of the fields above and the payload
};
static_assert(sizeof(ChunkHeader) == 32);

bool in_file(std::size_t chunk, std::uint32_t version) { return version == 1 || kChunks[chunk].version > 0; }
std::uint32_t chunks_in_file(std::uint32_t version) {
  std::uint32_t chunks = 0;
  for (std::size_t i = 0; i < kChunks.size(); ++i) chunks += in_file(i, version) ? 1u : 0u;
  return chunks;
}

[[noreturn]] void refuse_other_file(const std::string& name) {
  throw user_error("{}: not a trace file (its first bytes are not those of a .qtrace)", name);
}

std::uint64_t checksum(const ChunkHeader& header, const std::byte* payload) {
  const std::uint64_t seed = XXH3_64bits(&header, offsetof(ChunkHeader, checksum));
  return XXH3_64bits_withSeed(payload, header.stored_bytes, seed);
}

void append(std::vector<std::byte>& bytes, const void* data, std::size_t size) {
  const std::size_t end = bytes.size();
  bytes.resize(end + size);
  std::memcpy(bytes.data() + end, data, size);
}

void append_chunk(std::vector<std::byte>& bytes, const CommandStream& stream, Chunk chunk) {
  const std::vector<std::byte> payload = encode_chunk(stream, chunk);
  std::vector<std::byte> packed(ZSTD_compressBound(payload.size()));
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), payload.data(), payload.size(), kCompression);
  QUADRILLE_CHECK(!ZSTD_isError(size), "zstd: {}", ZSTD_getErrorName(size));
  const ChunkInfo& info = kChunks[static_cast<std::size_t>(chunk)];
  ChunkHeader header{{}, info.version, size, payload.size(), 0};
  std::memcpy(header.tag.data(), info.tag, header.tag.size());
  header.checksum = checksum(header, packed.data());
  append(bytes, &header, sizeof(header));
  append(bytes, packed.data(), size);
}

/// Takes the file apart from front to back.
class Parser {
 public:
  Parser(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  CommandStream parse() {
    read_header();
    CommandStream stream;
    for (std::size_t i = 0; i < kChunks.size(); ++i) {
      if (in_file(i, version_)) read_chunk(stream, static_cast<Chunk>(i));
    }
    if (!bytes_.empty()) throw user_error("{}: {} bytes follow the last chunk", name_, bytes_.size());
    return stream;
  }

 private:
  template <class T>
  T take(const std::string& place) {
    if (bytes_.size() < sizeof(T)) throw user_error("{}: the file ends inside its header", place);
    T value;
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }

  void read_header() {
    const auto header = take<FileHeader>(name_);
    if (header.magic != kMagic) refuse_other_file(name_);
    if (header.version < 1 || header.version > kTraceVersion)
      throw user_error("{}: trace version {}; this program reads versions 1 to {}", name_, header.version,
                       kTraceVersion);
    version_ = header.version;
    if (header.chunks != chunks_in_file(version_))
      throw user_error("{}: {} chunks; version {} has {}", name_, header.chunks, version_,
                       chunks_in_file(version_));
  }

  void read_chunk(CommandStream& stream, Chunk chunk) {
    const ChunkInfo& info = kChunks[static_cast<std::size_t>(chunk)];
    const std::string place = fmt::format("{}: chunk {}", name_, info.tag);
    const auto header = take<ChunkHeader>(place);
    check(header, chunk, place);
    const std::uint32_t version = version_ == 1 ? 1 : header.version;
    if (version_ > 1 && (version < 1 || version > info.version))
      throw user_error("{}: its version is {}; this program reads versions 1 to {}", place, version,
                       info.version);
    const std::vector<std::byte> payload = unpack(header, place);
    bytes_ = bytes_.subspan(header.stored_bytes);
    chunks_.decode(stream, chunk, version, payload, place);
  }

  void check(const ChunkHeader& header, Chunk chunk, const std::string& place) {
    const std::string_view tag = kChunks[static_cast<std::size_t>(chunk)].tag;
    if (std::string_view(header.tag.data(), header.tag.size()) != tag)
      throw user_error("{}: another chunk is in its place", place);
    if (header.stored_bytes > bytes_.size())
      throw user_error("{}: {} bytes are announced where {} remain", place, header.stored_bytes,
                       bytes_.size());
    if (header.decoded_bytes > kMaxTraceBytes - decoded_)
      throw user_error("{}: decodes to {} bytes; a trace may take {}", place, header.decoded_bytes,
                       kMaxTraceBytes);
    decoded_ += header.decoded_bytes;
    if (checksum(header, bytes_.data()) != header.checksum)
      throw user_error("{}: its checksum does not match; the file is damaged", place);
  }

  std::vector<std::byte> unpack(const ChunkHeader& header, const std::string& place) {
    if (ZSTD_getFrameContentSize(bytes_.data(), header.stored_bytes) != header.decoded_bytes)
      throw user_error("{}: its two sizes disagree", place);
    std::vector<std::byte> payload(header.decoded_bytes);
    const std::size_t size =
        ZSTD_decompress(payload.data(), payload.size(), bytes_.data(), header.stored_bytes);
    if (ZSTD_isError(size))
      throw user_error("{}: cannot be decompressed: {}", place, ZSTD_getErrorName(size));
    if (size != payload.size())
      throw user_error("{}: decompresses to {} bytes instead of {}", place, size, payload.size());
    return payload;
  }

  std::span<const std::byte> bytes_;
  const std::string& name_;
  std::uint64_t decoded_ = 0;
  std::uint32_t version_ = 0;
  ChunkReader chunks_;
};

}  // namespace

std::vector<std::byte> encode_trace(const CommandStream& stream) {
  for (const Image& image : stream.images) QUADRILLE_CHECK(!image.packed, "image '{}' is packed", image.name);
  std::vector<std::byte> bytes;
  const FileHeader header{kMagic, kTraceVersion, chunks_in_file(kTraceVersion)};
  append(bytes, &header, sizeof(header));
  for (std::size_t i = 0; i < kChunks.size(); ++i) {
    if (in_file(i, kTraceVersion)) append_chunk(bytes, stream, static_cast<Chunk>(i));
  }
  return bytes;
}

CommandStream decode_trace(std::span<const std::byte> bytes, const std::string& name) {
  CommandStream stream = Parser(bytes, name).parse();
  try {
    validate(stream);
  } catch (const UserError& error) { throw user_error("{}: {}", name, error.what()); }
  return stream;
}

void write_trace(const CommandStream& stream, const std::string& path) {
  write_whole_file(path, encode_trace(stream));
}

CommandStream read_trace(const std::string& path) {
  const auto look = [&](std::span<const std::byte> beginning) {
    if (beginning.size() >= sizeof(FileHeader) &&
        std::memcmp(beginning.data(), kMagic.data(), kMagic.size()) != 0)
      refuse_other_file(path);
  };
  return decode_trace(read_whole_file(path, kMaxTraceBytes, look), path);
}

}  // namespace quadrille::traces
