/// Counts what a stream asks for and prints it for a person.
#include <fmt/format.h>

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
  void operator()(const Draw& c) const {
    ++totals.draws;
    totals.triangles += std::uint64_t{triangle_count(topology, c.count)} * c.instances;
    totals.vertices += std::uint64_t{c.count} * c.instances;
  }
  template <class Other>
  void operator()(const Other&) const {}
};

std::string megabytes(std::uint64_t bytes) {
  return fmt::format("{:.2f} MiB", static_cast<double>(bytes) / (1 << 20));
}

}  // namespace

std::uint32_t triangle_count(Topology topology, std::uint32_t count) {
  if (topology == Topology::kTriangleList) return count / 3;
  return count < 3 ? 0 : count - 2;
}

StreamTotals stream_totals(const CommandStream& stream) {
  StreamTotals totals;
  for (const Buffer& buffer : stream.buffers) totals.buffer_bytes += buffer.data.size();
  for (const Image& image : stream.images)
    totals.image_bytes += image.is_attachment() ? 0 : texel_bytes(image);
  Counter counter{stream, totals};
  for (const Command& command : stream.commands) std::visit(counter, command);
  return totals;
}

std::string trace_info(const CommandStream& stream) {
  const StreamTotals totals = stream_totals(stream);
  std::string text = fmt::format("trace '{}'\n", stream.name);
  for (const Image& image : stream.images) {
    if (image.is_attachment())
      text += fmt::format("  attachment {}x{}, {} '{}'\n", image.width, image.height,
                          models::format_info(image.format).name, image.name);
  }
  text += fmt::format("  buffers    {:6} {}\n", stream.buffers.size(), megabytes(totals.buffer_bytes));
  text += fmt::format("  images     {:6} {}\n", stream.images.size(), megabytes(totals.image_bytes));
  text +=
      fmt::format("  samplers   {:6}\n  shaders    {:6}\n", stream.samplers.size(), stream.shaders.size());
  text += fmt::format("  pipelines  {:6}\n  sets       {:6}\n", stream.pipelines.size(),
                      stream.descriptor_sets.size());
  text += fmt::format("  commands   {:6}\n  passes     {:6}\n", stream.commands.size(), totals.passes);
  text += fmt::format("  draws      {:6}\n  triangles  {:6}\n  vertices   {:6}\n", totals.draws,
                      totals.triangles, totals.vertices);
  return text;
}

}  // namespace quadrille::traces
