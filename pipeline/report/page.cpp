#include "pipeline/report/page.h"

#include "models/base/error.h"
#include "pipeline/machine/planned_links.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <span>
#include <utility>

/// The page without its data: what build.mjs made of pipeline/report/page/ (page_template.S.in).
extern "C" const char quadrille_page_template[], quadrille_page_template_end[];

namespace quadrille::pipeline {

namespace {

using Json = nlohmann::ordered_json;

const char* way_name(LinkWay way) {
  switch (way) {
    case LinkWay::kOnward: return "onward";
    case LinkWay::kAhead: return "ahead";
    case LinkWay::kBack: return "back";
  }
  return "";
}

std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (at + i < bytes.size() ? std::to_integer<std::uint32_t>(bytes[at + i]) : 0);
    for (std::size_t i = 0; i < 4; ++i)
      text += at + i <= bytes.size() ? kDigits[group >> (18 - 6 * i) & 63] : '=';
  }
  return text;
}

/// A block of data, and the name under which the page looks for it.
using Block = std::pair<std::string_view, std::string>;

std::string filled(std::string_view title, std::initializer_list<Block> blocks) {
  constexpr std::string_view kTitle = "<!--title-->", kBlocks = "<!--blocks-->";
  const std::string_view page(quadrille_page_template, quadrille_page_template_end);
  const std::size_t title_at = page.find(kTitle), blocks_at = page.find(kBlocks);
  QUADRILLE_CHECK(title_at < blocks_at && blocks_at != std::string_view::npos, "page: no place for its data");
  std::string text(page.substr(0, title_at));
  text += text_for_html(title);
  text += page.substr(title_at + kTitle.size(), blocks_at - title_at - kTitle.size());
  for (const auto& [id, json] : blocks)
    text += fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, json);
  return text.append(page.substr(blocks_at + kBlocks.size()));
}

/// What a character of a string of JSON is written as where it could be taken for something else; empty
/// where it stays. `text` begins with the character.
std::string_view escape(std::string_view text) {
  switch (text.front()) {
    case '<': return "\\u003c";
    case '>': return "\\u003e";
    case '&': return "\\u0026";
    default: break;  // of any char
  }
  if (text.starts_with("\xe2\x80\xa8")) return "\\u2028";
  if (text.starts_with("\xe2\x80\xa9")) return "\\u2029";
  return "";
}

}  // namespace

std::string png_data_uri(std::span<const std::byte> png) {
  return png.empty() ? "" : "data:image/png;base64," + base64(png);
}

std::string json_for_script(std::string_view json) {
  std::string out;
  out.reserve(json.size());
  bool in_string = false;
  for (std::size_t at = 0; at < json.size(); ++at) {
    const char c = json[at];
    if (!in_string) {
      in_string = c == '"';
      if (c != ' ' && c != '\n') out += c;
      continue;
    }
    const std::string_view escaped = escape(json.substr(at));
    if (!escaped.empty()) {
      out += escaped;
      if (c == '\xe2') at += 2;  // of three bytes
      continue;
    }
    out += c;
    if (c == '\\' && at + 1 < json.size()) out += json[++at];
    else in_string = c != '"';
  }
  return out;
}

std::string text_for_html(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

std::string plan_json(const MachineConfig& machine) {
  Json units = Json::array(), links = Json::array(), parameters = Json::object();
  for (const PlannedUnit& unit : planned_units())
    units.push_back({{"kind", unit.kind}, {"count", count_of(unit.stands, machine.gpu)}});
  for (const PlannedLink& link : planned_links())
    links.push_back({{"name", link.name},
                     {"from", link.from},
                     {"to", link.to},
                     {"token", link.token},
                     {"way", way_name(link.way)}});
  for (const auto& [path, group] : machine.groups())
    for (const hw::ParamBase* p : group->params())
      parameters[path + "." + std::string(p->name())] = {
          {"unit", p->unit()}, {"legal", p->legal_text()}, {"reason", p->reason()}};
  const Json all = {{"units", std::move(units)},
                    {"links", std::move(links)},
                    {"peak_memory_bytes_per_cycle", peak_memory_bytes_per_cycle(machine)},
                    {"parameters", std::move(parameters)}};
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string report_page(const ReportSubject& subject, std::string_view figures_json,
                        const PagePictures& pictures) {
  const Json shown = {{"frame", png_data_uri(pictures.frame)}, {"depth", png_data_uri(pictures.depth)}};
  return filled(subject.figures.scene + " - Quadrille",
                {{"figures", json_for_script(figures_json)},
                 {"plan", json_for_script(plan_json(subject.machine))},
                 {"pictures", shown.dump()},
                 {"squares", Json(pictures.draws).dump()}});
}

std::string page_of_frames(std::string_view title, std::string_view frames_json) {
  return filled(std::string(title) + " - Quadrille", {{"frames", json_for_script(frames_json)}});
}

std::string page_of_sweep(std::string_view title, std::string_view sweep_json) {
  return filled(std::string(title) + " - Quadrille", {{"sweep", json_for_script(sweep_json)}});
}

std::string comparison_page(std::string_view title, std::string_view comparison_json) {
  return filled(title, {{"comparison", json_for_script(comparison_json)}});
}

}  // namespace quadrille::pipeline
