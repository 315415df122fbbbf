/// Compressed textures: the bytes and cycles that they save, beside what a texel must take, and what they
/// cost in the picture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "models/texture/block/block_format.h"
#include "pipeline/render.h"
#include "scenes/image/compress.h"
#include "studies/experiments/experiment.h"
#include "studies/experiments/triangle_mesh.h"
#include "studies/experiments/unit_streams.h"

namespace quadrille::studies::experiments {
namespace {

using scenes::TextureCompression;
using traces::Format;

const char* const kDecoded = "texture.blocks_held=decoded";
/// Lines of the texture cache: nothing is fetched twice.
const char* const kRoomForAll = "texture.cache_lines=4096";

/// A texel a pixel.
struct Case {
  Format format;
  bool decoded;
};
constexpr Case kCases[] = {
    {Format::kR8G8B8A8Unorm, false},  {Format::kBc1RgbaUnorm, false}, {Format::kBc3Unorm, false},
    {Format::kEtc2Rgb8Unorm, false},  {Format::kEacR11Unorm, false},  {Format::kAstc4x4Unorm, false},
    {Format::kAstc5x5Unorm, false},   {Format::kAstc6x6Unorm, false}, {Format::kAstc8x8Unorm, false},
    {Format::kAstc12x12Unorm, false}, {Format::kBc1RgbaUnorm, true},  {Format::kBc7Unorm, true},
    {Format::kAstc4x4Unorm, true},    {Format::kAstc8x8Unorm, true},
};

/// Of a cache of decoded lines, a line fetches whole sectors of the blocks that it holds.
double bytes_a_texel(const Case& c) {
  constexpr double kLine = 128, kSector = 32;
  const models::FormatInfo& info = models::format_info(c.format);
  const double texels = info.block_width * info.block_height;
  if (!c.decoded) return info.bytes / texels;
  const double line_texels = kLine / models::format_bytes(models::decoded_format(c.format));
  return std::max(kSector, info.bytes * line_texels / texels) / line_texels;
}

/// Sides that all sizes of blocks divide into even numbers.
constexpr std::uint32_t kWidth = 240, kHeight = 120;

void judge_texels(const Setting& setting, Result& result) {
  std::vector<traces::CommandStream> streams;
  std::vector<Frame> frames;
  streams.reserve(std::size(kCases));
  for (const Case& c : kCases) {
    const DrawTexture texture{kWidth, kHeight, 1, traces::Filter::kNearest, c.format};
    streams.push_back(stream_of(tiled_frame(kWidth, kHeight, kWidth, kHeight),
                                {.fragment_shader = sampling_shader(texture, {}), .texture = texture}));
    frames.push_back({&streams.back(), {"gpu.cores=1", kRoomForAll}});
    if (c.decoded) frames.back().settings.emplace_back(kDecoded);
  }
  const std::vector<Readings> read = draw(frames, setting);
  constexpr double kTexels = double{kWidth} * kHeight;
  result.table.head = {"format",   "the cache holds", "bytes a texel",
                       "expected", "of RGBA8",        "blocks decoded a block"};
  for (std::size_t i = 0; i < std::size(kCases); ++i) {
    const Case& c = kCases[i];
    const models::FormatInfo& info = models::format_info(c.format);
    const double bytes = read[i]["texture.read_bytes"] / kTexels, expected = bytes_a_texel(c),
                 blocks = kTexels / (info.block_width * info.block_height);
    const bool compressed = models::is_block_format(c.format);
    result.table.rows.push_back(
        {std::string(info.name), compressed && !c.decoded ? "blocks" : "texels", fmt::format("{:.3f}", bytes),
         fmt::format("{:.3f}", expected),
         fmt::format("{:.3f}", bytes * kTexels / read[0]["texture.read_bytes"]),
         compressed ? fmt::format("{:.2f}", read[i]["texture.blocks_decoded"] / blocks) : ""});
    result.verdicts.push_back(
        {fmt::format("{}{}: bytes over the form", info.name, c.decoded ? ", decoded" : ""), bytes / expected,
         1, 1});
  }
}

/// How far codes of eight bits are apart.
struct Apart {
  double squares = 0, count = 0;
  void add(int a, int b) {
    squares += (a - b) * (a - b);
    ++count;
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / count); }
  [[nodiscard]] double decibels() const { return 20 * std::log10(255 / rms()); }
};

/// Of the textures' finest levels: colours of the texels that are not mostly transparent.
Apart textures_apart(const traces::CommandStream& plain, const traces::CommandStream& compressed) {
  Apart apart;
  for (std::size_t i = 0; i < plain.images.size(); ++i) {
    if (!models::is_block_format(compressed.images[i].format)) continue;
    const traces::Image decoded = traces::decompressed(compressed.images[i]);
    for (std::size_t texel = 0; texel < traces::level_bytes(plain.images[i], 0); texel += 4) {
      constexpr auto kHalf = std::byte{128};
      if (plain.images[i].texels[texel + 3] < kHalf) continue;
      for (std::size_t b = texel; b < texel + 3; ++b)
        apart.add(static_cast<int>(plain.images[i].texels[b]), static_cast<int>(decoded.texels[b]));
    }
  }
  return apart;
}

/// Of two pictures, without alpha.
Apart pictures_apart(const pipeline::FrameImage& a, const pipeline::FrameImage& b) {
  Apart apart;
  for (std::size_t i = 0; i < a.color.size(); ++i)
    for (const int shift : {0, 8, 16})
      apart.add(static_cast<int>(a.color[i] >> shift & 255), static_cast<int>(b.color[i] >> shift & 255));
  return apart;
}

double texture_bytes(const traces::CommandStream& stream) {
  double bytes = 0;
  for (const traces::Image& image : stream.images)
    if (!image.is_attachment()) bytes += static_cast<double>(traces::texel_bytes(image));
  return bytes;
}

struct Way {
  const char* name;
  std::optional<TextureCompression> how;
  double bits;  ///< a texel
};
constexpr Way kWays[] = {{"RGBA8", std::nullopt, 32},
                         {"BC3", TextureCompression::kBc3, 8},
                         {"ASTC 4x4", TextureCompression::kAstc4x4, 8},
                         {"ASTC 5x5", TextureCompression::kAstc5x5, 128.0 / 25},
                         {"BC1", TextureCompression::kBc1, 4},
                         {"ASTC 6x6", TextureCompression::kAstc6x6, 128.0 / 36},
                         {"ASTC 8x8", TextureCompression::kAstc8x8, 2},
                         {"ASTC 12x12", TextureCompression::kAstc12x12, 128.0 / 144}};

/// A scene drawn in every way.
struct Drawn {
  std::vector<Readings> read;
  std::vector<double> megabytes;
  std::vector<Apart> textures, pictures;
};

Drawn draw_all_ways(const traces::CommandStream& plain, const Setting& setting) {
  std::vector<traces::CommandStream> streams;
  std::vector<Frame> frames;
  Drawn drawn;
  streams.reserve(std::size(kWays));
  for (const Way& way : kWays) {
    setting.progress(way.name);
    streams.push_back(plain);
    if (way.how) scenes::compress_textures(streams.back(), *way.how);
    frames.push_back({&streams.back(), {}});
    drawn.megabytes.push_back(texture_bytes(streams.back()) / 1e6);
  }
  drawn.read = draw(frames, setting);
  const pipeline::FrameImage wanted = pipeline::render_functional_frame(plain, {}).image;
  for (const traces::CommandStream& stream : streams) {
    drawn.textures.push_back(textures_apart(plain, stream));
    drawn.pictures.push_back(pictures_apart(wanted, pipeline::render_functional_frame(stream, {}).image));
  }
  return drawn;
}

void add_rows(const std::string& scene, const Drawn& drawn, Table& table) {
  for (std::size_t i = 0; i < std::size(kWays); ++i) {
    const Readings& r = drawn.read[i];
    const bool lossy = kWays[i].how.has_value();
    const auto error = [lossy](double value) { return lossy ? fmt::format("{:.2f}", value) : std::string(); };
    table.rows.push_back({scene, kWays[i].name, fmt::format("{:.2f}", kWays[i].bits),
                          fmt::format("{:.2f}", drawn.megabytes[i]),
                          fmt::format("{:.3f}", r["texture.read_bytes"] / 1e6),
                          fmt::format("{:.3f}", (r["memory.read_bytes"] + r["memory.write_bytes"]) / 1e6),
                          fmt::format("{:.3f}", r["frame.cycles"] / drawn.read[0]["frame.cycles"]),
                          error(drawn.textures[i].rms()), error(drawn.textures[i].decibels()),
                          error(drawn.pictures[i].rms()), error(drawn.pictures[i].decibels())});
  }
}

void judge(const std::string& scene, const Drawn& drawn, Result& result) {
  const auto decibels = [&drawn](const char* name) {
    std::size_t i = 0;
    while (kWays[i].name != std::string_view(name)) ++i;
    return drawn.textures[i].decibels();
  };
  for (std::size_t i = 1; i < std::size(kWays); ++i)
    result.verdicts.push_back(
        {fmt::format("{}, {}: bytes of the texture units over RGBA8's", scene, kWays[i].name),
         drawn.read[i]["texture.read_bytes"] / drawn.read[0]["texture.read_bytes"], 0, 1});
  constexpr double kMost = 60;
  result.verdicts.push_back({fmt::format("{}: textures, ASTC of 3.56 bits over BC1 of 4, dB", scene),
                             decibels("ASTC 6x6") - decibels("BC1"), 0, kMost});
  result.verdicts.push_back({fmt::format("{}: textures, ASTC of 8 bits over BC3, dB", scene),
                             decibels("ASTC 4x4") - decibels("BC3"), 0, kMost});
}

std::string plot_of(const Table& scenes) {
  std::string data;
  for (const auto& row : scenes.rows)
    if (!row[10].empty()) data += fmt::format("{} {} \"{}\" \"{}\"\n", row[2], row[10], row[1], row[0]);
  return "set xlabel 'bits a texel'\nset ylabel 'picture, dB'\nset logscale x 2\nset grid\nset key top left\n"
         "set xrange [0.7:12]\n$d << EOD\n" +
         data +
         "EOD\nplot $d using 1:2:3 with labels point pt 7 offset char 0,0.9 title 'BC and ASTC, by scene'";
}

}  // namespace

