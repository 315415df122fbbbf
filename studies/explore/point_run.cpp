#include "studies/explore/point_run.h"

#include <xxhash.h>

#include <array>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/report/report.h"
#include "scenes/image/plain_image.h"

namespace quadrille::studies::explore {
namespace {

using Json = nlohmann::json;

void add_numbers(const std::string& path, const Json& value, std::map<std::string, double>& figures) {
  if (value.is_number()) figures[path] = value.get<double>();
  if (!value.is_object()) return;
  for (const auto& [key, entry] : value.items()) add_numbers(path + "." + key, entry, figures);
}

std::vector<std::byte> png_of(const pipeline::FrameImage& image) {
  scenes::Rgba8Image rgba{image.width, image.height, {}};
  rgba.pixels.resize(image.color.size() * 4);
  for (std::size_t i = 0; i < image.color.size(); ++i) {
    const std::uint32_t opaque = image.color[i] | 0xff000000u;
    std::memcpy(rgba.pixels.data() + 4 * i, &opaque, 4);
  }
  return image.color.empty() ? std::vector<std::byte>()
                             : scenes::encode_plain_png(rgba).value_or(std::vector<std::byte>());
}

void put(std::string& bytes, std::string_view part) {
  const std::uint64_t size = part.size();
  bytes.append(reinterpret_cast<const char*>(&size), sizeof(size));
  bytes.append(part);
}

std::string_view take(std::string_view& bytes) {
  std::uint64_t size = 0;
  if (bytes.size() < sizeof(size)) throw std::runtime_error("the output of a point is cut short");
  std::memcpy(&size, bytes.data(), sizeof(size));
  bytes.remove_prefix(sizeof(size));
  if (bytes.size() < size) throw std::runtime_error("the output of a point is cut short");
  const std::string_view part = bytes.substr(0, size);
  bytes.remove_prefix(size);
  return part;
}

}  // namespace

std::string figure_lines(std::string_view figures_json) {
  const Json document = Json::parse(figures_json);
  std::map<std::string, double> figures;
  for (const auto& [key, value] : document.items())
    if (key != "machine" && key != "counter_definitions") add_numbers(key, value, figures);
  std::string lines;
  for (const auto& [path, value] : figures) lines += fmt::format("{}={}\n", path, value);
  return lines;
}

PointOutput draw_point(const traces::CommandStream& stream, const pipeline::MachineConfig& machine,
                       std::int64_t window, pipeline::PreparedFrame* prepared,
                       const std::function<bool(const std::string&)>& picture_known) {
  pipeline::MachineOptions options;
  options.window = hw::Clock(static_cast<std::int64_t>(machine.gpu.clock_mhz * 1e6)).edge(window);
  const pipeline::RenderedFrame frame = prepared != nullptr
                                            ? prepared->render(machine, options)
                                            : pipeline::render_exact(stream, machine, options);
  if (!frame.figures.checks_hold())
    throw std::logic_error("the figures contradict each other\n" + pipeline::failed_checks(frame.figures));
  PointOutput output;
  output.figures =
      figure_lines(pipeline::report_json({frame.figures, machine, frame.image.width, frame.image.height}));
  output.simulate_s = frame.figures.host.simulate_s;
  output.picture = fmt::format(
      "{:016x}", XXH3_64bits(frame.image.color.data(), frame.image.color.size() * sizeof(std::uint32_t)));
  if (!picture_known(output.picture)) output.png = png_of(frame.image);
  return output;
}

std::string encode(const PointOutput& output) {
  std::string bytes;
  put(bytes, output.figures);
  put(bytes, output.picture);
  put(bytes, {reinterpret_cast<const char*>(output.png.data()), output.png.size()});
  put(bytes, {reinterpret_cast<const char*>(&output.simulate_s), sizeof(output.simulate_s)});
  return bytes;
}

PointOutput decode_output(std::string_view bytes) {
  PointOutput output;
  output.figures = take(bytes);
  output.picture = take(bytes);
  const std::string_view png = take(bytes), seconds = take(bytes);
  const auto* data = reinterpret_cast<const std::byte*>(png.data());
  output.png.assign(data, data + png.size());
  if (seconds.size() != sizeof(output.simulate_s))
    throw std::runtime_error("the output of a point is damaged");
  std::memcpy(&output.simulate_s, seconds.data(), seconds.size());
  return output;
}

}  // namespace quadrille::studies::explore
