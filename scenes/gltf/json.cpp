#include "scenes/gltf/json.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "models/base/error.h"
#include "scenes/gltf/types.h"

namespace quadrille::scenes {
namespace {

using Json = nlohmann::json;

constexpr int kMaxJsonDepth = 128;  // tinygltf's walk over unknown members is recursive
// tinygltf keeps half a kilobyte of a node, one of an accessor, two of a material, whatever they hold.
constexpr std::size_t kMaxJsonValues = std::size_t{1} << 23, kMaxJsonObjects = std::size_t{5} << 18,
                      kMaxMaterials = std::size_t{1} << 18;

/// How much a text asks of who parses it, whether or not it is JSON.
struct Extent {
  int depth = 0;           ///< deepest nesting of brackets outside strings
  std::size_t values = 1;  ///< commas and opened brackets: at least as many as there are values
  std::size_t objects = 0;
};

Extent extent_of(std::string_view text) {
  Extent extent;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      extent.depth = std::max(extent.depth, ++depth);
      ++extent.values;
      extent.objects += c == '{' ? 1 : 0;
    } else if (c == '}' || c == ']') {
      --depth;
    } else if (c == ',') {
      ++extent.values;
    }
  }
  return extent;
}

/// Takes members that are null out of a document: some exporters write them for what is absent. Counts them,
/// and says where the first was.
class NullMembers {
 public:
  void take_out(Json& value) { take_out(value, {}); }
  [[nodiscard]] std::string note() const {
    if (count_ == 0) return "";
    return fmt::format("{} is null{} and counts as absent", first_,
                       count_ > 1 ? fmt::format(", as are {} more members,", count_ - 1) : "");
  }

 private:
  /// Where the walk is; spelled only for the first one.
  struct Place {
    const Place* above = nullptr;
    std::string_view member;
    std::size_t index = 0;  ///< of an array's element, where there is no name
    [[nodiscard]] std::string text() const {
      const std::string before = above == nullptr ? "" : above->text();
      if (member.empty()) return above == nullptr ? "" : fmt::format("{}[{}]", before, index);
      return fmt::format("{}{}{}", before, before.empty() ? "" : ".", member.substr(0, kMaxShownName));
    }
  };

  void take_out(Json& value, const Place& place) {
    if (value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) take_out(value[i], {&place, {}, i});
    } else if (value.is_object()) {
      for (auto item = value.begin(); item != value.end();) {
        const Place here{&place, item.key()};
        if (item->is_null()) {
          if (count_++ == 0) first_ = here.text();
          item = value.erase(item);
        } else {
          take_out(*item, here);
          ++item;
        }
      }
    }
  }

  static constexpr std::size_t kMaxShownName = 60;
  std::size_t count_ = 0;
  std::string first_;
};

class Preparer {
 public:
  Preparer(const std::string& path, std::string_view json) : path_(path) {
    const Extent extent = extent_of(json);
    if (extent.depth > kMaxJsonDepth)
      fail("its JSON", fmt::format("is nested deeper than {}", kMaxJsonDepth));
    if (extent.values > kMaxJsonValues)
      fail("its JSON", fmt::format("has {} values; at most {} are read", extent.values, kMaxJsonValues));
    if (extent.objects > kMaxJsonObjects)
      fail("its JSON", fmt::format("has {} objects; at most {} are read", extent.objects, kMaxJsonObjects));
    try {
      root_ = Json::parse(json);
    } catch (const Json::parse_error& error) {
      fail("its JSON", fmt::format("cannot be parsed at byte {}: not JSON in UTF-8", error.byte));
    } catch (const Json::out_of_range&) { fail("its JSON", "holds a number that is too large for any type"); }
    if (!root_.is_object()) fail("its JSON", "is no object");
    nulls_.take_out(root_);
    check_version();
    make_integers(root_, false);
    check_types(path, root_);
    const auto materials = root_.find("materials");
    if (materials != root_.end() && materials->size() > kMaxMaterials)
      fail("materials:", fmt::format("there are {}; at most {} are read", materials->size(), kMaxMaterials));
  }

  PreparedJson prepare() {
    PreparedJson result;
    result.note = nulls_.note();
    for_each("buffers", [&](const Json& item, const std::string& place) {
      result.buffers.push_back(buffer(item, place));
    });
    for_each("images", [&](const Json& item, const std::string& place) {
      result.images.push_back(image(item, place));
    });
    root_.erase("buffers");
    root_.erase("images");
    give_views(result.viewless);
    if (!result.viewless.empty() && !root_.contains("bufferViews"))
      root_["bufferViews"] = Json::parse(R"([{"buffer":0,"byteLength":1}])");
    result.text = root_.dump();
    return result;
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& reason) const {
    throw user_error("{}: {} {}", path_, place, reason);
  }

