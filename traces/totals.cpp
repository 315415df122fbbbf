/// Counts what a stream asks for and prints it for a person.
#include <fmt/format.h>

#include "models/geometry/assembly.h"
#include "traces/trace_file.h"

namespace quadrille::traces {
namespace {

/// Adds a draw to the totals by the topology of the pipeline that is bound then.
struct Counter {
  const CommandStream& stream;
  StreamTotals& totals;
  Topology topology = Topology::kTriangleList;

  void operator()(const BeginPass&) const { ++totals.passes; }
  void operator()(const BindPipeline& c) {
    if (c.pipeline < stream.pipelines.size()) topology = stream.pipelines[c.pipeline].topology;
  }
  void operator()(const BeginQuery&) const { ++totals.queries; }
  void operator()(const Draw& c) const {
    ++totals.draws;
    const std::uint64_t primitives = std::uint64_t{models::primitive_count(topology, c.count)} * c.instances;
    switch (topology) {
      case Topology::kPointList: totals.points += primitives; break;
      case Topology::kLineList:
      case Topology::kLineStrip: totals.lines += primitives; break;
      case Topology::kTriangleList:
      case Topology::kTriangleStrip:
      case Topology::kTriangleFan: totals.triangles += primitives; break;
    }
    totals.vertices += std::uint64_t{c.count} * c.instances;
  }
  template <class Other>
  void operator()(const Other&) const {}
};

std::string megabytes(std::uint64_t bytes) {
  return fmt::format("{:.2f} MiB", static_cast<double>(bytes) / (1 << 20));
}

/// Of an attachment that has more than one level or layer.
std::string parts_of(const Image& image) {
  if (image.levels == 1 && image.layers == 1) return {};
  return fmt::format("{} levels, {} layers, ", image.levels, image.layers);
}

}  // namespace

StreamTotals stream_totals(const CommandStream& stream) {
  StreamTotals totals;
  for (const Buffer& buffer : stream.buffers) totals.buffer_bytes += buffer.data.size();
  for (const Image& image : stream.images)
    totals.image_bytes += image.is_attachment() ? image.texels.size() : texel_bytes(image);
  Counter counter{stream, totals};
  for (const Command& command : stream.commands) std::visit(counter, command);
  return totals;
}

std::string trace_info(const CommandStream& stream) {
  const StreamTotals totals = stream_totals(stream);
  std::string text = fmt::format("trace '{}'\n", stream.name);
  for (const Image& image : stream.images) {
    if (image.is_attachment())
      text += fmt::format("  attachment {}x{}, {}{} '{}'\n", image.width, image.height, parts_of(image),
                          models::format_info(image.format).name, image.name);
  }
  text += fmt::format("  buffers    {:6} {}\n", stream.buffers.size(), megabytes(totals.buffer_bytes));
  text += fmt::format("  images     {:6} {}\n", stream.images.size(), megabytes(totals.image_bytes));
  text +=
      fmt::format("  samplers   {:6}\n  shaders    {:6}\n", stream.samplers.size(), stream.shaders.size());
  text += fmt::format("  pipelines  {:6}\n  sets       {:6}\n", stream.pipelines.size(),
                      stream.descriptor_sets.size());
  if (!stream.query_pools.empty()) text += fmt::format("  queries    {:6}\n", totals.queries);
  text += fmt::format("  commands   {:6}\n  passes     {:6}\n", stream.commands.size(), totals.passes);
  text += fmt::format("  draws      {:6}\n  triangles  {:6}\n", totals.draws, totals.triangles);
  if (totals.lines > 0) text += fmt::format("  lines      {:6}\n", totals.lines);
  if (totals.points > 0) text += fmt::format("  points     {:6}\n", totals.points);
  text += fmt::format("  vertices   {:6}\n", totals.vertices);
  return text;
}

}  // namespace quadrille::traces
