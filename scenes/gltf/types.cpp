#include "scenes/gltf/types.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "models/base/error.h"
#include "scenes/gltf/type_rules.h"

namespace quadrille::scenes {
namespace {

using Json = nlohmann::json;
using namespace schema;

const char* due(Type type) {
  switch (type) {
    case Type::kAny: return "anything";
    case Type::kObject: return "an object";
    case Type::kArray: return "an array";
    case Type::kIndex: return "an integer of 0 or more";
    case Type::kInt: return "an integer of 0 to 2147483647";
    case Type::kNumber: return "a number";
    case Type::kStride: return "a multiple of 4 from 4 to 252";
    case Type::kString: return "a string";
    case Type::kBool: return "true or false";
    case Type::kTwo: return "an array of 2 numbers";
    case Type::kThree: return "an array of 3 numbers";
    case Type::kFour: return "an array of 4 numbers";
    case Type::kSixteen: return "an array of 16 numbers";
  }
  return "";
}

bool numbers(const Json& value, std::size_t count) {
  return value.is_array() && value.size() == count &&
         std::ranges::all_of(value, [](const Json& v) { return v.is_number(); });
}

/// Members of extensions beyond 31 bits have been made fractions (gltf_json.cpp).
bool is_large_integer(const Json& value) {
  if (!value.is_number_float()) return false;
  const double number = value.get<double>();
  return number >= 0 && number < 9007199254740992.0 && number == std::floor(number);
}

bool is(const Json& value, Type type) {
  switch (type) {
    case Type::kAny: return true;
    case Type::kObject: return value.is_object();
    case Type::kArray: return value.is_array();
    case Type::kIndex: return value.is_number_unsigned() || is_large_integer(value);
    // tinygltf keeps it as an int
    case Type::kInt: return value.is_number_unsigned() && value.get<std::uint64_t>() <= 0x7fffffff;
    case Type::kNumber: return value.is_number();
    case Type::kStride:
      return value.is_number_unsigned() && value.get<std::uint64_t>() <= 252 &&
             value.get<std::uint64_t>() % 4 == 0;  // 0 is written for none
    case Type::kString: return value.is_string();
    case Type::kBool: return value.is_boolean();
    case Type::kTwo: return numbers(value, 2);
    case Type::kThree: return numbers(value, 3);
    case Type::kFour: return numbers(value, 4);
    case Type::kSixteen: return numbers(value, 16);
  }
  return true;
}

/// Visits the words of a text with a blank between two.
template <class Visit>
void for_each_word(std::string_view text, const Visit& visit) {
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find(' ', from), text.size());
    visit(text.substr(from, to - from));
    from = to + 1;
  }
}

/// What is due at a place of the document, and below it.
struct Due {
  Type type = Type::kAny;
  std::string_view legal, table;            ///< as in a rule
  std::map<std::string_view, Due> members;  ///< of an object
  std::vector<std::string_view> required;   ///< of these
  std::unique_ptr<Due> each;                ///< of an array's elements, or of all members of an object

  void add(const Rule& rule) {
    for_each_word(rule.paths, [&](std::string_view path) {
      const std::size_t arrow = std::min(path.find('>'), path.size());
      Due& due = at(path.substr(0, arrow));
      due.type = rule.type;
      due.legal = rule.legal;
      due.table = path.substr(std::min(arrow + 1, path.size()));
    });
  }

  /// What is due at this path, which begins here.
  Due& at(std::string_view path) {
    if (path.empty()) return *this;
    if (path.starts_with("[]")) {
      type = Type::kArray;
      return below().at(path.substr(path.starts_with("[].") ? 3 : 2));
    }
    type = Type::kObject;
    if (path == "*") return below();
    const std::size_t end = std::min(path.find_first_of(".[!"), path.size());
    const std::string_view name = path.substr(0, end), rest = path.substr(end);
    if (rest == "!") required.push_back(name);
    return members[name].at(rest == "!" ? "" : rest.substr(rest.starts_with('.') ? 1 : 0));
  }

 private:
  Due& below() {
    if (!each) each = std::make_unique<Due>();
    return *each;
  }
};

Due due_of_rules() {
  Due root;
  for (const Rule& rule : kRules) root.add(rule);
  Due& material = root.at("materials[]");
  for_each_word(kTextureInfos, [&](std::string_view info) {
    for (const Rule& rule : kTextureInfoRules) material.at(info).add(rule);
  });
  return root;
}

/// Of the `extensions` of any object: all are objects. [glTF2.0 #specifying-extensions]
Due due_of_extensions() {
  Due due;
  due.at("*").type = Type::kObject;
  return due;
}

constexpr std::size_t kMaxShownName = 60;

/// Where the walk is; spelled only when something is wrong there.
struct Place {
  const Place* above = nullptr;
  std::string_view member;
  std::optional<std::size_t> index = {};  ///< of an array's element, instead of the name

