#include "cli/frame_rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/command.h"
#include "models/base/error.h"
#include "models/base/say.h"

namespace quadrille::cli {
namespace {

constexpr std::string_view kFramesSchema = "quadrille-frames-1";

/// What the limiter names, and its share.
std::string limit_text(const Json& limit) {
  if (limit.is_null()) return "-";
  const std::string kind = limit["kind"], name = limit["name"];
  const bool part_of_time =
      name != "scan_out" &&
      (kind == "work" || kind == "latency");  // scan-out's share is the part of the frame after all else
  return fmt::format("{}{} {:.1f}", part_of_time ? kind + " of " : "", name,
                     100 * limit["share"].get<double>());
}

std::string row(std::int64_t number, const FrameLabels& labels, const Json& figures) {
  const Json& f = figures["frame"];
  const bool timed = !f["cycles"].is_null();
  const auto number_or_dash = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : std::string("-");
  };
  std::string out =
      fmt::format("  {:>6} {:>9}{:>8}", number, number_or_dash(labels.time_s), number_or_dash(labels.turn));
  if (timed) {
    const double cycles = f["cycles"].get<double>();
    const double per_ms = f["clock_mhz"].get<double>() * 1e3;
    out += fmt::format("{:>13} {:>9.3f} {:>11.3f}", f["cycles"].get<std::int64_t>(), cycles / per_ms,
                       f["scan_out_cycles"].get<double>() / per_ms);
  } else {
    out += fmt::format("{:>13}{:>10}{:>12}", "-", "-", "-");
  }
  out += fmt::format("{:>8}{:>12}{:>13}", f["draws"].get<std::uint64_t>(),
                     f["triangles"].get<std::uint64_t>(), f["fragments_shaded"].get<std::uint64_t>());
  if (!timed) return out + fmt::format("{:>11}  -\n", "-");
  return out +
         fmt::format("{:>11.3f}  {}\n", f["memory_bytes"].get<double>() * 1e-6, limit_text(figures["limit"]));
}

/// The laws that a frame's figures break, a line each.
std::string broken_laws(std::int64_t number, const Json& figures) {
  std::string text;
  for (const Json& check : figures["checks"]) {
    if (!check["holds"].get<bool>())
      text += fmt::format("quadrille: frame {}: its figures contradict each other: {}\n", number,
                          check["law"].get<std::string>());
  }
  return text;
}

}  // namespace

std::string frames_head() {
  return fmt::format("  {:>6}{:>10}{:>8}{:>13}{:>10}{:>12}{:>8}{:>12}{:>13}{:>11}  {}\n", "frame", "time s",
                     "turn", "cycles", "ms", "scan-out ms", "draws", "triangles", "fragments", "memory MB",
                     "what limits it, %");
}

std::string note_rows(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += fmt::format("          note: {}\n", note);
  return text;
}

std::string sent(const DrawnFrame& frame) {
  std::string text = frame.figures_json;
  text += '\0';
  return text.append(reinterpret_cast<const char*>(frame.png.data()), frame.png.size());
}

FrameRows::Drawn FrameRows::received(const std::string& text) {
  const std::size_t end = text.find('\0');
  const auto png = std::as_bytes(std::span(text).subspan(end + 1));
  return {Json::parse(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end)),
          {png.begin(), png.end()}};
}

void FrameRows::add(std::int64_t number, Drawn drawn) {
  waiting_.emplace(number, std::move(drawn));
  while (!waiting_.empty() && waiting_.begin()->first == size()) {
    append(std::move(waiting_.begin()->second));
    waiting_.erase(waiting_.begin());
  }
}

void FrameRows::append(Drawn drawn) {
  const std::int64_t number = size();
  Json& figures = drawn.figures;
  const FrameLabels labels = plan_.labels(number);
  if (take_) take_(number, plan_.fps, std::move(drawn.png));
  tables_.print(row(number, labels, figures) + note_rows(figures["notes"]));
  if (const std::string broken = broken_laws(number, figures); !broken.empty()) {
    say(broken);
    exit_code_ = kFailed;
  }
  const auto or_null = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
  };
  Json overlapped = queue_.add(figures["frame"]);
  frames_.push_back({{"frame", number},
                     {"time_s", or_null(labels.time_s)},
                     {"turn", or_null(labels.turn)},
                     {"overlapped", std::move(overlapped)},
                     {"figures", std::move(figures)}});
}

void FrameRows::run(std::span<const studies::ChildWork> works, int jobs) {
  Progress progress;
  progress.show(fmt::format("frame 0 of {}", plan_.frames));
  studies::run_in_children(works, jobs, [&](std::size_t i, const studies::ChildRun& run) {
    Drawn drawn = received(studies::output_of(run, fmt::format("frame {}", i)));
    progress.clear();
    add(static_cast<std::int64_t>(i), std::move(drawn));
    if (size() < plan_.frames) progress.show(fmt::format("frame {} of {}", size(), plan_.frames));
  });
}

SequenceResult FrameRows::result(const Json& about) {
  tables_.print(queue_.text());
  const Json document = {{"schema", kFramesSchema}, {"scene", about["scene"]},
                         {"cycles", queue_.json()}, {"animation_s", about["animation_s"]},
                         {"notes", about["notes"]}, {"frames", std::move(frames_)}};
  return {exit_code_, document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"};
}

}  // namespace quadrille::cli
