#include "pipeline/report/figures_document.h"

#include "models/base/error.h"
#include "pipeline/report/report.h"

#include <algorithm>
#include <array>

namespace quadrille::pipeline {

namespace {

using Json = nlohmann::ordered_json;

Json parsed(const std::string& file, std::string_view text) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::string_view before = text.substr(0, std::min(error.byte, text.size()));
    const auto line = 1 + std::ranges::count(before, '\n');
    const std::size_t start = before.rfind('\n');  // npos + 1 is 0
    throw user_error("{}:{}:{}: this is not JSON any more", file, line,
                     std::max<std::size_t>(1, before.size() - (start + 1)));
  } catch (const Json::out_of_range&) { throw user_error("{}: a number is too large", file); }
}

/// Walks down a document, and says where it is when something is missing.
class Place {
 public:
  Place(const std::string& file, const Json& here, std::string path)
      : file_(file), here_(here), path_(std::move(path)) {}

  [[nodiscard]] UserError wrong(std::string_view what) const {
    return user_error("{}: {}: {}", file_, path_.empty() ? "the document" : path_, what);
  }
  [[nodiscard]] const Json& value() const { return here_; }
  [[nodiscard]] bool has(const char* key) const { return here_.is_object() && here_.contains(key); }
  [[nodiscard]] Place at(const std::string& key) const {
    object();
    Place below(file_, here_.contains(key) ? here_[key] : kNothing, joined(key));
    if (!here_.contains(key)) throw below.wrong("missing");
    return below;
  }
  const Place& object() const { return of_kind(here_.is_object(), "an object"); }
  const Place& text() const { return of_kind(here_.is_string(), "a text"); }
  const Place& number() const { return of_kind(here_.is_number(), "a number"); }
  /// Calls `check` with every entry of an object, or of a list.
  template <class Check>
  void each(const Check& check) const {
    std::size_t index = 0;
    for (const auto& [key, entry] : here_.items())
      check(Place(file_, entry, here_.is_array() ? fmt::format("{}[{}]", path_, index++) : joined(key)));
  }
  void numbers() const {
    object().each([](const Place& entry) { entry.number(); });
  }
  const Place& list() const { return of_kind(here_.is_array(), "a list"); }

 private:
  inline static const Json kNothing;
  [[nodiscard]] std::string joined(const std::string& key) const {
    return path_.empty() ? key : path_ + "." + key;
  }
  const Place& of_kind(bool is, std::string_view kind) const {
    if (!is) throw wrong(fmt::format("{} instead of {}", here_.type_name(), kind));
    return *this;
  }

  const std::string& file_;
  const Json& here_;
  std::string path_;
};

void check_machine(const Place& machine) {
  machine.at("name").text();
  machine.at("parameters").object().each([](const Place& parameter) {
    if (parameter.value().is_structured()) throw parameter.wrong("a parameter is one value");
  });
}

void check_frame(const Place& document) {
  const Place frame = document.at("frame");
  if (frame.at("cycles").value().is_null())
    throw frame.at("cycles").wrong("null: a functional run has no cycles to compare");
  for (const char* key : {"width", "height", "cycles", "least_cycles", "clock_mhz", "memory_bytes"})
    frame.at(key).number();
  frame.numbers();
}

void check_units(const Place& units) {
  units.object().each([](const Place& unit) {
    for (const char* key : {"cycles", "busy", "waiting", "starved", "blocked", "idle", "use"})
      unit.at(key).number();
    unit.at("counters").numbers();
  });
}

void check_draw(const Place& draw) {
  draw.at("label").text();
  draw.at("cycles_in_flight").number();
  for (const char* group : {"triangles", "fragments", "texture", "bytes", "work"}) draw.at(group).numbers();
  draw.at("fragments").at("shaded").number();
  draw.at("bytes").at("memory").number();
  draw.at("limiter").at("kind").text();
  draw.at("limiter").at("work_cycles").number();
}

void check_path(const Place& path) {
  path.at("cycles").number();
  path.at("parts").list().each([](const Place& part) {
    for (const char* key : {"of", "part", "by"}) part.at(key).text();
    part.at("cycles").number();
  });
}

void check_tiles(const Place& tiles) {
  for (const char* key : {"width", "height", "tile_pixels"})
    if (!tiles.at(key).value().is_number_unsigned()) throw tiles.at(key).wrong("not a whole number");
  const auto count =
      tiles.at("width").value().get<std::uint64_t>() * tiles.at("height").value().get<std::uint64_t>();
  tiles.each([&](const Place& entry) {
    if (!entry.value().is_array()) return;
    if (entry.value().size() != count)
      throw entry.wrong(fmt::format("{} squares instead of {}", entry.value().size(), count));
    entry.each([](const Place& square) { square.number(); });
  });
}

}  // namespace

nlohmann::ordered_json read_figures(const std::string& file, std::string_view text) {
  Json json = parsed(file, text);
  const Place document(file, json, "");
  const Place schema = document.object().at("schema");
  if (schema.value() != kFiguresSchema)
    throw schema.wrong(fmt::format("{} instead of \"{}\"",
                                   schema.value().dump(-1, ' ', false, Json::error_handler_t::replace),
                                   kFiguresSchema));
  document.at("scene").text();
  document.at("fidelity").text();
  if (document.has("faster")) document.at("faster").numbers();
  check_machine(document.at("machine"));
  check_frame(document);
  check_units(document.at("units"));
  document.at("limit").at("text").text();
  document.at("limit").at("uses").numbers();
  document.at("bandwidth").object().each([](const Place& client) {
    client.at("read_bytes").number();
    client.at("write_bytes").number();
  });
  if (document.has("critical_path")) check_path(document.at("critical_path"));
  if (document.has("draws")) document.at("draws").list().each(check_draw);
  if (document.has("tiles")) check_tiles(document.at("tiles"));
  return json;
}

}  // namespace quadrille::pipeline
