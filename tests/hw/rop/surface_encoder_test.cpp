/// Lines of surfaces that are stored encoded: what leaves the cache, what is fetched again, and what happens
/// to lines of samples that are copies. The surface is a column of tiles of 4-byte pixels.
#include "hw/rop/surface_cache.h"
#include "tests/hw/cache_user.h"

#include <catch2/catch.hpp>

#include <cstring>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

constexpr int kLatency = 20;  ///< of the memory behind the cache, cycles
constexpr std::uint64_t kAll = ~std::uint64_t{0};
constexpr std::uint8_t kLine = 0xf, kTile = 0xff;  ///< sectors of a tile's first line, and of both

using User = CacheUser<SurfaceCache>;
using Use = User::Use;
using Script = std::vector<Timed<Use>>;
/// Code of a pixel of a line.
using Content = std::uint32_t (*)(std::uint32_t line, std::uint32_t pixel);

constexpr Content kOneColor = [](std::uint32_t, std::uint32_t) { return 0x11223344u; };
constexpr Content kNoise = [](std::uint32_t line, std::uint32_t pixel) {
  return (line * 64 + pixel + 1) * 0x9e3779b9u;
};
/// The first line of each tile is of one colour, the other is noise.
constexpr Content kHalfNoise = [](std::uint32_t line, std::uint32_t pixel) {
  return line % 2 == 0 ? 0x11223344u : kNoise(line, pixel);
};

/// Depths of D24 that lie on a plane: 64 codes a pixel to the right, 32 downwards.
constexpr Content kPlane = [](std::uint32_t, std::uint32_t pixel) {
  const auto entry = static_cast<int>(pixel);
  return static_cast<std::uint32_t>(100000 + 64 * models::entry_x(entry) + 32 * models::entry_y(entry));
};

struct EncoderBench final : Bench {
  struct Setup {
    Script script;
    Content content = kOneColor;
    std::uint32_t samples = 1;
    int lines = 16;
    models::LoadOp load = models::LoadOp::kLoad;
    models::Format format = models::Format::kR8G8B8A8Unorm;
    SurfaceCompression compression = SurfaceCompression::of(ColorCompression::kSamplesOffset);
  };
  EncoderBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    surface = models::allocate_surface(device, 8, 32, s.samples);
    attachment = {surface, s.format, s.load, models::StoreOp::kStore, {{7}}, true};
    unit = std::make_unique<User>("unit", clock, s.script, s.lines, s.lines, 4, device,
                                  surface_writer(SurfaceKind::kColor, PartitionId(0)), s.compression);
    for (std::uint32_t i = 0; s.load == models::LoadOp::kLoad && i < surface.bytes() / 4; ++i)
      device.store(surface.base + 4 * i, s.content(i / 32, i % 32));
    unit->cache.begin_pass({&attachment, 1}, PartitionId(0), 1);
    add(*unit);
    memory = &serve(unit->port, kLatency);
  }
  models::SurfaceLayout surface;
  AttachmentState attachment;
  std::unique_ptr<User> unit;
  StubMemory* memory = nullptr;
};

/// Sectors of the first tile, of one sample.
Use acquire(const SectorWishes& wishes, std::uint32_t sample = 0) {
  return [=](User& u) {
    int missing = 0;
    AcquiredLines done;
    const bool placed = u.cache.acquire({0, 0, 0, sample}, wishes, 1, missing, done, u.port);
    u.log += placed ? fmt::format("missing {}; ", missing) : "no place; ";
  };
}
Use write(std::uint64_t pixels, std::uint32_t sample = 0) {
  return [=](User& u) {
    u.log += u.cache.write({0, 0, 0, sample}, pixels, u.port) ? "" : "not written; ";
    u.cache.pixels_written();
  };
}
const Use kFlush = [](User& u) { u.cache.flush(u.port); };
/// Writes all of the tile in every sample, and flushes.
Script drawn(std::uint32_t samples = 1) {
  Script script;
  for (std::uint32_t s = 0; s < samples; ++s) {
    script.push_back({1, acquire({.write = kTile}, s)});
    script.push_back({2, write(kAll, s)});
  }
  script.push_back({3, kFlush});
  return script;
}
Script with(Script script, const Script& more) {
  script.insert(script.end(), more.begin(), more.end());
  return script;
}

