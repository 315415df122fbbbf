#include "traces/capture/provoking.h"

#include <algorithm>
#include <cstring>

#include "models/base/error.h"

namespace quadrille::capture {
namespace {

using traces::Topology;
using Run = std::span<const std::uint32_t>;

/// Of vertices between two ends of strips.
void turn(Topology topology, Run v, std::vector<std::uint32_t>& out) {
  const auto add = [&](std::initializer_list<std::size_t> places) {
    for (const std::size_t place : places) out.push_back(v[place]);
  };
  switch (topology) {
    case Topology::kPointList: out.insert(out.end(), v.begin(), v.end()); break;
    case Topology::kLineList:
      for (std::size_t i = 0; i + 1 < v.size(); i += 2) add({i + 1, i});
      break;
    case Topology::kLineStrip:
      for (std::size_t i = 0; i + 1 < v.size(); ++i) add({i + 1, i});
      break;
    case Topology::kTriangleList:
      for (std::size_t i = 0; i + 2 < v.size(); i += 3) add({i + 2, i, i + 1});
      break;
    case Topology::kTriangleStrip:
      for (std::size_t i = 0; i + 2 < v.size(); ++i) {
        if (i % 2 == 0) add({i + 2, i, i + 1});
        else add({i + 2, i + 1, i});
      }
      break;
    case Topology::kTriangleFan:
      for (std::size_t i = 0; i + 2 < v.size(); ++i) add({i + 2, 0, i + 1});
      break;
  }
}

}  // namespace

Topology turned_topology(Topology topology) {
  switch (topology) {
    case Topology::kPointList: return Topology::kPointList;
    case Topology::kLineList:
    case Topology::kLineStrip: return Topology::kLineList;
    case Topology::kTriangleList:
    case Topology::kTriangleStrip:
    case Topology::kTriangleFan: break;
  }
  return Topology::kTriangleList;
}

std::vector<std::uint32_t> turned_indices(Topology topology,
                                          std::span<const std::optional<std::uint32_t>> vertices) {
  std::vector<std::uint32_t> out, run;
  for (const std::optional<std::uint32_t>& vertex : vertices) {
    if (vertex) {
      run.push_back(*vertex);
      continue;
    }
    turn(topology, run, out);
    run.clear();
  }
  turn(topology, run, out);
  return out;
}

std::vector<std::optional<std::uint32_t>> read_indices(std::span<const std::byte> buffer,
                                                       std::uint64_t offset, traces::IndexType type,
                                                       std::uint32_t first, std::uint32_t count,
                                                       bool restart) {
  const std::size_t bytes = type == traces::IndexType::kUint8    ? 1
                            : type == traces::IndexType::kUint16 ? 2
                                                                 : 4;
  const std::uint64_t begin = offset + std::uint64_t{first} * bytes;
  if (begin > buffer.size() || std::uint64_t{count} * bytes > buffer.size() - begin)
    throw user_error("indices {}+{} reach beyond an index buffer of {} bytes", first, count, buffer.size());
  const std::uint32_t special = bytes == 4 ? 0xffffffffu : (1u << (8 * bytes)) - 1;
  std::vector<std::optional<std::uint32_t>> indices(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t index = 0;
    std::memcpy(&index, buffer.data() + begin + std::size_t{i} * bytes, bytes);
    if (!restart || index != special) indices[i] = index;
  }
  return indices;
}

}  // namespace quadrille::capture
