#include "studies/stability/finding.h"

#include <fmt/format.h>

#include <algorithm>

namespace quadrille::studies::stability {

namespace {

std::string with_unit(double value, std::string_view unit) {
  std::string text = fmt::format("{:.4g}", value);
  if (!unit.empty()) text += fmt::format(" {}", unit);
  return text;
}

}  // namespace

void Findings::equal(std::string_view what, std::uint64_t measured, std::uint64_t wanted) {
  add({std::string(what), fmt::format("{}", measured), fmt::format("= {}", wanted), measured == wanted});
}

void Findings::at_most(std::string_view what, double measured, double bound, std::string_view unit) {
  add({std::string(what), with_unit(measured, unit), "<= " + with_unit(bound, unit), measured <= bound});
}

void Findings::at_least(std::string_view what, double measured, double bound, std::string_view unit) {
  add({std::string(what), with_unit(measured, unit), ">= " + with_unit(bound, unit), measured >= bound});
}

void Findings::is(std::string_view what, std::string_view measured, std::string_view wanted) {
  add({std::string(what), std::string(measured), fmt::format("= {}", wanted), measured == wanted});
}

void Findings::note(std::string_view what, std::string measured) {
  add({std::string(what), std::move(measured), "", true});
}

bool Findings::hold() const { return std::ranges::all_of(all_, &Finding::holds); }

}  // namespace quadrille::studies::stability
