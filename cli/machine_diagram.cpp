#include "cli/machine_diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "pipeline/machine/planned_links.h"

namespace quadrille::cli {
namespace {

using pipeline::LinkWay;
using pipeline::PlannedLink;
using pipeline::PlannedUnit;
using pipeline::Stands;

const char* stands_text(Stands stands) {
  switch (stands) {
    case Stands::kOnce: return "once";
    case Stands::kFrontEnd: return "once a geometry front end";
    case Stands::kEngine: return "once a raster engine";
    case Stands::kPartition: return "once a partition";
    case Stands::kCore: return "once a core";
    case Stands::kChannel: return "once a memory channel";
  }
  return "";
}

const char* frames_text(pipeline::Needed needed) {
  switch (needed) {
    case pipeline::Needed::kByAllFrames: return "all";
    case pipeline::Needed::kByFramesThatReadTextures: return "those that read textures";
    case pipeline::Needed::kByFramesWithStorage: return "those with storage buffers";
    case pipeline::Needed::kByFramesThatKeepDepths: return "those that keep depths";
  }
  return "";
}

const char* way_text(LinkWay way) {
  switch (way) {
    case LinkWay::kOnward: return "work, onward";
    case LinkWay::kAhead: return "what is to come";
    case LinkWay::kBack: return "answers and releases, back";
  }
  return "";
}

/// Work goes along thick arrows; dotted ones lead back.
const char* arrow(LinkWay way) {
  switch (way) {
    case LinkWay::kOnward: return "==>";
    case LinkWay::kAhead: return "-->";
    case LinkWay::kBack: return "-.->";
  }
  return "";
}

Stands stands_of(std::string_view kind) {
  return std::ranges::find(pipeline::planned_units(), kind, &PlannedUnit::kind)->stands;
}

/// How many links a wire is: one for each pair of units that it joins.
int count_of(const PlannedLink& link, const pipeline::GpuParams& gpu) {
  const Stands from = stands_of(link.from), to = stands_of(link.to);
  if (from == to) return count_of(from, gpu);
  return count_of(from, gpu) * count_of(to, gpu);
}

std::string graph() {
  std::string text = "```mermaid\nflowchart TD\n";
  for (const PlannedUnit& unit : pipeline::planned_units()) {
    const bool once = unit.stands == Stands::kOnce;
    text += fmt::format("  {}[\"{}{}\"]\n", unit.kind, unit.kind,
                        once ? "" : fmt::format("<br>{}", stands_text(unit.stands)));
  }
  // A pair of kinds that several wires of a class join has one arrow.
  std::vector<std::string> drawn;
  for (const PlannedLink& link : pipeline::planned_links()) {
    const std::string line = fmt::format("  {} {}|{}| {}\n", link.from, arrow(link.way), link.token, link.to);
    if (std::ranges::find(drawn, line) == drawn.end()) drawn.push_back(line);
  }
  for (const std::string& line : drawn) text += line;
  return text + "```\n";
}

std::string unit_table(const pipeline::GpuParams& gpu) {
  std::string text = "| unit | stands | here | frames that need it |\n|---|---|---|---|\n";
  for (const PlannedUnit& unit : pipeline::planned_units())
    text += fmt::format("| `{}` | {} | {} | {} |\n", unit.kind, stands_text(unit.stands),
                        count_of(unit.stands, gpu), frames_text(unit.needed));
  return text;
}

std::string link_table(const pipeline::MachineConfig& machine) {
  std::string text =
      "| links | from | to | token | carries | here | depth | width | latency | credit latency |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const PlannedLink& link : pipeline::planned_links()) {
    const auto value = [&](const char* parameter) {
      return machine.find(fmt::format("link.{}.{}", link.name, parameter))->value_text();
    };
    text += fmt::format("| `{}` | {} | {} | `{}` | {} | {} | {} | {} | {} | {} |\n", link.name, link.from,
                        link.to, link.token, way_text(link.way), count_of(link, machine.gpu), value("depth"),
                        value("width"), value("latency"), value("credit_latency"));
  }
  return text;
}

}  // namespace

std::string machine_diagram(const pipeline::MachineConfig& machine) {
  return fmt::format(
      "# The machine as a block diagram\n\n"
      "Every kind of unit and every class of links of the machine plan (`pipeline/machine/machine_plan.h`), "
      "as `quadrille describe machine --diagram` writes them.\n"
      "The map in [architecture](architecture.md) is drawn by hand and leaves out what would hide the main "
      "way. Work goes along thick arrows. A thin one tells of work\n"
      "that comes another way, dotted ones lead back. An arrow bears the token that its links carry "
      "(`hw/frame/tokens.h`).\n\n"
      "{}\n"
      "## Units\n\n\"Here\" is the machine {}.\n\n{}\n"
      "## Links\n\n"
      "Depth is in tokens, width in tokens a cycle, latencies are in cycles; [parameters](parameters.md) "
      "says "
      "what they mean. Clients of the L2 cache have a link each way for\n"
      "each slice; those of depth units are left out where no draw tests depth. `memory_to_l2` also bears "
      "`memory.path_clk`.\n\n{}",
      graph(), machine.name, unit_table(machine.gpu), link_table(machine));
}

}  // namespace quadrille::cli
