#include "tests/fuzz/trace_chunks.h"

#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>

namespace quadrille::fuzz {
namespace {

constexpr std::size_t kFileHeader = 16, kChunkHeader = 32, kMaxPayload = 1 << 22;
constexpr std::array<char, 4> kTargets{'T', 'A', 'R', 'G'};  ///< in files of version 1 alone
constexpr std::array<unsigned char, 8> kMagic{0x89, 'Q', 'T', 'R', 'A', 'C', 'E', '\n'};

template <class T>
T number_at(Bytes bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

template <class T>
void append(Buffer& out, const T& value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void append_chunk(Buffer& out, const TraceChunk& chunk) {
  Buffer packed(ZSTD_compressBound(chunk.payload.size()));
  packed.resize(ZSTD_compress(packed.data(), packed.size(), chunk.payload.data(), chunk.payload.size(), 1));
  const std::size_t header = out.size();
  append(out, chunk.tag);
  append(out, chunk.version);
  append(out, std::uint64_t{packed.size()});
  append(out, std::uint64_t{chunk.payload.size()});
  append(out, std::uint64_t{
                  XXH3_64bits_withSeed(packed.data(), packed.size(), XXH3_64bits(out.data() + header, 24))});
  out.insert(out.end(), packed.begin(), packed.end());
}

}  // namespace

std::optional<std::vector<TraceChunk>> take_trace_apart(Bytes file) {
  std::vector<TraceChunk> chunks;
  for (std::size_t at = kFileHeader; at < file.size();) {
    if (file.size() - at < kChunkHeader) return std::nullopt;
    TraceChunk chunk{number_at<std::array<char, 4>>(file, at), number_at<std::uint32_t>(file, at + 4), {}};
    const auto stored = number_at<std::uint64_t>(file, at + 8),
               decoded = number_at<std::uint64_t>(file, at + 16);
    at += kChunkHeader;
    if (stored > file.size() - at || decoded > kMaxPayload) return std::nullopt;
    chunk.payload.resize(decoded);
    if (ZSTD_decompress(chunk.payload.data(), decoded, file.data() + at, stored) != decoded)
      return std::nullopt;
    at += stored;
    chunks.push_back(std::move(chunk));
  }
  return chunks;
}

Buffer put_trace_together(const std::vector<TraceChunk>& chunks) {
  Buffer out;
  append(out, kMagic);
  const bool old = std::ranges::any_of(chunks, [](const TraceChunk& c) { return c.tag == kTargets; });
  append(out, std::uint32_t{old ? 1u : 2u});
  append(out, static_cast<std::uint32_t>(chunks.size()));
  for (const TraceChunk& chunk : chunks) append_chunk(out, chunk);
  return out;
}

}  // namespace quadrille::fuzz
