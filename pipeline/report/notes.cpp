#include "pipeline/report/notes.h"

#include "pipeline/report/unit_facets.h"

#include <fmt/format.h>

namespace quadrille::pipeline {

namespace {

/// "3 off screen, 2 culled": the counts that are not zero.
std::string counted(const std::vector<std::pair<std::uint64_t, const char*>>& counts) {
  std::string text;
  for (const auto& [count, what] : counts) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", grouped(count), what);
  }
  return text;
}

std::string why_nothing(const FrameFigures& f) {
  const Fates& fates = f.fates;
  if (f.draws == 0) return "the frame has no draws; has the scene a mesh with positions, and is it shown?";
  if (f.triangles == 0) return fmt::format("the {} draws of the frame have no triangles", grouped(f.draws));
  if (f.fragments_shaded > 0) {
    return "no fragment passed: " + counted({{fates.discarded, "discarded by their shader"},
                                             {fates.hidden, "killed by the depth test"}});
  }
  if (fates.hidden + fates.tiles_hidden > 0) return "every fragment failed the depth test";
  return "no triangle covers a pixel: " +
         counted({{fates.off_screen, "off screen"},
                  {fates.culled, "culled by their facing"},
                  {fates.no_area, "without area"},
                  {fates.no_sample + fates.rasterised, "between pixel centres"},
                  {fates.not_finite, "with positions that are NaN or infinite"}});
}

}  // namespace

std::vector<std::string> notes_on(const Figures& figures) {
  std::vector<std::string> notes;
  if (figures.frame.fragments_written == 0)
    notes.push_back("nothing was drawn: " + why_nothing(figures.frame));
  for (const std::string& program : figures.order_dependent)
    notes.push_back(
        fmt::format("program {}: its outputs depend on what atomic operations returned, so on the "
                    "order of warps; timing may change what it draws",
                    program));
  for (const auto& [kind, times] : figures.faster)
    notes.push_back(fmt::format("{}: {:g} times as fast as the machine has it", kind, times));
  return notes;
}

}  // namespace quadrille::pipeline
