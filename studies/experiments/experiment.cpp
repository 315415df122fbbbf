#include "studies/experiments/experiment.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "models/base/error.h"
#include "pipeline/render.h"
#include "pipeline/report/report.h"
#include "studies/child_run.h"

namespace quadrille::studies::experiments {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLongestFrameSeconds = 3600;

const Experiment kExperiments[] = {
    {"memory-scheduling",
     "Memory access scheduling",
     "Rixner and others (Memory Access Scheduling, ISCA 2000), media kernels and applications on one Imagine "
     "processor with in-order "
     "access as the base: "
     "first-ready scheduling raises the sustained bandwidth by 17 % on applications and 40 % on streams, "
     "aggressive reordering by 93 %.",
     "Frames that memory limits, each with four controllers: in order; in order with rows opened ahead; "
     "first-ready; first-ready with "
     "writes drained by watermarks. "
     "Victims leave the L2 cache in "
     "the order of eviction. Bandwidth is bytes moved by the channels over the frame's cycles.",
     &memory_scheduling,
     {"builtin:fill", "builtin:overdraw", "builtin:courtyard"},
     "960x540"},
    {"vertex-reuse",
     "Vertex reuse",
     "Kerbl and others (Revisiting the Vertex Cache, 2018): GPUs reuse vertices within a batch, not through "
     "one cache. The indices 0, 1, 2 "
     "drawn again and again cost a GeForce GTX 1080 Ti three invocations of the vertex shader up to 96 "
     "indices and six at 99; on a Radeon "
     "R7 "
     "200 the step is at 384. meshoptimizer's analyser counts what a mesh costs by such rules.",
     "Every draw of a scene under six policies of vertex fetch, its shaded vertices beside the analyser's "
     "count of the same index lists; "
     "and "
     "the repeated triangle on both sides of the published steps.",
     &vertex_reuse,
     {"builtin:courtyard", "builtin:materials", "builtin:flag", "builtin:quad"},
     "320x180"},
    {"small-triangles",
     "Small triangles",
     "Riccio (How bad are small triangles on GPU and why?, g-truc, 2014), a frame of 1920x1080 filled by "
     "tiles of two triangles, time "
     "against tiles of 128x128: no loss at 16x16 and above, a visible one at 8x8; at 1x1 about 10 times on "
     "Haswell, 15 on Kepler, 20 on "
     "Southern Islands. 256x1 differs from 1x256.",
     "The same tiles, one indexed draw, shaders that hand through, on the default machine with four times "
     "its channels, so that memory is "
     "not the limit, and on machines of the cards' rates. Cycles until the pass is flushed.",
     &small_triangles,
     {},
     "1920x1080"},
    {"setup-rate",
     "Set-up rate",
     "Reviews of the time (gpu-tech.org, GF100 vs. Archmark): up to the GT200 one triangle a clock when it "
     "is culled and half of that when "
     "it is drawn; one drawn a clock on the Radeon HD 5000; 3.5 a clock with the four raster engines of the "
     "GF100.",
     "A mesh of triangles of one pixel each, drawn eight times over: as it is, all culled, and all off "
     "screen. Cycles until the pass is "
     "flushed.",
     &setup_rate,
     {},
     "128x128"},
    {"quad-overhead",
     "Quad overhead",
     "Fatahalian and others (Reducing Shading on GPUs using Quad-Fragment Merging, SIGGRAPH 2010): a "
     "fragment costs at most 4 lanes at one "
     "sample; about 1.4 lanes of 4 are live at triangles of one pixel; with several samples a covered pixel "
     "is shaded more than 8 times.",
     "Frames of triangles of one area each, on the default machine: lanes executed over fragments covered.",
     &quad_overhead,
     {},
     "960x540"},
    {"hidden-surfaces",
     "Hidden surfaces",
     "ATI's Radeon X800 (reviews of 2004: Hexus, AnandTech) drops up to 256 hidden pixels a clock by a "
     "hierarchical depth test of blocks "
     "of 8x8 pixels.",
     "Ten layers over the whole frame, each two triangles, depth test less and depth written: front to back "
     "and back to front, with and "
     "without Hi-Z, on the default machine with four times its channels.",
     &hidden_surfaces,
     {},
     "960x540"},
    {"engines",
     "Raster engines, geometry front ends and cores",
     "Nothing is published to compare with: a bound of our own, 1.5 times from 16 to 64 cores.",
     "Scenes on machines of 16, 32 and 64 cores with 1, 2 and 4 raster engines, and with 2 and 4 geometry "
     "front ends beside four engines; 16 memory channels and 16 screen partitions on each.",
     &engines,
     {"builtin:courtyard", "builtin:cubes"},
     "960x540"},
    {"samples",
     "Samples a pixel",
     "Nothing is published to compare with: each doubling of the samples must bring the picture nearer to "
     "one of 64 "
     "samples, and may cost at most twice the cycles. Shading each sample for itself must bring it nearer "
     "again, at not more than as many times the cycles.",
     "Scenes with 1, 2, 4 and 8 samples a pixel, each pixel shaded once or each sample, on the default "
     "machine: cycles, bytes moved by the memory "
     "channels, and "
     "the error of the picture.",
     &samples,
     {"builtin:cubes", "builtin:courtyard", "builtin:flag"},
     "320x180"},
    {"formats",
     "Colour formats",
     "Nothing is published to compare with: the ruler is arithmetic.",
     "Layers over the whole frame in each format of a colour attachment, opaque and blended, on a machine of "
     "slow ROPs and fast memory.",
     &formats,
     {},
     "256x128"},
    {"color-writes",
     "Colour writes by format",
     "Measured on a GeForce GTX 460 with a bus of 192 bits (GPU Pro series, compressed frame buffers, fig. "
     "4.6): pixels a second by format, blended and not.",
     "Layers over the whole frame in each format, on a machine of that card's rates. Each rate is held to "
     "the "
     "first one's.",
     &color_writes,
     {},
     "512x512"},
    {"compression",
     "Compression of depths and colours",
     "Nothing is published that could be compared byte for byte: the ruler is arithmetic.",
     "Layers over the whole frame, in caches that do not hold it: the bytes that depth units and ROPs "
     "move, "
     "plain and encoded, beside closed forms. Then scenes on the default machine, with 1, 4 and 8 samples a "
     "pixel.",
     &compression,
     {"builtin:courtyard", "builtin:flag"},
     "480x270"},
    {"compressed-textures",
     "Compressed textures",
     "Nothing is published that could be compared byte for byte: the ruler is arithmetic.",
     "A frame that shows every texel of a texture once, in each format, by one core: the bytes that its "
     "texture unit asks for, beside those that a texel has. Then scenes on the default machine, with their "
     "textures compressed on load by libsquish: what moves, and by how much textures and picture differ.",
     &compressed_textures,
     {"builtin:courtyard", "builtin:flag"},
     "480x270"},
    {"traversal",
     "Traversal of triangles",
     "Lectures teach two ways (Papaioannou, Rasterization Architectures): edge walking is reasonably good "
     "unless one cares about coherent memory access, several rows at a time, positions of samples or wide "
     "hardware, and thin, elongated triangles make that worse. Nothing is published to compare cycles with: "
     "the ruler is arithmetic.",
     "Frames of one shape of triangles each, by edge functions and by edge walking, on a machine of 16 "
     "cores, "
     "8 channels and 16 tile tests a cycle, so that the rasteriser is the limit. The work is counted by a "
     "rasteriser of its own, before the frame is drawn. Then scenes on the default machine. Cycles until the "
     "pass is flushed.",
     &traversal,
     {"builtin:courtyard", "builtin:flag"},
     "256x256"},
    {"raster",
     "The end of the pipeline",
     "Nothing is published that could be compared byte for byte: the ruler is arithmetic.",
     "Layers over a frame larger than the caches, with one thing changed at a time: Hi-Z, its least depths, "
     "clear or load, blending, stencil.",
     &raster,
     {},
     "512x256"},
    {"depth-precision",
     "Depth precision",
     "Nothing is published that could be compared value for value: the ruler is exact arithmetic and the "
     "theory "
     "of rounding.",
     "Pairs of surfaces at 64 distances between the planes, in 32 steps closer to each other, in each "
     "format, "
     "standard and reversed, for planes up to a billion times apart.",
     &depth_precision,
     {},
     "256x128"},
    {"blend-drift",
     "Blending drift",
     "Nothing is published to compare with: the ruler is exact arithmetic and the theory of rounding.",
     "Ten thousand layers of unlike colours, blended by *over* with 16 alphas, in four formats.",
     &blend_drift,
     {},
     "16x16"},
    {"transparency",
     "Order-independent transparency",
     "Nothing is published to compare with: the ruler is the exact picture. An A-buffer must reach it, more "
     "layers of a k-buffer must come nearer to it, and both must be nearer than sorted draws.",
     "Panes of glass that cut through each other (`builtin:glass`), with 1 and 4 samples a pixel, on the "
     "default machine: sorted by the centres of their boxes, by k-buffers of 1, 2, 4 and 8 layers, and by an "
     "A-buffer.",
     &transparency,
     {},
     "480x300"},
    {"units",
     "Every unit by itself",
     "Nothing is published to compare with: the ruler is arithmetic.",
     "For each kind of unit a frame that it limits, whose cycles follow from its work and its parameters, "
     "and "
     "a frame that it does not limit, in which half and twice its main rate must change nothing. Predictions "
     "come from the command stream and the machine's parameters, before the frame is drawn.",
     &units,
     {},
     "128x128"},
    {"limits",
     "What limits a frame",
     "Nothing is published to compare with: the ruler is the machine itself, drawn again with one resource "
     "doubled.",
     "Frames on machines that are narrow at different places. The report of each frame, from its one run, "
     "names the doublings that it "
     "expects to gain most. Then every resource is doubled by itself, and the gains are measured.",
     &limits,
     {"builtin:cubes", "builtin:materials", "builtin:flag", "builtin:overdraw"},
     "160x90"},
    {"parameters",
     "Every parameter by itself",
     "Nothing is published to compare with: each parameter is held to what it declares of itself.",
     "Small frames on a few machines, each drawn again with one parameter changed. More of a resource shall "
     "slow no frame by more than 1 "
     "%, and every parameter shall do something somewhere.",
     &parameters,
     {"builtin:cubes", "builtin:flag", "builtin:overdraw", "builtin:fill", "builtin:quad"},
     "160x90"},
};

pipeline::RenderedFrame drawn(const traces::CommandStream& stream, const pipeline::MachineConfig& machine) {
  pipeline::RenderedFrame frame = pipeline::render_exact(stream, machine, {});
  if (!frame.figures.checks_hold())
    throw std::logic_error("the figures contradict each other\n" + pipeline::failed_checks(frame.figures));
  return frame;
}

void set_up(pipeline::MachineConfig& machine, const std::vector<std::string>& settings) {
  apply_settings(machine, settings);
  machine.check();
}

std::string figures_of(const Frame& frame) {
  pipeline::MachineConfig machine;
  set_up(machine, frame.settings);
  const pipeline::RenderedFrame rendered = drawn(*frame.stream, machine);
  return pipeline::report_json({rendered.figures, machine, rendered.image.width, rendered.image.height});
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

std::string verdict_text(const Verdict& v) {
  return fmt::format("{:<5}  {}: {:.3g}, band {:.3g} to {:.3g}", v.holds() ? "holds" : "FAILS", v.what,
                     v.value, v.least, v.most);
}

std::vector<Table> tables_of(const Result& result) {
  std::vector<Table> tables{result.table};
  tables.insert(tables.end(), result.further_tables.begin(), result.further_tables.end());
  return tables;
}

std::string table_text(const Table& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.head.size(); ++c) {
    std::size_t width = table.head[c].size();
    for (const auto& row : table.rows) width = std::max(width, row[c].size());
    widths.push_back(width);
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text = " ";
    for (std::size_t c = 0; c < cells.size(); ++c) text += " " + padded(cells[c], widths[c] + 1);
    return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  };
  std::string text = line(table.head);
  for (const auto& row : table.rows) text += line(row);
  return text;
}

std::string table_markdown(const Table& table) {
  const auto line = [](const std::vector<std::string>& cells) {
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
  };
  std::string text = line(table.head) + line(std::vector<std::string>(table.head.size(), "---"));
  for (const auto& row : table.rows) text += line(row);
  return text;
}

}  // namespace

