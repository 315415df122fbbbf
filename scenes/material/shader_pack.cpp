#include "scenes/material/shader_pack.h"

#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace quadrille::scenes {
namespace {

constexpr std::size_t kEntryWords = 4;

}  // namespace

std::string shader_key(traces::ShaderStage stage, const std::vector<std::string>& defines) {
  return fmt::format("{}:{}", stage == traces::ShaderStage::kVertex ? "vert" : "frag",
                     fmt::join(defines, ";"));
}

std::vector<std::uint32_t> write_shader_pack(
    const std::map<std::string, std::vector<std::uint32_t>>& shaders) {
  std::string keys;
  for (const auto& [key, words] : shaders) keys += key;
  const std::size_t first_key = 1 + kEntryWords * shaders.size();
  std::vector<std::uint32_t> pack{static_cast<std::uint32_t>(shaders.size())};
  std::size_t key_byte = 4 * first_key, word = first_key + (keys.size() + 3) / 4;
  for (const auto& [key, words] : shaders) {
    for (const std::size_t value : {key_byte, key.size(), word, words.size()})
      pack.push_back(static_cast<std::uint32_t>(value));
    key_byte += key.size();
    word += words.size();
  }
  pack.resize(first_key + (keys.size() + 3) / 4);
  std::memcpy(pack.data() + first_key, keys.data(), keys.size());
  for (const auto& [key, words] : shaders) pack.insert(pack.end(), words.begin(), words.end());
  return pack;
}

std::string_view ShaderPack::key(std::size_t i) const {
  const std::uint32_t* const entry = words_ + 1 + kEntryWords * i;
  return {reinterpret_cast<const char*>(words_) + entry[0], entry[1]};
}

std::span<const std::uint32_t> ShaderPack::shader(std::size_t i) const {
  const std::uint32_t* const entry = words_ + 1 + kEntryWords * i;
  return {words_ + entry[2], entry[3]};
}

std::span<const std::uint32_t> ShaderPack::find(std::string_view key) const {
  std::size_t from = 0, to = size();
  while (from < to) {
    const std::size_t middle = from + (to - from) / 2;
    if (this->key(middle) < key) from = middle + 1;
    else to = middle;
  }
  return from < size() && this->key(from) == key ? shader(from) : std::span<const std::uint32_t>();
}

}  // namespace quadrille::scenes
