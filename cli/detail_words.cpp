#include "cli/detail_words.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "models/base/error.h"

namespace quadrille::cli {
namespace {

struct DetailWord {
  std::string_view word;
  bool pipeline::DetailOptions::*kept;
};
constexpr std::array<DetailWord, 6> kDetailWords{{{"draws", &pipeline::DetailOptions::draws},
                                                  {"tiles", &pipeline::DetailOptions::tiles},
                                                  {"timeline", &pipeline::DetailOptions::timeline},
                                                  {"path", &pipeline::DetailOptions::path},
                                                  {"misses", &pipeline::DetailOptions::misses},
                                                  {"textures", &pipeline::DetailOptions::textures}}};

}  // namespace

void choose_details(const std::string& words, pipeline::DetailOptions& chosen) {
  for (std::size_t at = 0; at <= words.size();) {
    const std::size_t end = std::min(words.find(',', at), words.size());
    const std::string word = words.substr(at, end - at);
    const auto* const found = std::ranges::find(kDetailWords, word, &DetailWord::word);
    if (found == kDetailWords.end())
      throw user_error("--detail: {} not in {{{}}}", word.empty() ? "an empty word" : word, kDetailNames);
    chosen.*found->kept = true;
    at = end + 1;
  }
}

}  // namespace quadrille::cli