Result compressed_textures(const Setting& setting) {
  Result result;
  judge_texels(setting, result);
  Table table;
  table.head = {"scene",     "textures",         "bits a texel", "size MB",     "texture units MB",
                "memory MB", "cycles, of RGBA8", "textures rms", "textures dB", "picture rms",
                "picture dB"};
  for (const auto& [name, load] : setting.scenes) {
    traces::CommandStream plain = load();
    for (traces::Image& image : plain.images) traces::unpack(image);
    const Drawn drawn = draw_all_ways(plain, setting);
    add_rows(name, drawn, table);
    judge(name, drawn, result);
  }
  result.plot = plot_of(table);
  result.further_tables.push_back(std::move(table));
  result.remarks = {
      "Bytes of the texture units are those that they ask of the L2 cache, in sectors of 32; those of memory "
      "are all that the channels move, attachments among them.",
      "A cache of decoded lines fetches the sectors of the blocks that a line is made of: a sector of BC1 "
      "holds four blocks, a line of decoded texels two, so neighbouring lines fetch the same sector twice. A "
      "block of ASTC of 8x8 texels fills two lines.",
      "Root mean squares (rms, of 255) and decibels of peak signal over noise are of eight-bit codes: of the "
      "colours of the textures' finest levels, but for texels whose alpha is below a half, and of the "
      "picture "
      "without alpha, beside that of RGBA8. Normal maps are compressed like all else. BC1 has one bit of "
      "alpha "
      "and BC3 eight: where alpha is graded, a picture with BC1 is farther off than its colours are.",
      "Cycles hardly move: these scenes are limited by their cores, and a texture cache of 32 KiB holds most "
      "of "
      "what a frame reads again. What is saved is traffic to the L2 cache."};
  return result;
}

}  // namespace quadrille::studies::experiments