  [[nodiscard]] std::string text() const {
    if (above == nullptr) return "";
    const std::string before = above->text();
    if (index) return fmt::format("{}[{}]", before, *index);
    return fmt::format("{}{}{}", before, before.empty() ? "" : ".", member.substr(0, kMaxShownName));
  }
};

/// "mesh" for "meshes", "light" for "extensions.KHR_lights_punctual.lights".
std::string_view noun(std::string_view table) {
  table.remove_prefix(table.rfind('.') + 1);
  table.remove_suffix(table == "meshes" ? 2 : 1);
  return table;
}

class Check {
 public:
  Check(const std::string& path, const Json& root) : path_(path), root_(root) {}

  void value(const Json& value, const Due& wanted, const Place& place) const {
    if (!is(value, wanted.type)) fail(place, wanted);
    if (!wanted.legal.empty() && !among(value, wanted.legal)) fail(place, wanted);
    if (!wanted.table.empty()) index(value, wanted.table, place);
    if (value.is_array() && wanted.each) {
      for (std::size_t i = 0; i < value.size(); ++i) this->value(value[i], *wanted.each, {&place, {}, i});
    }
    if (value.is_object()) members(value, wanted, place);
  }

  /// A camera has the part that its type names; a spot light has its cone.
  void parts() const {
    const Json* const lights = below(&root_, "extensions.KHR_lights_punctual.lights");
    for (const Json* table : {below(&root_, "cameras"), lights}) {
      for (std::size_t i = 0; table != nullptr && i < table->size(); ++i) {
        const Json& item = (*table)[i];
        const std::string part = item.at("type").get<std::string>();
        if ((table != lights || part == "spot") && !item.contains(part))
          throw user_error("{}: {}[{}].{}: is missing; an object is due", path_,
                           table == lights ? "extensions.KHR_lights_punctual.lights" : "cameras", i, part);
      }
    }
  }

 private:
  void members(const Json& object, const Due& wanted, const Place& place) const {
    static const Due kExtensions = due_of_extensions();
    for (auto item = object.begin(); item != object.end(); ++item) {
      const auto known = wanted.members.find(item.key());
      const Place here{&place, item.key()};
      if (item.key() == "extensions" && !wanted.members.empty()) value(*item, kExtensions, here);
      if (known != wanted.members.end()) value(*item, known->second, here);
      else if (wanted.each) value(*item, *wanted.each, here);
    }
    for (const std::string_view name : wanted.required) {
      if (!object.contains(name)) fail({&place, name}, wanted.members.at(name), "is missing; ");
    }
  }

  static bool among(const Json& value, std::string_view legal) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    bool found = false;
    for_each_word(legal, [&](std::string_view word) { found = found || word == text; });
    return found;
  }

  /// The member of an object at a path of names with dots; null where one is missing.
  static const Json* below(const Json* object, std::string_view path) {
    while (object != nullptr) {
      const std::size_t dot = path.find('.');
      const auto found = object->find(path.substr(0, dot));
      object = found == object->end() ? nullptr : &*found;
      if (dot == std::string_view::npos) break;
      path.remove_prefix(dot + 1);
    }
    return object;
  }

  /// The element of a table of the root in which the place lies.
  const Json& item_around(const Place& place) const {
    const Place* item = &place;
    while (item->above->above->above != nullptr) item = item->above;
    return root_.at(item->above->member)[item->index.value_or(0)];
  }

  void index(const Json& value, std::string_view table, const Place& place) const {
    const bool own = table.starts_with('.');
    const Json* const into = own ? below(&item_around(place), table.substr(1)) : below(&root_, table);
    if (into == nullptr ? own : !into->is_array()) return;  // which is refused where it stands
    const std::size_t size = into == nullptr ? 0 : into->size();
    if (value.get<std::uint64_t>() >= size)
      throw user_error("{}: {}: {} {} does not exist (the {} has {})", path_, place.text(), noun(table),
                       value.get<std::uint64_t>(), own ? "animation" : "file", size);
  }

  [[noreturn]] void fail(const Place& place, const Due& wanted, const char* missing = "") const {
    if (wanted.legal.empty())
      throw user_error("{}: {}: {}{} is due", path_, place.text(), missing, due(wanted.type));
    std::string legal;
    for_each_word(wanted.legal,
                  [&](std::string_view word) { legal += (legal.empty() ? "" : ", ") + std::string(word); });
    throw user_error("{}: {}: {}one of {} is due", path_, place.text(), missing, legal);
  }

  const std::string& path_;
  const Json& root_;
};

}  // namespace

void check_types(const std::string& path, const nlohmann::json& root) {
  static const Due kDue = due_of_rules();
  const Check check(path, root);
  check.value(root, kDue, {});
  check.parts();
}

}  // namespace quadrille::scenes
