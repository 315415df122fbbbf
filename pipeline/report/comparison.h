/// Two frames beside each other: what differs between their documents of figures, the largest difference
/// first. docs/report.md explains it.
#pragma once

#include <string>
#include <string_view>

namespace quadrille::pipeline {

inline constexpr std::string_view kComparisonSchema = "quadrille-comparison-1";

/// A document of figures, and how messages call it.
struct FiguresFile {
  std::string name, text;
};

/// Everything that differs, as JSON, schema `kComparisonSchema`. Throws `UserError` for a document that is
/// not one of figures.
[[nodiscard]] std::string comparison_json(const FiguresFile& a, const FiguresFile& b);
/// The same as a table of at most about 130 columns: what differs most.
[[nodiscard]] std::string comparison_table(std::string_view comparison_json);

}  // namespace quadrille::pipeline
