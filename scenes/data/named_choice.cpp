#include "scenes/data/named_choice.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

namespace quadrille::scenes {

std::optional<std::size_t> find_choice(const std::vector<std::string>& names, const std::string& choice) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), number);
  if (error == std::errc{} && end == choice.data() + choice.size())
    return number < names.size() ? std::optional(number) : std::nullopt;
  const auto found = std::ranges::find(names, choice);
  return found == names.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - names.begin()));
}

std::string list_of_choices(const std::vector<std::string>& names) {
  constexpr std::size_t kListed = 20, kNameLength = 40;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kListed); ++i) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", i);
    if (!names[i].empty()) text += fmt::format(" '{}'", names[i].substr(0, kNameLength));
  }
  return names.size() > kListed ? text + ", ..." : names.empty() ? "none" : text;
}

}  // namespace quadrille::scenes