  /// Before all else: a glTF 1.0 file has objects where 2.0 has arrays.
  void check_version() const {
    Json only = Json::object();
    if (root_.contains("asset")) only["asset"] = root_["asset"];
    check_types(path_, only);
    const Json& asset = only["asset"];
    const std::string version = asset["version"].get<std::string>(), least = asset.value("minVersion", "2.0");
    const bool two = version.size() > 2 && version.starts_with("2.") &&
                     version.find_first_not_of("0123456789", 2) == std::string::npos;
    if (!two) throw user_error("{}: asset.version '{}'; glTF 2.x is read", path_, version.substr(0, 40));
    if (least != "2.0")
      throw user_error("{}: asset.minVersion '{}'; glTF 2.0 is read", path_, least.substr(0, 40));
  }

  /// An integer may be written as 1.0 or 1e0; tinygltf takes only digits. Members of extensions, though, it
  /// keeps as `int`, which wraps: there the large ones become fractions, which it keeps as double. `extras`,
  /// which nobody here reads, go. The nesting is bounded by now.
  static void make_integers(Json& value, bool in_extension) {
    constexpr double kLargestExact = 9007199254740992.0, kInt = 2147483648.0;  // 2^53, 2^31
    if (value.is_object()) {
      value.erase("extras");
      for (auto& [name, item] : value.items()) make_integers(item, in_extension || name == "extensions");
    } else if (value.is_array()) {
      for (Json& item : value) make_integers(item, in_extension);
    } else if (value.is_number_float()) {
      const double number = value.get<double>(), limit = in_extension ? kInt : kLargestExact;
      if (number >= 0 && number < limit && number == std::floor(number) && !std::signbit(number)) {
        value = static_cast<std::uint64_t>(number);
      } else if (number < 0 && number > -limit && number == std::floor(number)) {
        value = static_cast<std::int64_t>(number);
      }
    } else if (value.is_number() && in_extension && !(std::abs(value.get<double>()) < kInt)) {
      value = value.get<double>();
    }
  }

  template <class Visit>
  void for_each(const char* table, const Visit& visit) const {
    const auto found = root_.find(table);
    if (found == root_.end()) return;
    if (!found->is_array()) fail(fmt::format("{}:", table), "an array is due");
    for (std::size_t i = 0; i < found->size(); ++i) {
      const std::string place = fmt::format("{}[{}]:", table, i);
      if (!(*found)[i].is_object()) fail(place, "an object is due");
      visit((*found)[i], place);
    }
  }

  std::optional<std::string> text(const Json& item, const char* member, const std::string& place) const {
    const auto found = item.find(member);
    if (found == item.end()) return std::nullopt;
    if (!found->is_string()) fail(place, fmt::format("{}: a string is due", member));
    return found->get<std::string>();
  }

  BufferSource buffer(const Json& item, const std::string& place) const {
    BufferSource result;
    const auto length = item.find("byteLength");
    if (length == item.end() || !length->is_number_unsigned() || *length == 0U)
      fail(place, "byteLength: a positive integer is due");
    result.bytes = length->get<std::uint64_t>();
    result.uri = text(item, "uri", place);
    if (result.uri && result.uri->empty()) result.uri.reset();  // so write some what has no name
    return result;
  }

  ImageSource image(const Json& item, const std::string& place) const {
    ImageSource result;
    result.name = text(item, "name", place).value_or("");
    result.uri = text(item, "uri", place);
    const auto view = item.find("bufferView");
    if (view == item.end()) return result;
    if (!view->is_number_unsigned() || view->get<std::uint64_t>() > 0x7fffffff)
      fail(place, "bufferView: an index is due");
    result.buffer_view = view->get<int>();
    return result;
  }

  void give_views(std::vector<std::size_t>& viewless) {
    const auto found = root_.find("accessors");
    if (found == root_.end() || !found->is_array()) return;
    for (std::size_t i = 0; i < found->size(); ++i) {
      Json& accessor = (*found)[i];
      if (!accessor.is_object() || accessor.contains("bufferView")) continue;
      accessor["bufferView"] = 0;
      viewless.push_back(i);
    }
  }

  std::string path_;
  Json root_;
  NullMembers nulls_;
};

}  // namespace

PreparedJson prepare_json(const std::string& path, std::string_view json) {
  return Preparer(path, json).prepare();
}

}  // namespace quadrille::scenes