void apply_settings(pipeline::MachineConfig& machine, const std::vector<std::string>& settings) {
  machine.begin_layer();
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    machine.set(setting.substr(0, equals), setting.substr(equals + 1), "experiment");
  }
}

std::span<const Experiment> experiments() { return kExperiments; }

bool Result::holds() const { return std::ranges::all_of(verdicts, &Verdict::holds); }

Readings::Readings(const std::string& report_json) {
  const Json report = Json::parse(report_json);
  std::map<std::string, double> sums;
  for (const auto& [name, value] : report.at("frame").items()) {
    if (value.is_number()) sums["frame." + name] = value.get<double>();
  }
  for (const auto& [path, unit] : report.at("units").items()) {
    const std::string kind(pipeline::without_number(path));
    sums[kind + ".cycles"] += unit.at("cycles").get<double>();
    sums[kind + ".busy"] += unit.at("busy").get<double>();
    for (const auto& [name, value] : unit.at("counters").items())
      sums[kind + "." + name] += value.get<double>();
  }
  if (report.contains("limit") && !report["limit"].is_null()) {
    for (const auto& [name, value] : report["limit"].at("gains").items())
      sums["gain." + name] = value.get<double>();
  }
  values_.assign(sums.begin(), sums.end());
}

double Readings::operator[](const std::string& name) const {
  const auto found = std::ranges::find(values_, name, &std::pair<std::string, double>::first);
  if (found == values_.end()) throw std::out_of_range("no reading " + name);
  return found->second;
}

