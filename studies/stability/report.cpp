#include "studies/stability/report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace quadrille::studies::stability {

namespace {

using Json = nlohmann::ordered_json;

// findings of `check_always`, which lead each case's own; the memory is the last
constexpr std::size_t kAlways = 6;

/// What every case must hold to and does is worth no row of its own.
bool is_usual(const CaseResult& result, std::size_t i) {
  return (i < kAlways || i + 1 == result.findings.all().size()) && result.findings.all()[i].holds;
}

std::string verdict(const CaseResult& result) {
  if (result.run.end != ChildEnd::kDone) return std::string(child_end_name(result.run.end));
  return result.findings.hold() ? "holds" : "DOES NOT HOLD";
}

std::string html(std::string_view text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? std::string("&lt;") : c == '&' ? std::string("&amp;") : std::string(1, c);
  return out;
}

constexpr std::string_view kPageHead = R"(# Stiff and extreme

A catalogue of frames at the edge of what numbers, and machines at the edge of what hardware, can be. `quadrille stability` runs it; this page is its result,
written by `scripts/pages stability`.

    quadrille stability                       # all cases; exit code 1 if anything does not hold
    quadrille stability 'w-*' 'latency-*'     # those that match
    quadrille stability --list                # names and purposes
    quadrille stability --out DIR             # a picture of each, and DIR/contact.html to look at them

Each case runs in a process of its own, functionally and on the machine. Whatever the case is about,

- it **ends** within its limit of time, and has then taken no more memory than it may;
- it **conserves**: every law between the units' counts holds, and each unit's busy, starved, blocked and idle cycles add up to its cycles;
- it **keeps the image**: colours and depths are those of the functional run, bit for bit, and nothing outside the scissor is touched;
- no unit or link is used more than all of the time: what each must at least have needed is a lower bound on the frame's time, and the frame kept to it.

What else must hold is the case's own, and is listed with it: a measured value beside its bound; a value without a bound is reported only. Host time and memory
are those of the computer that wrote the page.

Pictures that count are black where no triangle covers a pixel, green where one does, yellow for two and red for more; grey is outside the scissor. Under the
picture of a machine's case a bar for each kind of unit says how it spent its cycles, from the command processor down to memory: busy green, starved blue,
blocked red, idle grey.
)";

/// With a capital at its start.
std::string sentence(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string case_markdown(const CaseResult& r, const std::string& pictures) {
  const Case& c = *r.about;
  std::string text = fmt::format("\n### {}\n\n{}. Must hold: {}.\n\n", c.name, sentence(c.purpose), c.must);
  text += fmt::format("![{}]({}{}.png)\n\n", c.name, pictures, c.name);
  if (r.run.end != ChildEnd::kDone)
    return text + fmt::format("**{}**: {}\n", child_end_name(r.run.end), r.run.output);
  text += "| | measured | bound |\n|---|---|---|\n";
  for (std::size_t i = 0; i < r.findings.all().size(); ++i) {
    const Finding& f = r.findings.all()[i];
    if (!is_usual(r, i))
      text += fmt::format("| {} | {}{} | {} |\n", f.what, f.measured, f.holds ? "" : " **does not hold**",
                          f.bound);
  }
  return text + fmt::format("\n{}x{}, {} cycles. Limit: {}.\n", r.width, r.height, r.cycles, r.limit);
}

}  // namespace

std::string case_text(const CaseResult& r, bool all) {
  std::string text = fmt::format("{:<27} {:<13} {:>6.2f} s {:>6.0f} MiB {:>14} cycles\n", r.about->name,
                                 verdict(r), r.run.wall_s, r.run.peak_rss_mib, r.cycles);
  if (r.run.end != ChildEnd::kDone) return text + fmt::format("    {}\n", r.run.output);
  for (std::size_t i = 0; i < r.findings.all().size(); ++i) {
    const Finding& f = r.findings.all()[i];
    if (!all && is_usual(r, i)) continue;
    text += fmt::format("    {:<66} {:>22}  {:<26}{}\n", f.what, f.measured, f.bound,
                        f.holds ? "" : "  <-- does not hold");
  }
  return text + fmt::format("    limit: {}\n", r.limit);
}

std::string verdict_text(std::span<const CaseResult> results) {
  const auto holding = std::ranges::count_if(results, &CaseResult::holds);
  std::string text = fmt::format("{} of {} cases hold\n", holding, results.size());
  for (const CaseResult& r : results) {
    if (!r.holds()) text += fmt::format("  {}: {}\n", r.about->name, verdict(r));
  }
  return text;
}

std::string results_json(std::span<const CaseResult> results) {
  Json cases = Json::array();
  for (const CaseResult& r : results) {
    Json findings = Json::array();
    for (const Finding& f : r.findings.all())
      findings.push_back(
          {{"what", f.what}, {"measured", f.measured}, {"bound", f.bound}, {"holds", f.holds}});
    cases.push_back({{"name", r.about->name},
                     {"group", r.about->group},
                     {"purpose", r.about->purpose},
                     {"must", r.about->must},
                     {"holds", r.holds()},
                     {"end", child_end_name(r.run.end)},
                     {"said", r.run.output},
                     {"width", r.width},
                     {"height", r.height},
                     {"cycles", r.cycles},
                     {"limit", r.limit},
                     {"wall_s", r.run.wall_s},
                     {"peak_rss_mib", r.run.peak_rss_mib},
                     {"findings", std::move(findings)}});
  }
  const Json document{{"schema", kStabilitySchema}, {"cases", std::move(cases)}};
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string results_markdown(std::span<const CaseResult> results, const std::string& pictures) {
  std::string text(kPageHead);
  const auto holding = std::ranges::count_if(results, &CaseResult::holds);
  text += fmt::format("\n**{} of {} cases hold.**\n", holding, results.size());
  std::string group;
  for (const CaseResult& r : results) {
    if (r.about->group != group) {
      group = r.about->group;
      text += group == "numbers" ? "\n## Numbers at their edges\n" : "\n## Machines at their edges\n";
    }
    text += case_markdown(r, pictures);
  }
  return text;
}

std::string contact_html(std::span<const CaseResult> results) {
  std::string text =
      "<!doctype html><meta charset=\"utf-8\"><title>Quadrille: stiff and extreme</title>\n"
      "<style>body{font:14px "
      "sans-serif}figure{display:inline-block;vertical-align:top;width:270px;margin:6px}"
      "img{image-rendering:pixelated;max-width:256px}.bad{color:#c00}</style>\n";
  for (const CaseResult& r : results) {
    text += fmt::format(
        "<figure><img src=\"{0}.png\" alt=\"{0}\"><figcaption><b{1}>{0}: "
        "{2}</b><br>{3}<br><i>{4}</i></figcaption></figure>\n",
        r.about->name, r.holds() ? "" : " class=\"bad\"", verdict(r), html(r.about->purpose),
        html(r.about->must));
  }
  return text;
}

}  // namespace quadrille::studies::stability
