/// The figures of a frame as people and programs read them: a table for the terminal, JSON for everything
/// else.
///
/// Both walk the figures; nothing is counted here. Rates and percentages exist only in the table, computed
/// when printed. docs/figures.md explains both.
#pragma once

#include "pipeline/machine/machine_config.h"
#include "pipeline/report/figures.h"

#include <span>
#include <string>
#include <string_view>

namespace quadrille::pipeline {

inline constexpr std::string_view kFiguresSchema = "quadrille-figures-1";

/// What a report is about.
struct ReportSubject {
  const Figures& figures;
  const MachineConfig& machine;
  std::uint32_t width = 0, height = 0;  ///< of the target, in pixels
};

enum class UnitRows : std::uint8_t {
  kFolded,  ///< units of a kind (core_0, core_1, ...) share a row: means, and the spread of busy
  kAll      ///< one row each
};

/// The table, lines of at most about 130 columns, without colour.
[[nodiscard]] std::string report_table(const ReportSubject& subject, UnitRows rows = UnitRows::kFolded);
/// The JSON document, schema `kFiguresSchema`.
[[nodiscard]] std::string report_json(const ReportSubject& subject);
/// The whole machine as JSON: name, base, what was changed from the base, and every parameter. Every document
/// that says of which machine it is holds this.
[[nodiscard]] std::string machine_json(const MachineConfig& machine);
/// One line for each check that does not hold, with both sides; empty when all hold.
[[nodiscard]] std::string failed_checks(const Figures& figures);

/// `core_3` is a `core`: the name without its number.
[[nodiscard]] std::string_view without_number(std::string_view name);
/// Bytes a GPU cycle that all memory channels move together at their best, and the same a second.
[[nodiscard]] double peak_memory_bytes_per_cycle(const MachineConfig& machine);

}  // namespace quadrille::pipeline
