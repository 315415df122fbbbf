/// Filtering: bilinear quads that a sample takes, by filter and by the texel's bytes.
#include <fmt/format.h>

#include <array>

#include "studies/experiments/experiment.h"
#include "studies/experiments/unit_streams.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

constexpr std::uint32_t kLayers = 8;
constexpr int kCores = 2;
/// The filters limit: one quad a cycle each. Caches hold the texture.
const std::vector<std::string> kSlowFilters{"texture.filter_quads_per_clk=1",
                                            "texture.address_quads_per_clk=8",
                                            "texture.tags_per_clk=16",
                                            "texture.cache_lines=4096",
                                            fmt::format("gpu.cores={}", kCores),
                                            "core.simd_lanes=32",
                                            "core.warp_slots=64",
                                            "core.register_rows=4096"};

struct Sample {
  const char* name;
  DrawTexture texture;  ///< the format is left open
  double level = 0;
  int quads = 1;  ///< bilinear, of texels of 4 bytes
};
const std::array kSamples{Sample{"nearest", {64, 64, 1, traces::Filter::kNearest}, 0, 1},
                          Sample{"bilinear", {64, 64, 1, traces::Filter::kLinear}, 0, 1},
                          Sample{"trilinear", {64, 64, 2, traces::Filter::kLinear}, 0.5, 2}};
constexpr std::array kFormats{traces::Format::kR8G8B8A8Unorm, traces::Format::kR16G16B16A16Float,
                              traces::Format::kR32G32B32A32Float};

traces::CommandStream stream_with(const Sample& sample, traces::Format format, std::uint32_t layers,
                                  const Setting& setting) {
  DrawTexture texture = sample.texture;
  texture.format = format;
  return stream_of(
      covered_frame(setting.width, setting.height, layers),
      {.fragment_shader = sampling_shader(texture, {.level = sample.level}), .texture = texture});
}

}  // namespace

// The time of a layer is the difference of frames with many and with one.
Result texture_filters(const Setting& setting) {
  std::vector<traces::CommandStream> streams;
  for (const Sample& sample : kSamples)
    for (const traces::Format format : kFormats)
      for (const std::uint32_t layers : {1U, kLayers + 1})
        streams.push_back(stream_with(sample, format, layers, setting));
  std::vector<Frame> frames;
  frames.reserve(streams.size());
  for (const traces::CommandStream& stream : streams) frames.push_back({&stream, kSlowFilters});
  const std::vector<Readings> read = draw(frames, setting);

  Result result;
  result.table.head = {"filter", "format", "bytes", "quads/clk", "cycles a quad", "closed form", "over it"};
  const double quads = 0.25 * setting.width * setting.height;
  std::string data;
  auto next = read.begin();
  for (const Sample& sample : kSamples) {
    data += quoted(sample.name);
    for (const traces::Format format : kFormats) {
      const double one = (*next++)["frame.cycles"], many = (*next++)["frame.cycles"];
      const double cycles = (many - one) / kLayers * kCores / quads;  // of a core's filter
      const models::FormatInfo& info = models::format_info(format);
      const double expected = sample.quads * info.bytes / 4.0;
      const std::string name(info.name);
      result.table.rows.push_back({sample.name, name, fmt::format("{}", info.bytes),
                                   fmt::format("{:.3f}", 1 / cycles), fmt::format("{:.3f}", cycles),
                                   fmt::format("{:g}", expected), fmt::format("{:.4f}", cycles / expected)});
      result.verdicts.push_back(
          {fmt::format("{}, {}: cycles over closed form", sample.name, name), cycles / expected, 0.98, 1.02});
      data += fmt::format(" {}", 1 / cycles);
    }
    data += "\n";
  }
  result.remarks = {
      "A filter reads the four texels of 4 bytes of a quad's pixels at once. Of 8 bytes it takes two turns, "
      "of "
      "16 four; a second mip level is a second bilinear sample. Nearest filtering is as fast as bilinear: "
      "the "
      "pipe is the same."};
  result.plot =
      "set style data histogram\nset style fill solid 0.7\nset ylabel 'quads a cycle and filter'\nset yrange "
      "[0:*]\nset key outside top center horizontal noenhanced\nset grid y\n$d << EOD\n" +
      data +
      "EOD\nplot $d using 2:xtic(1) title 'R8G8B8A8_UNORM', '' using 3 title 'R16G16B16A16_SFLOAT', '' using "
      "4 title 'R32G32B32A32_SFLOAT'";
  return result;
}

}  // namespace quadrille::studies::experiments
