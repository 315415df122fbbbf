/// The rows of `--frames`: frames as their processes end, printed and collected in their order, whatever they
/// are frames of.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/frame_sequence.h"
#include "cli/process.h"
#include "studies/child_run.h"

namespace quadrille::cli {

using Json = nlohmann::ordered_json;

inline constexpr double kFrameSeconds = 1e9;  ///< of a frame's process: as long as it takes

/// Which moment a frame shows; none: it shows no moment of an animation, or nothing turns.
struct FrameLabels {
  std::optional<double> time_s, turn;
};

/// What a row of frames takes: one after another, and where the scan-out of each overlaps the drawing of the
/// next. Two targets take turns: a frame is drawn when the one before it is drawn and the target that it
/// draws into, which the one before that is shown from, is free. Neither slows the other in memory.
class DisplayQueue {
 public:
  /// When the next frame is drawn and shown, in cycles since the first began to be drawn; null when it was
  /// not timed.
  Json add(const Json& frame) {
    if (frame["cycles"].is_null()) return nullptr;
    const std::int64_t cycles = frame["cycles"], drawing = frame["render_cycles"];
    const std::int64_t from = std::max(drawn_, shown_before_);
    shown_before_ = shown_;
    drawn_ = from + drawing;
    shown_ = std::max(drawn_, shown_) + (cycles - drawing);
    one_after_another_ += cycles;
    clock_mhz_ = frame["clock_mhz"];
    ++frames_;
    return {{"drawn_from", from}, {"drawn_at", drawn_}, {"shown_at", shown_}};
  }
  /// The last line of the table; empty when no frame was timed.
  [[nodiscard]] std::string text() const {
    if (frames_ == 0) return "";
    const auto rate = [this](std::int64_t cycles) {
      return fmt::format("{} cycles, {:.1f} frames/s", cycles,
                         1e6 * clock_mhz_ * frames_ / static_cast<double>(cycles));
    };
    return fmt::format(
        "  all: {} one after another; {} where the scan-out of each overlaps the drawing of the next\n",
        rate(one_after_another_), rate(shown_));
  }
  [[nodiscard]] Json json() const {
    if (frames_ == 0) return nullptr;
    return {{"one_after_another", one_after_another_}, {"overlapped", shown_}, {"clock_mhz", clock_mhz_}};
  }

 private:
  std::int64_t drawn_ = 0, shown_ = 0, shown_before_ = 0, one_after_another_ = 0;
  double clock_mhz_ = 0;
  int frames_ = 0;
};

/// The head of the table, and notes below it or below a row.
[[nodiscard]] std::string frames_head();
[[nodiscard]] std::string note_rows(const std::vector<std::string>& notes);
/// A frame as its process sends it: figures, a zero, and the picture.
[[nodiscard]] std::string sent(const DrawnFrame& frame);

class FrameRows {
 public:
  struct Plan {
    std::int64_t frames = 1;
    double fps = 25;  ///< of a film
    std::function<FrameLabels(std::int64_t frame)> labels;
  };
  FrameRows(Plan plan, const Tables& tables, const TakePicture& take)
      : plan_(std::move(plan)), tables_(tables), take_(take) {}
  /// Runs the works, which return what `sent` makes, one for each frame. Throws `UserError` that names the
  /// frame.
  void run(std::span<const studies::ChildWork> works, int jobs);
  /// Prints the sum. `about` has the document's `scene`, `animation_s` and `notes`.
  [[nodiscard]] SequenceResult result(const Json& about);

 private:
  /// A frame as it came.
  struct Drawn {
    Json figures;
    std::vector<std::byte> png;
  };
  [[nodiscard]] static Drawn received(const std::string& text);
  void add(std::int64_t number, Drawn drawn);
  void append(Drawn drawn);
  /// Frames in order so far.
  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(frames_.size()); }

  const Plan plan_;
  const Tables& tables_;
  const TakePicture& take_;
  DisplayQueue queue_;
  std::map<std::int64_t, Drawn> waiting_;
  Json frames_ = Json::array();
  int exit_code_ = 0;
};

}  // namespace quadrille::cli
