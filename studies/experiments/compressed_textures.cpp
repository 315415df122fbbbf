/// Compressed textures: the bytes that they save, beside what a texel must take, and what they cost in the
/// picture.
#include <fmt/format.h>

#include <cmath>

#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "scenes/image/compress.h"
#include "studies/experiments/experiment.h"
#include "studies/experiments/triangle_mesh.h"
#include "studies/experiments/unit_streams.h"

namespace quadrille::studies::experiments {
namespace {

using traces::Format;

const char* const kDecoded = "texture.blocks_held=decoded";

/// A texel a pixel. Of a cache of decoded lines: bytes of the sectors that hold a line's blocks, which come
/// for each line.
struct Case {
  Format format;
  bool decoded;
  double bytes_a_texel;
};
const Case kCases[] = {
    {Format::kR8G8B8A8Unorm, false, 4}, {Format::kBc1RgbaUnorm, false, 0.5}, {Format::kBc3Unorm, false, 1},
    {Format::kBc4Unorm, false, 0.5},    {Format::kBc6hUfloat, false, 1},     {Format::kBc7Unorm, false, 1},
    {Format::kBc1RgbaUnorm, true, 1},   {Format::kBc7Unorm, true, 1},        {Format::kBc6hUfloat, true, 2},
};

void judge_texels(const Setting& setting, Result& result) {
  std::vector<traces::CommandStream> streams;
  std::vector<Frame> frames;
  streams.reserve(std::size(kCases));
  for (const Case& c : kCases) {
    const DrawTexture texture{setting.width, setting.height, 1, traces::Filter::kNearest, c.format};
    streams.push_back(stream_of(tiled_frame(setting.width, setting.height, setting.width, setting.height),
                                {.fragment_shader = sampling_shader(texture, {}), .texture = texture}));
    frames.push_back({&streams.back(), {"gpu.cores=1"}});
    if (c.decoded) frames.back().settings.emplace_back(kDecoded);
  }
  const std::vector<Readings> read = draw(frames, setting);
  const double texels = double{1} * setting.width * setting.height;
  result.table.head = {"format",   "the cache holds", "bytes a texel",
                       "expected", "of RGBA8",        "blocks decoded a block"};
  for (std::size_t i = 0; i < std::size(kCases); ++i) {
    const Case& c = kCases[i];
    const std::string name(models::format_info(c.format).name);
    const double bytes = read[i]["texture.read_bytes"] / texels;
    result.table.rows.push_back({name,
                                 c.decoded ? "texels"
                                 : i == 0  ? "texels"
                                           : "blocks",
                                 fmt::format("{:.3f}", bytes), fmt::format("{:.3f}", c.bytes_a_texel),
                                 fmt::format("{:.3f}", bytes * texels / read[0]["texture.read_bytes"]),
                                 fmt::format("{:.2f}", read[i]["texture.blocks_decoded"] * 16 / texels)});
    result.verdicts.push_back({fmt::format("{}{}: bytes over the form", name, c.decoded ? ", decoded" : ""),
                               bytes / c.bytes_a_texel, 1, 1});
  }
}

/// Peak signal over noise of what the textures' finest levels hold, all texels together, by code.
double texture_psnr(const traces::CommandStream& plain, const traces::CommandStream& compressed) {
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < plain.images.size(); ++i) {
    if (!models::is_block_format(compressed.images[i].format)) continue;
    const traces::Image decoded = traces::decompressed(compressed.images[i]);
    const std::uint64_t bytes = traces::level_bytes(plain.images[i], 0);
    for (std::size_t b = 0; b < bytes; ++b) {
      const double apart =
          static_cast<double>(plain.images[i].texels[b]) - static_cast<double>(decoded.texels[b]);
      squares += apart * apart;
    }
    count += static_cast<double>(bytes);
  }
  return 10 * std::log10(255.0 * 255.0 * count / squares);
}

double picture_psnr(const traces::CommandStream& plain, const traces::CommandStream& compressed) {
  const pipeline::FrameImage a = pipeline::render_functional_frame(plain, {}).image,
                             b = pipeline::render_functional_frame(compressed, {}).image;
  return models::reference::compare_images({a.width, a.height, a.color}, {b.width, b.height, b.color})
      .psnr_db;
}

double texture_bytes(const traces::CommandStream& stream) {
  double bytes = 0;
  for (const traces::Image& image : stream.images)
    if (!image.is_attachment()) bytes += static_cast<double>(traces::texel_bytes(image));
  return bytes;
}

struct Way {
  const char* name;
  bool compressed, decoded;
  scenes::TextureCompression how;
};
constexpr Way kWays[] = {{"RGBA8", false, false, {}},
                         {"BC1", true, false, scenes::TextureCompression::kBc1},
                         {"BC1, decoded lines", true, true, scenes::TextureCompression::kBc1},
                         {"BC3", true, false, scenes::TextureCompression::kBc3},
                         {"BC3, decoded lines", true, true, scenes::TextureCompression::kBc3}};

void measure_scenes(const Setting& setting, Result& result) {
  Table table;
  table.head = {"scene",       "textures",  "size MB",   "read by the texture units MB",
                "of RGBA8",    "hit %",     "memory MB", "cycles, of RGBA8",
                "textures dB", "picture dB"};
  for (const auto& [name, load] : setting.scenes) {
    setting.progress(name);
    std::vector<traces::CommandStream> streams;
    std::vector<Frame> frames;
    streams.reserve(std::size(kWays));
    for (const Way& way : kWays) {
      streams.push_back(load());
      for (traces::Image& image : streams.back().images) traces::unpack(image);
      if (way.compressed) scenes::compress_textures(streams.back(), way.how);
      frames.push_back({&streams.back(), {}});
      if (way.decoded) frames.back().settings.emplace_back(kDecoded);
    }
    const std::vector<Readings> read = draw(frames, setting);
    for (std::size_t i = 0; i < std::size(kWays); ++i) {
      const Readings& r = read[i];
      const bool shows_error = kWays[i].compressed && !kWays[i].decoded;
      const double bytes = r["texture.read_bytes"], plain = read[0]["texture.read_bytes"];
      table.rows.push_back(
          {name, kWays[i].name, fmt::format("{:.2f}", texture_bytes(streams[i]) / 1e6),
           fmt::format("{:.3f}", bytes / 1e6), fmt::format("{:.3f}", bytes / plain),
           fmt::format("{:.1f}", 100 * r["texture.cache_hits"] / r["texture.cache_requests"]),
           fmt::format("{:.2f}", (r["memory.read_bytes"] + r["memory.write_bytes"]) / 1e6),
           fmt::format("{:.3f}", r["frame.cycles"] / read[0]["frame.cycles"]),
           shows_error ? fmt::format("{:.1f}", texture_psnr(streams[0], streams[i])) : "",
           shows_error ? fmt::format("{:.1f}", picture_psnr(streams[0], streams[i])) : ""});
      if (i > 0)
        result.verdicts.push_back(
            {fmt::format("{}, {}: bytes over RGBA8's", name, kWays[i].name), bytes / plain, 0, 1});
    }
  }
  result.further_tables.push_back(std::move(table));
}

std::string plot_of(const Table& scenes) {
  std::string data;
  for (const auto& row : scenes.rows)
    data += fmt::format("\"{}, {}\" {} {}\n", row[0], row[1], row[4], row[7]);
  return "set style data histogram\nset style fill solid 0.7\nset ylabel 'over RGBA8'\nset yrange "
         "[0:*]\nset xtics rotate by -30\nset grid y\n$d << EOD\n" +
         data + "EOD\nplot $d using 2:xtic(1) title 'bytes of texture units', '' using 3 title 'cycles'";
}

}  // namespace

Result compressed_textures(const Setting& setting) {
  Result result;
  judge_texels({{}, 256, 128, setting.jobs, setting.progress}, result);
  measure_scenes(setting, result);
  result.remarks = {
      "Bytes are those that the texture units ask of the L2 cache, in sectors of 32. A cache of blocks holds "
      "eight times the texels of BC1 that it holds of RGBA8, so it misses less often too.",
      "A cache of decoded lines fetches the sectors of the blocks that a line is made of: a sector of BC1 "
      "holds four blocks, a line of decoded texels two, so neighbouring lines fetch the same sector twice.",
      "Decibels are peak signal over noise of eight-bit codes: of the textures' finest levels, all channels, "
      "and of the picture. Normal maps are compressed like all else, which BC1 and BC3 were not made for."};
  result.plot = plot_of(result.further_tables.front());
  return result;
}

}  // namespace quadrille::studies::experiments
