/// The figures of a frame as a page that a browser shows: one file that needs nothing else, not even a
/// network.
///
/// The page is a program of its own (pipeline/report/page/, built by npm and part of this program). It is
/// handed data as JSON and shows them; nothing is counted or computed for it here. docs/report.md explains
/// it.
#pragma once

#include "pipeline/report/report.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::pipeline {

/// What the page shows beside the figures.
struct PagePictures {
  std::vector<std::byte> frame, depth;  ///< files of PNG; an empty one is not shown
  /// as `draws_by_square` lists them
  std::vector<std::vector<std::uint32_t>> draws;
};

/// The page of a frame. `figures_json` is what `report_json` made of the same frame.
[[nodiscard]] std::string report_page(const ReportSubject& subject, std::string_view figures_json,
                                      const PagePictures& pictures);
/// The page of two frames beside each other (comparison.h).
[[nodiscard]] std::string comparison_page(std::string_view title, std::string_view comparison_json);

/// The page of a row of frames (frames_output.h).
[[nodiscard]] std::string page_of_frames(std::string_view title, std::string_view frames_json);
/// The page of a sweep over machines (studies/explore/explore_page.h).
[[nodiscard]] std::string page_of_sweep(std::string_view title, std::string_view sweep_json);
/// A file of PNG as an address that holds it; empty for none.
[[nodiscard]] std::string png_data_uri(std::span<const std::byte> png);

/// What the page knows of a machine beyond its figures: kinds of units and the links between them, as the
/// machine plan has them, and unit, legal values and reason of every parameter.
[[nodiscard]] std::string plan_json(const MachineConfig& machine);

/// A JSON document as it may stand between the tags of a script: without the spaces between its words, and
/// with no character that a reader of HTML or JavaScript would take for the end of anything. It reads back
/// as the same document.
[[nodiscard]] std::string json_for_script(std::string_view json);
/// A text as it may stand in HTML, between tags or quotes.
[[nodiscard]] std::string text_for_html(std::string_view text);

}  // namespace quadrille::pipeline
