/// Boxes of what draws read, each found once, and the planes that they are held against.
#include "pipeline/driver/draw_culling.h"

#include "hw/frame/indices.h"
#include "models/base/format.h"
#include "pipeline/driver/position_bounds.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>

namespace quadrille::pipeline {
namespace {

using Elements = std::vector<std::uint32_t>;  ///< vertices or instances, each once
using AttributeBox = std::array<std::optional<InputBounds>, 4>;

/// Of one component, over the elements of a draw; none if one of them is not finite.
class ComponentBounds {
 public:
  void add(float value) {
    finite_ = finite_ && std::isfinite(value);
    bounds_.low = std::min(bounds_.low, value);
    bounds_.high = std::max(bounds_.high, value);
  }
  [[nodiscard]] std::optional<InputBounds> take() const {
    return finite_ && bounds_.low <= bounds_.high ? std::optional(bounds_) : std::nullopt;
  }

 private:
  InputBounds bounds_{HUGE_VALF, -HUGE_VALF};
  bool finite_ = true;
};

class BoxFinder {
 public:
  explicit BoxFinder(const models::DeviceMemory& memory) : memory_(memory) {}

  std::optional<InputBounds> bounds(const hw::DrawState& draw, std::size_t row) {
    for (const hw::AttributeFetch& fetch : draw.attributes) {
      const auto component = std::ranges::find(fetch.input_row, static_cast<int>(row));
      if (component == fetch.input_row.end()) continue;
      return box(draw, fetch)[static_cast<std::size_t>(component - fetch.input_row.begin())];
    }
    return std::nullopt;
  }

 private:
  const AttributeBox& box(const hw::DrawState& draw, const hw::AttributeFetch& fetch) {
    const Elements& elements = fetch.per_instance ? instances(draw) : vertices(draw);
    const auto key = std::tuple{&elements, fetch.address, fetch.stride, fetch.format};
    const auto [place, fresh] = boxes_.try_emplace(key);
    if (fresh) place->second = box_of(fetch, elements);
    return place->second;
  }

  [[nodiscard]] AttributeBox box_of(const hw::AttributeFetch& fetch, const Elements& elements) const {
    if (models::is_integer_format(fetch.format)) return {};
    std::array<ComponentBounds, 4> bounds;
    for (const std::uint32_t element : elements) {
      std::array<std::uint32_t, 4> words{};
      const std::uint64_t address = fetch.address + std::uint64_t{element} * fetch.stride;
      models::decode_attribute(fetch.format, memory_.read(address, models::format_bytes(fetch.format)).data(),
                               words.data());
      for (std::size_t c = 0; c < 4; ++c) bounds[c].add(std::bit_cast<float>(words[c]));
    }
    AttributeBox box;
    for (std::size_t c = 0; c < 4; ++c) box[c] = bounds[c].take();
    return box;
  }

  /// All vertices that the draw's list names.
  const Elements& vertices(const hw::DrawState& draw) {
    const auto [place, fresh] =
        vertices_.try_emplace({draw.indexed ? draw.index_bytes : 0, draw.index_address, draw.count,
                               draw.first_vertex, draw.vertex_offset, draw.restarts});
    Elements& elements = place->second;
    if (!fresh) return elements;
    elements.reserve(draw.count);
    for (std::uint32_t position = 0; position < draw.count; ++position)
      if (!draw.restarts || !hw::is_restart(draw, memory_, position))
        elements.push_back(hw::vertex_number(draw, memory_, position));
    std::ranges::sort(elements);
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    return elements;
  }

  const Elements& instances(const hw::DrawState& draw) {
    Elements& elements = instances_[{draw.first_instance, draw.instances}];
    for (auto i = static_cast<std::uint32_t>(elements.size()); i < draw.instances; ++i)
      elements.push_back(draw.first_instance + i);
    return elements;
  }

  const models::DeviceMemory& memory_;
  std::map<std::tuple<std::uint32_t, std::uint64_t, std::uint32_t, std::uint32_t, std::int32_t, bool>,
           Elements>
      vertices_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Elements> instances_;
  std::map<std::tuple<const Elements*, std::uint64_t, std::uint32_t, models::Format>, AttributeBox> boxes_;
};

/// All such positions are outside of one plane, the same for all. [VK1.3 #vertexpostproc-clipping]
bool outside_one_plane(const std::array<Affine, 4>& position, bool depth_clamp) {
  const Affine& w = position[3];
  if (!w.bounded) return false;
  if (w.high() < 0) return true;
  const auto beyond = [&](const Affine& a, double sign) { return a.bounded && greatest_sum(w, a, sign) < 0; };
  for (std::size_t side = 0; side < 2; ++side)
    if (beyond(position[side], 1) || beyond(position[side], -1)) return true;
  const Affine& z = position[2];
  return !depth_clamp && ((z.bounded && z.high() < 0) || beyond(z, -1));
}

bool is_outside(const hw::DrawState& draw, BoxFinder& boxes) {
  if (models::writes_buffers(*draw.vertex.program)) return false;
  ProgramInputs inputs{draw.vertex.constants, [&](std::size_t row) { return boxes.bounds(draw, row); }, {}};
  if (draw.instances == 1) inputs.instance = draw.first_instance;
  return outside_one_plane(position_bounds(*draw.vertex.program, inputs),
                           draw.views.front().clip.depth_clamp);
}

}  // namespace

void find_draws_outside(hw::Frame& frame, const models::DeviceMemory& memory) {
  BoxFinder boxes(memory);
  for (hw::DrawState& draw : frame.draws) draw.outside_view = is_outside(draw, boxes);
}

}  // namespace quadrille::pipeline