/// What the user was told, and what reached memory as "kind line/sectors".
std::string seen(const EncoderBench::Setup& setup) {
  return run<EncoderBench>(setup, [](const EncoderBench& b) {
    const auto first = static_cast<std::uint32_t>(b.surface.base / models::kLineBytes);
    return fmt::format("{}|{} | dirty {}", b.unit->log, requests_seen(*b.memory, first),
                       b.device.dirty_lines());
  });
}
std::string counted(const EncoderBench::Setup& setup) {
  return run<EncoderBench>(setup, [](const EncoderBench& b) {
    const auto count = [&](const char* name) { return counter(*b.unit, name); };
    return fmt::format("plain {} offset {} plane {} copied {} bytes {} of {}, read {} lines in {} bytes",
                       count("plain_lines"), count("offset_lines"), count("plane_lines"),
                       count("copied_lines"), count("encoded_write_bytes"), count("unencoded_write_bytes"),
                       count("encoded_reads"), count("encoded_read_bytes"));
  });
}

}  // namespace

TEST_CASE("surface_encoder: a line leaves in the sectors of its encoding, and a line of noise as it is") {
  CHECK(seen({.script = drawn(), .content = kHalfNoise}) == "missing 0; | w0/1 w1/f | dirty 0");
  CHECK(counted({.script = drawn(), .content = kHalfNoise}) ==
        "plain 1 offset 1 plane 0 copied 0 bytes 160 of 256, read 0 lines in 0 bytes");
}

TEST_CASE("surface_encoder: depths of a plane leave in a sector a line, and in two without planes") {
  const auto stored = [](DepthCompression compression) {
    return counted({.script = drawn(),
                    .content = kPlane,
                    .format = models::Format::kD24UnormS8Uint,
                    .compression = SurfaceCompression::of(compression)});
  };
  CHECK(stored(DepthCompression::kPlaneOffset) ==
        "plain 0 offset 0 plane 2 copied 0 bytes 64 of 256, read 0 lines in 0 bytes");
  // 7 * 64 + 3 * 32 = 544 codes apart: 10 bits a pixel beside the header.
  CHECK(stored(DepthCompression::kOffset) ==
        "plain 0 offset 2 plane 0 copied 0 bytes 128 of 256, read 0 lines in 0 bytes");
}

TEST_CASE("surface_encoder: without compression nothing is encoded or counted") {
  CHECK(seen({.script = drawn(), .compression = {}}) == "missing 0; | w0/f w1/f | dirty 0");
  CHECK(counted({.script = drawn(), .compression = {}}) ==
        "plain 0 offset 0 plane 0 copied 0 bytes 0 of 0, read 0 lines in 0 bytes");
}

TEST_CASE("surface_encoder: an encoded line is fetched by its encoding, and all of it is there then") {
  const Script again =
      with(drawn(), {{10, acquire({.read = 0x02})}, {60, acquire({.read = 0x0d})}, {61, kFlush}});
  CHECK(seen({.script = again}) == "missing 0; missing 1; ready 1; missing 0; | w0/1 w1/1 r0/1 | dirty 0");
  CHECK(counted({.script = again}) ==
        "plain 0 offset 2 plane 0 copied 0 bytes 64 of 256, read 1 lines in 32 bytes");
}

TEST_CASE(
    "surface_encoder: a write to a part of an encoded line asks for it first, one to all of it does not") {
  CHECK(seen({.script = with(drawn(), {{10, acquire({.part = 0x01})}, {60, write(0xf)}, {61, kFlush}})}) ==
        "missing 0; missing 1; ready 1; | w0/1 w1/1 r0/1 w0/1 | dirty 0");
  CHECK(seen({.script = with(drawn(), {{10, acquire({.write = 0x01})}, {60, write(0xff)}, {61, kFlush}})}) ==
        "missing 0; missing 1; ready 1; | w0/1 w1/1 r0/1 w0/1 | dirty 0");
  CHECK(seen({.script =
                  with(drawn(), {{10, acquire({.write = kLine})}, {11, write(0xffffffff)}, {12, kFlush}})}) ==
        "missing 0; missing 0; | w0/1 w1/1 w0/1 | dirty 0");
}

TEST_CASE("surface_encoder: a plain line of which little was written stays plain, in part or as it is") {
  // One sector was written: no encoding is shorter, but one is as short once all of the line is there.
  CHECK(seen({.script = {{1, acquire({.write = 0x01})}, {2, write(0xff)}, {3, kFlush}}}) ==
        "missing 0; | w0/1 | dirty 0");
  CHECK(seen({.script = {{1, acquire({.part = 0x01})}, {2, write(0xf)}, {3, kFlush}}}) ==
        "missing 0; | p0/1 | dirty 0");
  CHECK(counted({.script = {{1, acquire({.write = 0x01})}, {2, write(0xff)}, {3, kFlush}}}) ==
        "plain 1 offset 0 plane 0 copied 0 bytes 32 of 32, read 0 lines in 0 bytes");
}

