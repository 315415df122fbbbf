#include "studies/stability/observed.h"

#include <algorithm>
#include <cstring>

#include "studies/given_reference.h"

namespace quadrille::studies::stability {

namespace ref = models::reference;

DrawnArea drawn_area(const traces::CommandStream& stream) {
  std::uint32_t width = 0, height = 0;
  DrawnArea area{~0u, ~0u, 0, 0};
  traces::SetScissor scissor;
  for (const traces::Command& command : stream.commands) {
    if (const auto* begin = std::get_if<traces::BeginPass>(&command)) {
      const traces::PassTarget target = traces::target_of(stream, *begin);
      width = target.width;
      height = target.height;
    }
    if (const auto* set = std::get_if<traces::SetScissor>(&command)) scissor = *set;
    if (!std::holds_alternative<traces::Draw>(command)) continue;
    const auto left = static_cast<std::uint32_t>(std::max(0, scissor.x)),
               top = static_cast<std::uint32_t>(std::max(0, scissor.y));
    area.left = std::min(area.left, left);
    area.top = std::min(area.top, top);
    area.right = std::max(area.right, std::min(width, left + scissor.width));
    area.bottom = std::max(area.bottom, std::min(height, top + scissor.height));
  }
  return area.right == 0 ? DrawnArea{} : area;
}

Observed observe(traces::CommandStream stream, std::unique_ptr<pipeline::MachineConfig> machine) {
  Observed o{std::move(stream), std::move(machine), {}, {}};
  o.functional = pipeline::render_functional_frame(o.stream, o.machine->precision());
  o.exact = pipeline::render_exact(o.stream, *o.machine);
  return o;
}

ref::Result given_reference(const Observed& o) {
  return render_with_reference(o.stream, o.machine->precision()).reference;
}

ref::Result ideal_reference(const Observed& o) { return ref::render(o.stream, {}); }

scenes::Rgba8Image as_picture(const pipeline::FrameImage& image) {
  scenes::Rgba8Image out{image.width, image.height, std::vector<std::uint8_t>(image.color.size() * 4)};
  std::memcpy(out.pixels.data(), image.color.data(), out.pixels.size());
  for (std::size_t i = 3; i < out.pixels.size(); i += 4) out.pixels[i] = 255;
  return out;
}

scenes::Rgba8Image count_picture(const pipeline::FrameImage& image, const DrawnArea& area) {
  constexpr std::array<std::array<std::uint8_t, 3>, 4> kColors{
      {{0, 0, 0}, {40, 170, 90}, {240, 210, 40}, {220, 40, 40}}};
  scenes::Rgba8Image out{image.width, image.height, std::vector<std::uint8_t>(image.color.size() * 4, 255)};
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const std::size_t i = std::size_t{y} * image.width + x;
      const std::array<std::uint8_t, 3> grey{70, 70, 70};
      const auto& color = area.holds(x, y) ? kColors[std::min<std::size_t>(3, image.color[i] & 0xffu)] : grey;
      std::copy(color.begin(), color.end(), out.pixels.begin() + static_cast<std::ptrdiff_t>(4 * i));
    }
  }
  return out;
}

scenes::Rgba8Image reduced(const scenes::Rgba8Image& image, std::uint32_t side) {
  const std::uint32_t factor = (std::max(image.width, image.height) + side - 1) / side;
  if (factor <= 1) return image;
  const std::uint32_t width = (image.width + factor - 1) / factor,
                      height = (image.height + factor - 1) / factor;
  scenes::Rgba8Image out{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      std::array<std::uint64_t, 4> sum{};
      std::uint64_t count = 0;
      for (std::uint32_t v = y * factor; v < std::min(image.height, (y + 1) * factor); ++v) {
        for (std::uint32_t u = x * factor; u < std::min(image.width, (x + 1) * factor); ++u, ++count) {
          for (std::size_t c = 0; c < 4; ++c)
            sum[c] += image.pixels[4 * (std::size_t{v} * image.width + u) + c];
        }
      }
      for (std::size_t c = 0; c < 4; ++c)
        out.pixels[4 * (std::size_t{y} * width + x) + c] =
            static_cast<std::uint8_t>((sum[c] + count / 2) / count);
    }
  }
  return out;
}

scenes::Rgba8Image enlarged(const scenes::Rgba8Image& image, std::uint32_t side) {
  const std::uint32_t longest = std::max({1u, image.width, image.height}),
                      factor = (side + longest - 1) / longest;
  scenes::Rgba8Image out{image.width * factor, image.height * factor, {}};
  for (std::uint32_t y = 0; y < out.height; ++y) {
    for (std::uint32_t x = 0; x < out.width; ++x) {
      const auto from = image.pixels.begin() +
                        static_cast<std::ptrdiff_t>(4 * (std::size_t{y / factor} * image.width + x / factor));
      out.pixels.insert(out.pixels.end(), from, from + 4);
    }
  }
  return out;
}

}  // namespace quadrille::studies::stability
