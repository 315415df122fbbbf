/// The figures of a frame as a flat table: for spreadsheets, and for programs that do not read JSON.
#pragma once

#include <string>
#include <string_view>

namespace quadrille::pipeline {

/// CSV [RFC 4180]: a line for every value of the document that `report_json` wrote, with its path, the value
/// and, of counters, its unit. A list has a line for each of its entries, `draws[3].fragments.shaded`.
[[nodiscard]] std::string figures_csv(std::string_view figures_json);

}  // namespace quadrille::pipeline
