#include "scenes/gltf/uri.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <system_error>

#include "models/base/error.h"
#include "traces/whole_file.h"

namespace quadrille::scenes {
namespace {

std::optional<unsigned> hex_digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a' + 10);
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A' + 10);
  return std::nullopt;
}

/// "%20" and its like as bytes; a lone percent sign stays, since plain names are common.
std::string percent_decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool room = text[i] == '%' && i + 2 < text.size();
    const auto high = room ? hex_digit(text[i + 1]) : std::nullopt,
               low = room ? hex_digit(text[i + 2]) : std::nullopt;
    if (high && low) {
      result += static_cast<char>(*high * 16 + *low);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

constexpr unsigned kNoDigit = 64;

constexpr std::array<unsigned char, 256> base64_digits() {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<unsigned char, 256> table{};
  table.fill(kNoDigit);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    table[static_cast<unsigned char>(kDigits[i])] = static_cast<unsigned char>(i);
  return table;
}

/// Padding may be missing; anything else that is not base64 is refused.
std::vector<std::byte> base64_decoded(std::string_view text, const std::string& place) {
  static constexpr std::array<unsigned char, 256> kDigits = base64_digits();
  std::size_t padding = 0;
  while (padding < 2 && text.ends_with('=')) text.remove_suffix(1), ++padding;
  if (text.size() % 4 == 1 || (padding > 0 && (text.size() + padding) % 4 != 0))
    throw user_error("{}: its data URI's base64 text has no valid length ({} digits, {} of padding)", place,
                     text.size(), padding);
  std::vector<std::byte> result;
  result.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned digit = kDigits[static_cast<unsigned char>(text[i])];
    if (digit == kNoDigit)
      throw user_error("{}: its data URI's base64 text has a character that is not base64, at {}", place, i);
    word = word << 6 | digit;
    if (i % 4 != 0) result.push_back(static_cast<std::byte>(word >> (6 - 2 * (i % 4)) & 0xff));
  }
  return result;
}

std::vector<std::byte> data_of(std::string_view uri, const std::string& place) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos)
    throw user_error("{}: its data URI has no comma before the data", place);
  const std::string_view head = uri.substr(0, comma);
  std::string_view text = uri.substr(comma + 1);
  std::string plain;
  if (text.find('%') != std::string_view::npos) text = plain = percent_decoded(text);
  if (head.ends_with(";base64")) return base64_decoded(text, place);
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  return {bytes, bytes + text.size()};
}

/// "http:", "file:", "c:": letters, digits, plus, minus and dots before a colon. [RFC 3986 section 3.1]
bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon == 0 || std::isalpha(static_cast<unsigned char>(uri[0])) == 0)
    return false;
  return std::ranges::all_of(uri.substr(0, colon), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
  });
}

/// Is it, links followed, neither in the folder of the scene file nor in the one that the scene file itself
/// is a link into? What cannot be followed is not there to be read.
bool follows_out(const std::filesystem::path& scene, const std::filesystem::path& file) {
  std::error_code lost;
  // Absolute first: of a relative path nothing of which exists, the canonical one stays relative.
  const auto canonical = [&lost](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path), lost);
  };
  const std::filesystem::path target = canonical(file);
  if (lost) return false;
  const auto holds = [&](const std::filesystem::path& folder) {
    const std::filesystem::path inner = target.lexically_relative(folder);
    return !inner.empty() && *inner.begin() != "..";
  };
  const std::filesystem::path beside =
      scene.has_parent_path() ? scene.parent_path() : std::filesystem::path(".");
  const std::filesystem::path named = canonical(beside);
  if (!lost && holds(named)) return false;
  const std::filesystem::path own = canonical(scene);
  return lost || !holds(own.parent_path());
}

/// At most 100 characters for an error line, without control characters.
std::string printable(std::string_view text) {
  std::string result(text.substr(0, 100));
  std::ranges::replace_if(
      result, [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return result;
}

}  // namespace

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

std::string uri_file(const std::string& scene, std::string_view uri, const std::string& place) {
  const std::string shown = printable(uri);
  if (uri.empty()) throw user_error("{}: its uri is empty", place);
  if (has_scheme(uri))
    throw user_error("{}: '{}': only data URIs and files beside the scene are read", place, shown);
  std::string name = percent_decoded(uri);
  std::ranges::replace(name, '\\', '/');  // as browsers read them, and exporters of another system write them
  if (name.find('\0') != std::string::npos)
    throw user_error("{}: '{}': a name of a file has no zero byte", place, shown);
  const std::filesystem::path relative = std::filesystem::path(name).lexically_normal();
  if (relative.is_absolute())
    throw user_error("{}: '{}': an absolute path; files lie beside the scene", place, shown);
  if (*relative.begin() == "..") throw user_error("{}: '{}': leads out of the scene's folder", place, shown);
  const std::filesystem::path file = std::filesystem::path(scene).parent_path() / relative;
  if (follows_out(scene, file))
    throw user_error("{}: '{}': a link that leads out of the scene's folder", place, shown);
  return file.string();
}

std::vector<std::byte> fetch_uri(const std::string& scene, std::string_view uri, const std::string& place,
                                 std::uint64_t max_bytes) {
  if (is_data_uri(uri)) {
    if (uri.size() / 4 * 3 > max_bytes)
      throw user_error("{}: its data URI is larger than {} bytes", place, max_bytes);
    return data_of(uri, place);
  }
  try {
    return traces::read_whole_file(uri_file(scene, uri, place), max_bytes);
  } catch (const UserError& error) {
    const std::string text = error.what();
    if (text.starts_with(place)) throw;
    throw user_error("{}: {}", place, text);
  }
}

}  // namespace quadrille::scenes
