/// What the catalogue's results look like: a table for the terminal, JSON, a page of docs/ and a page of
/// pictures.
#pragma once

#include "studies/stability/stability.h"

#include <string>

namespace quadrille::studies::stability {

/// Rows of one case: its verdict and cost, what limits its frame, and its findings: what holds in one line
/// together unless `all`.
[[nodiscard]] std::string case_text(const CaseResult& result, bool all);
/// "38 of 40 cases hold", with the names of those that do not.
[[nodiscard]] std::string verdict_text(std::span<const CaseResult> results);
[[nodiscard]] std::string results_json(std::span<const CaseResult> results);
/// docs/stability.md. `pictures` is the folder of the pictures as the page refers to it, with its '/'.
[[nodiscard]] std::string results_markdown(std::span<const CaseResult> results, const std::string& pictures);
/// A page to open in a browser, beside the pictures.
[[nodiscard]] std::string contact_html(std::span<const CaseResult> results);

inline constexpr std::string_view kStabilitySchema = "quadrille-stability-1";

}  // namespace quadrille::studies::stability