double Readings::gain(const std::string& resource) const {
  const auto found = std::ranges::find(values_, "gain." + resource, &std::pair<std::string, double>::first);
  return found == values_.end() ? 0 : found->second;
}

std::vector<std::vector<double>> frame_cycles(const std::vector<traces::CommandStream>& streams,
                                              const std::vector<std::vector<std::string>>& machines,
                                              const Setting& setting) {
  // A process draws one frame: SystemC elaborates once.
  std::vector<ChildWork> works;
  for (const std::vector<std::string>& settings : machines) {
    for (const traces::CommandStream& stream : streams) {
      const auto cycles_of = [&stream, &settings] {
        pipeline::MachineConfig machine;
        set_up(machine, settings);
        return fmt::format("{}", drawn(stream, machine).figures.frame.cycles);
      };
      works.push_back({cycles_of, {.seconds = kLongestFrameSeconds}});
    }
  }
  std::vector<std::vector<double>> cycles(machines.size(), std::vector<double>(streams.size()));
  std::size_t done = 0;
  run_in_children(works, setting.jobs, [&](std::size_t i, const ChildRun& run) {
    const std::size_t m = i / streams.size(), s = i % streams.size();
    cycles[m][s] =
        std::stod(output_of(run, fmt::format("{} with {}", streams[s].name, fmt::join(machines[m], " "))));
    setting.progress(fmt::format("{} of {} frames", ++done, works.size()));
  });
  return cycles;
}