TEST_CASE("surface_encoder: an encoded line that left before it is written is fetched again, for nobody") {
  CHECK(seen({.script = with(drawn(), {{10, write(0xf)}, {60, kFlush}})}) ==
        "missing 0; | w0/1 w1/1 r0/1 w0/1 | dirty 0");
}

TEST_CASE("surface_encoder: tiles that are still marked as cleared are written encoded") {
  CHECK(seen({.script = {{1, kFlush}}, .load = models::LoadOp::kClear}) ==
        "| w0/1 w1/1 w2/1 w3/1 w4/1 w5/1 w6/1 w7/1 | dirty 0");
  CHECK(seen({.script = {{1, kFlush}}, .samples = 2, .load = models::LoadOp::kClear}) ==
        "| w0/1 w1/1 w4/1 w5/1 w8/1 w9/1 w12/1 w13/1 | dirty 0");
}

TEST_CASE("surface_encoder: lines of samples that equal those of the first move nothing") {
  CHECK(seen({.script = drawn(4), .samples = 4}) ==
        "missing 0; missing 0; missing 0; missing 0; | w0/1 w1/1 | dirty 0");
  CHECK(counted({.script = drawn(4), .samples = 4}) ==
        "plain 0 offset 2 plane 0 copied 6 bytes 64 of 1024, read 0 lines in 0 bytes");
  // Noise of each line for itself.
  CHECK(counted({.script = drawn(2), .content = kNoise, .samples = 2}) ==
        "plain 4 offset 0 plane 0 copied 0 bytes 512 of 512, read 0 lines in 0 bytes");
}

TEST_CASE("surface_encoder: samples are compared only where lines of samples may be copies") {
  CHECK(counted({.script = drawn(2),
                 .samples = 2,
                 .compression = SurfaceCompression::of(ColorCompression::kOffset)}) ==
        "plain 0 offset 4 plane 0 copied 0 bytes 128 of 512, read 0 lines in 0 bytes");
}

TEST_CASE("surface_encoder: who reads a copy reads its original, once for all that ask") {
  CHECK(
      seen({.script = with(drawn(2), {{10, acquire({.read = kLine}, 0)}, {11, acquire({.read = kLine}, 1)}}),
            .samples = 2}) ==
      "missing 0; missing 0; missing 1; missing 1; ready 1; ready 1; | w0/1 w1/1 r0/1 | dirty 0");
}

TEST_CASE("surface_encoder: before an original is written its copy becomes a line of its own") {
  // The original is in the cache: the copy is made there.
  CHECK(
      seen({.script = with(drawn(2), {{10, acquire({.read = kLine}, 0)}, {60, write(0xf, 0)}, {61, kFlush}}),
            .samples = 2}) == "missing 0; missing 0; missing 1; ready 1; | w0/1 w1/1 r0/1 w0/1 | dirty 0");
  // It is not: the copy is fetched from where the original lies, before that is written.
  CHECK(seen({.script = with(drawn(2), {{10, write(0xffffffff, 0)}, {60, kFlush}}), .samples = 2}) ==
        "missing 0; missing 0; | w0/1 w1/1 r0/1 w0/1 | dirty 0");
}

TEST_CASE(
    "surface_encoder: a copy that is written becomes a line of its own, and is not read if all of it is") {
  CHECK(seen({.script = with(drawn(2),
                             {{10, acquire({.write = kLine}, 1)}, {11, write(0xffffffff, 1)}, {12, kFlush}}),
              .samples = 2}) == "missing 0; missing 0; missing 0; | w0/1 w1/1 w2/1 | dirty 0");
  CHECK(seen({.script = with(drawn(2), {{10, acquire({.part = 0x01}, 1)}, {60, write(0xf, 1)}, {61, kFlush}}),
              .samples = 2}) == "missing 0; missing 0; missing 1; ready 1; | w0/1 w1/1 r0/1 | dirty 0");
}

TEST_CASE("surface_encoder: in a cache of one line, lines leave before their pixels are there, and plain") {
  CHECK(seen({.script = {{1, acquire({.write = kTile})}, {2, write(kAll)}, {3, kFlush}}, .lines = 1}) ==
        "missing 0; | w0/f w1/1 | dirty 0");
}
