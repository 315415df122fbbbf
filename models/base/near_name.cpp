#include "models/base/near_name.h"

#include <fmt/format.h>

#include <algorithm>

namespace quadrille {
namespace {

// what is longer is no name of ours with a slip in it
constexpr std::size_t kMaxNames = 3, kMaxLetters = 100;

char small(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// What follows the last dot.
std::string_view last_part(std::string_view name) { return name.substr(name.rfind('.') + 1); }

/// "gpu.cores" ends in "cores"; of what has a dot itself, the whole must be alike.
std::size_t distance(std::string_view typed, std::string_view name) {
  const std::size_t whole = letters_apart(typed, name);
  if (typed.find('.') != std::string_view::npos || name.find('.') == std::string_view::npos) return whole;
  return std::min(whole, letters_apart(typed, last_part(name)));
}

}  // namespace

std::size_t letters_apart(std::string_view a, std::string_view b) {
  // Rows of the usual table: the distances of a[0..i) from every b[0..j), for this i and the two before it.
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (small(a[i - 1]) == small(b[j - 1]) ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped =
          i > 1 && j > 1 && small(a[i - 1]) == small(b[j - 2]) && small(a[i - 2]) == small(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::vector<std::string> near_names(std::string_view typed, std::span<const std::string> names) {
  if (typed.empty() || typed.size() > kMaxLetters) return {};
  std::vector<std::string> nearest;
  std::size_t least = std::max<std::size_t>(1, typed.size() / 3);
  for (const std::string& name : names) {
    const std::size_t d = distance(typed, name);
    if (d < least) nearest.clear();
    if (d > least) continue;
    least = d;
    if (nearest.size() < kMaxNames && std::ranges::find(nearest, name) == nearest.end())
      nearest.push_back(name);
  }
  return nearest;
}

std::string did_you_mean(std::string_view typed, std::span<const std::string> names) {
  const std::vector<std::string> near = near_names(typed, names);
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", fmt::join(near, "' or '"));
}

}  // namespace quadrille
