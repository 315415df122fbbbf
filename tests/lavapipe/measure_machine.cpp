#include "tests/lavapipe/measure_machine.h"

#include <fmt/format.h>

#include "studies/experiments/experiment.h"

namespace quadrille::lavapipe {
namespace {

using studies::experiments::Readings;

PassStatistics statistics_of(const Readings& r) {
  const auto count = [&](const char* name) { return static_cast<std::uint64_t>(r[name]); };
  return {.input_vertices = count("vertex_fetch.indices"),
          .input_primitives = count("vertex_fetch.triangles"),
          .vertex_invocations = count("core.vertices"),
          .clipping_invocations = count("clipper.triangles"),
          .clipping_primitives = count("clipper.passed") + count("clipper.pieces"),
          .fragment_invocations = count("core.fragments"),
          .samples_passed = count("rop.samples_written")};
}

}  // namespace

Measurement simulate_all(const std::vector<MeasuredExperiment>& experiments,
                         const std::vector<std::string>& settings, int jobs,
                         const std::function<void(const std::string&)>& progress) {
  Measurement measurement;
  measurement.device = settings.empty()
                           ? "default machine, simulated"
                           : fmt::format("default machine with {}, simulated", fmt::join(settings, ", "));
  measurement.driver = "Quadrille";
  measurement.time_unit = "clk";
  studies::experiments::Setting setting;
  setting.jobs = jobs;
  for (const MeasuredExperiment& e : experiments) {
    setting.progress = [&](const std::string& text) { progress(e.name + ": " + text); };
    std::vector<traces::CommandStream> streams;
    streams.reserve(e.points.size());
    for (const Point& p : e.points) streams.push_back(p.stream());
    std::vector<studies::experiments::Frame> frames;
    frames.reserve(streams.size());
    for (const traces::CommandStream& stream : streams) frames.push_back({&stream, settings});
    const std::vector<Readings> read = studies::experiments::draw(frames, setting);
    measurement.curves.push_back({e.name, e.axis, {}});
    for (std::size_t i = 0; i < read.size(); ++i)
      measurement.curves.back().points.push_back(
          {e.points[i].name, e.points[i].x, {read[i]["frame.render_cycles"]}, statistics_of(read[i])});
  }
  return measurement;
}

}  // namespace quadrille::lavapipe