std::vector<Readings> draw(const std::vector<Frame>& frames, const Setting& setting) {
  std::vector<ChildWork> works;
  works.reserve(frames.size());
  for (const Frame& frame : frames)
    works.push_back({[&frame] { return figures_of(frame); }, {.seconds = kLongestFrameSeconds}});
  std::vector<std::string> reports(frames.size());
  std::size_t drawn = 0;
  run_in_children(works, setting.jobs, [&](std::size_t i, const ChildRun& run) {
    reports[i] =
        output_of(run, fmt::format("{} with {}", frames[i].stream->name, fmt::join(frames[i].settings, " ")));
    setting.progress(fmt::format("{} of {} frames", ++drawn, frames.size()));
  });
  return {reports.begin(), reports.end()};
}

std::string result_text(const Experiment& experiment, const Result& result) {
  std::string text = fmt::format("EXPERIMENT  {}: {}\n  published: {}\n  here: {}\n\n", experiment.name,
                                 experiment.title, experiment.published, experiment.how);
  for (const Table& table : tables_of(result)) text += table_text(table) + "\n";
  for (const Verdict& v : result.verdicts) text += "  " + verdict_text(v) + "\n";
  for (const std::string& remark : result.remarks) text += "  note: " + remark + "\n";
  return text;
}

std::string result_markdown(const Experiment& experiment, const Result& result, const std::string& picture) {
  std::string text = fmt::format("# {}\n\n**Published.** {}\n\n**Here.** {}\n\n", experiment.title,
                                 experiment.published, experiment.how);
  for (const Table& table : tables_of(result)) text += table_markdown(table) + "\n";
  for (const Verdict& v : result.verdicts) text += "- " + verdict_text(v) + "\n";
  for (const std::string& remark : result.remarks) text += "\n" + remark + "\n";
  if (!picture.empty()) text += fmt::format("\n![{}]({})\n", experiment.title, picture);
  return text + fmt::format("\nTo repeat: `quadrille experiment {}`.\n", experiment.name);
}

}  // namespace quadrille::studies::experiments
