/// Compression of depths and colours: what it saves of the bytes that depth units, ROPs and scan-out move,
/// beside what layers over the whole frame must take, and of scenes.
#include <fmt/format.h>

#include <algorithm>

#include "studies/experiments/experiment.h"
#include "studies/experiments/triangle_mesh.h"

namespace quadrille::studies::experiments {
namespace {

constexpr int kLayers = 32;
constexpr double kLinePixels = 32, kSectorBytes = 32;
const std::vector<std::string> kOn{"depth.compression=plane_offset", "rop.compression=samples_offset"};
/// Caches that hold what is under way and less than a frame, so that each layer moves all of it. Every depth
/// is read.
const std::vector<std::string> kSmallCaches{"depth.cache_lines=32", "depth.cache_ways=32",
                                            "rop.cache_lines=128", "rop.cache_ways=32",
                                            "coarse_raster.hiz=false"};

std::vector<std::string> with(std::vector<std::string> settings, const std::vector<std::string>& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

/// What the depth units, the ROPs and the scan-out move.
double depth_bytes(const Readings& r) { return r["depth.read_bytes"] + r["depth.write_bytes"]; }
double color_bytes(const Readings& r) { return r["rop.read_bytes"] + r["rop.write_bytes"]; }
double memory_bytes(const Readings& r) { return r["memory.read_bytes"] + r["memory.write_bytes"]; }

/// Layers of one triangle each, which covers all of the frame, the next one before the last. Their depths are
/// slanted planes.
TriangleMesh slanted_layers(const Setting& setting) {
  TriangleMesh mesh{setting.width, setting.height, {}, {}};
  const auto right = static_cast<std::int32_t>(2 * setting.width) * kGrid,
             bottom = static_cast<std::int32_t>(2 * setting.height) * kGrid;
  for (std::uint32_t i = 0; i < kLayers; ++i) {
    const float nearer = static_cast<float>(i) / 256;
    mesh.corners.push_back({0, 0, 0.75F - nearer});
    mesh.corners.push_back({right, 0, 0.95F - nearer});
    mesh.corners.push_back({0, bottom, 0.85F - nearer});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// Layers over the whole frame, and the sectors that they must move of each line of a sample's plane.
struct Case {
  const char* name;
  DrawOptions options;
  std::uint32_t samples;
  bool depth;             ///< what counts are depths; else colours
  double plain, encoded;  ///< sectors a line and layer
  double once_plain = 0;  ///< and at the end of the pass, a line of one sample: the samples are read and the
  double once_encoded = 0;  ///< mean is written
};
/// A depth is read and written by each layer but the first, which finds it cleared, and the depths that are
/// still in the cache at the end are dropped. A blended colour is read likewise; an opaque one is not. Of
/// samples that agree one in so many is moved.
const Case kCases[] = {
    {"depths of a plane", {.depth = true}, 1, true, 8, 2},
    {"depths of a plane", {.depth = true}, 4, true, 8, 2},
    {"opaque layers of one colour", {}, 1, false, 4, 1},
    {"blended layers of one colour", {.blends = true}, 1, false, 8, 2},
    {"opaque layers of one colour", {}, 4, false, 4, 0.25, 20, 2},
    {"blended layers of one colour", {.blends = true}, 4, false, 8, 0.5, 20, 2},
    {"opaque layers of one colour", {}, 8, false, 4, 0.125, 36, 2},
};

/// Bytes of all layers. What is read is read one time less often than it is written.
double form_of(const Case& c, const Setting& setting, bool encoded) {
  const double lines = double{1} * setting.width * setting.height / kLinePixels;
  const double a_layer = encoded ? c.encoded : c.plain;
  const bool reads = c.depth || c.options.blends;
  const double layers = reads ? kLayers - 0.5 : kLayers;
  return kSectorBytes * lines * (layers * a_layer * c.samples + (encoded ? c.once_encoded : c.once_plain));
}

void judge_layers(const Setting& setting, Result& result) {
  std::vector<traces::CommandStream> streams;
  std::vector<Frame> frames;
  streams.reserve(std::size(kCases));
  for (const Case& c : kCases) {
    streams.push_back(stream_of(slanted_layers(setting), c.options));
    if (c.samples > 1) traces::use_samples(streams.back(), c.samples);
    frames.push_back({&streams.back(), kSmallCaches});
    frames.push_back({&streams.back(), with(kSmallCaches, kOn)});
  }
  const std::vector<Readings> read = draw(frames, setting);
  result.table.head = {"layers",   "samples",  "plain MB",       "encoded MB",
                       "of plain", "expected", "cycles of plain"};
  for (std::size_t i = 0; i < std::size(kCases); ++i) {
    const Case& c = kCases[i];
    const Readings &plain = read[2 * i], &encoded = read[2 * i + 1];
    const auto bytes = c.depth ? &depth_bytes : &color_bytes;
    const double expected = form_of(c, setting, true) / form_of(c, setting, false);
    result.table.rows.push_back(
        {c.name, fmt::format("{}", c.samples), fmt::format("{:.2f}", bytes(plain) / 1e6),
         fmt::format("{:.2f}", bytes(encoded) / 1e6), fmt::format("{:.3f}", bytes(encoded) / bytes(plain)),
         fmt::format("{:.3f}", expected),
         fmt::format("{:.2f}", encoded["frame.cycles"] / plain["frame.cycles"])});
    const std::string what = fmt::format("{}, {} a pixel", c.name, c.samples);
    result.verdicts.push_back(
        {what + ": plain bytes over the form", bytes(plain) / form_of(c, setting, false), 0.98, 1.02});
    result.verdicts.push_back(
        {what + ": encoded bytes over the form", bytes(encoded) / form_of(c, setting, true), 0.98, 1.02});
  }
}

std::string percent(double part, double whole) {
  return whole == 0 ? "-" : fmt::format("{:.0f}", 100 * part / whole);
}

/// Of the lines that were written back, by how they are stored.
std::vector<std::string> shares(const Readings& r, const std::string& unit, const char* first,
                                const char* second) {
  const double a = r[unit + first], b = r[unit + second], plain = r[unit + ".plain_lines"];
  return {percent(a, a + b + plain), percent(b, a + b + plain)};
}

void measure_scenes(const Setting& setting, Result& result) {
  constexpr std::uint32_t kSamples[] = {1, 4, 8};
  Table table;
  table.head = {"scene",           "samples",   "depth MB",       "encoded, of it",     "lines as planes %",
                "as offsets %",    "colour MB", "encoded, of it", "lines as offsets %", "copies %",
                "scan-out, of it", "memory MB", "encoded, of it", "cycles, of plain"};
  for (const auto& [name, load] : setting.scenes) {
    setting.progress(name);
    std::vector<traces::CommandStream> streams;
    std::vector<Frame> frames;
    streams.reserve(std::size(kSamples));
    for (const std::uint32_t samples : kSamples) {
      streams.push_back(load());
      if (samples > 1) traces::use_samples(streams.back(), samples);
      frames.push_back({&streams.back(), {}});
      frames.push_back({&streams.back(), kOn});
    }
    const std::vector<Readings> read = draw(frames, setting);
    for (std::size_t i = 0; i < std::size(kSamples); ++i) {
      const Readings &plain = read[2 * i], &encoded = read[2 * i + 1];
      const auto of = [&](auto&& bytes) {
        return bytes(plain) == 0 ? "-" : fmt::format("{:.2f}", bytes(encoded) / bytes(plain));
      };
      const auto planes = shares(encoded, "depth", ".plane_lines", ".offset_lines");
      const auto copies = shares(encoded, "rop", ".offset_lines", ".copied_lines");
      table.rows.push_back({name, fmt::format("{}", kSamples[i]),
                            fmt::format("{:.2f}", depth_bytes(plain) / 1e6), of(depth_bytes), planes[0],
                            planes[1], fmt::format("{:.2f}", color_bytes(plain) / 1e6), of(color_bytes),
                            copies[0], copies[1],
                            of([](const Readings& r) { return r["scan_out.read_bytes"]; }),
                            fmt::format("{:.2f}", memory_bytes(plain) / 1e6), of(memory_bytes),
                            fmt::format("{:.2f}", encoded["frame.cycles"] / plain["frame.cycles"])});
      const std::string what = fmt::format("{}, {} samples", name, kSamples[i]);
      result.verdicts.push_back(
          {what + ": memory bytes, encoded over plain", memory_bytes(encoded) / memory_bytes(plain), 0, 1});
      result.verdicts.push_back(
          {what + ": cycles, encoded over plain", encoded["frame.cycles"] / plain["frame.cycles"], 0, 1.01});
    }
  }
  result.further_tables.push_back(std::move(table));
}

std::string plot_of(const Table& scenes) {
  std::string data;
  for (const auto& row : scenes.rows)
    data +=
        fmt::format("\"{}, {}\" {} {} {}\n", row[0], row[1], row[3] == "-" ? "0" : row[3], row[7], row[12]);
  return "set style data histogram\nset style fill solid 0.7\nset ylabel 'bytes, encoded over plain'\nset "
         "yrange [0:*]\nset xtics rotate by -30\nset grid y\n$d << EOD\n" +
         data +
         "EOD\nplot $d using 2:xtic(1) title 'depth', '' using 3 title 'colour', '' using 4 title 'memory'";
}

}  // namespace

Result compression(const Setting& setting) {
  Result result;
  judge_layers({{}, 256, 128, setting.jobs, setting.progress}, result);
  measure_scenes(setting, result);
  result.remarks = {
      "A line of 128 bytes takes one to four sectors of 32. A plane's depths, and pixels of one colour, take "
      "one. Lines of later samples that equal those of the first take none.",
      "Depth and colour bytes are those between the units' caches and the L2 cache; memory bytes are all "
      "that "
      "the channels move. Pictures are the same with and without.",
      "A plain line is read and written by the sectors that a triangle touches, an encoded one as a whole. "
      "In a "
      "scene of small triangles whose planes do not fit the units' caches, as the courtyard's of several "
      "samples, the links to the L2 cache carry about as much as before. The L2 cache then holds more of the "
      "surfaces, and memory moves less."};
  result.plot = plot_of(result.further_tables.front());
  return result;
}

}  // namespace quadrille::studies::experiments
