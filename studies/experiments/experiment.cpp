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
