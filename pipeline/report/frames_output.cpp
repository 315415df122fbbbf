#include "pipeline/report/frames_output.h"

#include "pipeline/report/csv_field.h"
#include "pipeline/report/page.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace quadrille::pipeline {

namespace {

using Json = nlohmann::ordered_json;

/// What the page shows of a frame; its units and counters stay in the document.
Json shown(const Json& frame) {
  const Json& figures = frame["figures"];
  Json limit;
  for (const char* key : {"kind", "name", "share", "text"}) limit[key] = figures["limit"][key];
  return {{"frame", frame["frame"]},           {"time_s", frame["time_s"]},   {"turn", frame["turn"]},
          {"overlapped", frame["overlapped"]}, {"figures", figures["frame"]}, {"notes", figures["notes"]},
          {"bandwidth", figures["bandwidth"]}, {"limit", std::move(limit)}};
}

/// Places in `pictures` that are shown: all, or as many as fit, evenly spaced, and the slowest frame's.
std::vector<std::size_t> chosen(const FramePictures& pictures, std::int64_t slowest) {
  for (std::size_t step = 1; step <= pictures.size(); step *= 2) {
    std::vector<std::size_t> places;
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      if (i % step != 0 && pictures[i].first != slowest) continue;
      places.push_back(i);
      bytes += pictures[i].second.size();
    }
    if (bytes <= kMostPictureBytes) return places;
  }
  return {};
}

/// The number of the frame that takes most cycles.
std::int64_t slowest_of(const Json& frames) {
  std::int64_t slowest = -1, most = -1;
  for (const Json& frame : frames) {
    const std::int64_t cycles = frame["figures"]["frame"]["cycles"];
    if (cycles <= most) continue;
    most = cycles;
    slowest = frame["frame"];
  }
  return slowest;
}

class Row {
 public:
  void add(std::string_view text) { text_ += (text_.empty() ? "" : ",") + csv_field(std::string(text)); }
  void add_value(const Json& value) {
    add(value.is_string() ? value.get<std::string>() : value.is_null() ? std::string() : value.dump());
  }
  [[nodiscard]] std::string text() const { return text_ + "\r\n"; }

 private:
  std::string text_;
};

/// Calls `visit(name, value)` for every column of a frame's row.
template <class Visit>
void visit_columns(const Json& frame, const Visit& visit) {
  const Json& figures = frame["figures"];
  for (const char* key : {"frame", "time_s", "turn"}) visit(key, frame[key]);
  for (const auto& [key, value] : figures["frame"].items()) {
    if (!value.is_structured()) visit(key, value);
  }
  for (const auto& [client, moved] : figures["bandwidth"].items())
    for (const auto& [key, bytes] : moved.items()) visit(client + "_" + key, bytes);
  const Json& limit = figures["limit"];
  visit("limit", limit.is_null() ? Json(nullptr) : limit["name"]);
  visit("limit_share", limit.is_null() ? Json(nullptr) : limit["share"]);
}

/// Names of all columns, in the order in which they first come: a frame without texture units has no bytes of
/// theirs.
std::vector<std::string> columns_of(const Json& frames) {
  std::vector<std::string> names;
  for (const Json& frame : frames) {
    visit_columns(frame, [&](const std::string& name, const Json&) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    });
  }
  return names;
}

}  // namespace

std::string frames_page(std::string_view frames_json, const FramePictures& pictures) {
  const Json document = Json::parse(frames_json);
  const std::int64_t slowest = slowest_of(document["frames"]);
  Json page = {
      {"scene", document["scene"]}, {"cycles", document["cycles"]}, {"animation_s", document["animation_s"]},
      {"notes", document["notes"]}, {"machine", nullptr},           {"fidelity", nullptr},
      {"frames", Json::array()},    {"pictures", Json::object()}};
  for (const Json& frame : document["frames"]) {
    page["frames"].push_back(shown(frame));
    page["fidelity"] = frame["figures"]["fidelity"];
    for (const char* key : {"name", "base", "changed"})
      page["machine"][key] = frame["figures"]["machine"][key];
  }
  for (const std::size_t place : chosen(pictures, slowest))
    page["pictures"][std::to_string(pictures[place].first)] = png_data_uri(pictures[place].second);
  return page_of_frames(document["scene"].get<std::string>(), page.dump());
}

std::string frames_csv(std::string_view frames_json) {
  const Json document = Json::parse(frames_json);
  const std::vector<std::string> columns = columns_of(document["frames"]);
  Row head;
  for (const std::string& name : columns) head.add(name);
  std::string text = head.text();
  for (const Json& frame : document["frames"]) {
    Json values = Json::object();
    visit_columns(frame, [&](const std::string& name, const Json& value) { values[name] = value; });
    Row row;
    for (const std::string& name : columns)
      row.add_value(values.contains(name) ? values[name] : Json(nullptr));
    text += row.text();
  }
  return text;
}

}  // namespace quadrille::pipeline
