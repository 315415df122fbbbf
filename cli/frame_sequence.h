/// Many frames of one scene or capture: `quadrille render --frames N`. Each frame is a process of its own;
/// this one reads the file once and collects the rows.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/process.h"
#include "cli/scene_arguments.h"
#include "pipeline/machine/machine_config.h"

namespace quadrille::cli {

struct FrameArguments {
  std::optional<std::string> frames, fps, jobs, film;
  bool orbit = false;

  void add_to(CLI::App& command);
  /// Throws `UserError` for options that go with `--frames` alone.
  void check(const SceneArguments& scene) const;
  /// Throws `UserError` for a film that could not be written, or made.
  void check_film() const;
  /// Frames that are wanted.
  [[nodiscard]] std::int64_t count() const;
  /// Processes at a time.
  [[nodiscard]] int job_count() const;
  [[nodiscard]] bool wanted() const { return frames.has_value(); }
};

/// `frame_####.png` with the number of a frame in the place of the signs, which stand for at least that many
/// digits.
[[nodiscard]] std::string numbered(const std::string& pattern, std::int64_t frame);
/// Throws `UserError` that starts with `flag` when a file's name has no `#`, or several runs of them.
void check_pattern(std::string_view flag, const std::string& pattern);

/// A frame that was drawn: its figures as JSON, and its picture as a file of PNG, empty unless it is wanted.
struct DrawnFrame {
  std::string figures_json;
  std::vector<std::byte> png = {};
};
/// Draws frame `number` from its commands and writes its files. Runs in the frame's own process.
using DrawFrame = std::function<DrawnFrame(const SceneArguments::Loaded& frame, std::int64_t number)>;
/// Takes the picture of frame `number`, in the frames' order; `fps` are those of the film.
using TakePicture = std::function<void(std::int64_t number, double fps, std::vector<std::byte> png)>;

struct SequenceResult {
  int exit_code = 0;
  std::string json;  ///< all frames' figures, schema `quadrille-frames-1`
};

/// Draws all frames, printing a row for each; the rows come in order, however many processes draw. Throws
/// `UserError` that names the frame.
[[nodiscard]] SequenceResult draw_frames(const SceneArguments& scene, const FrameArguments& frames,
                                         const std::string& about, const Tables& tables,
                                         const DrawFrame& draw, const TakePicture& take = {});

/// The same of a capture: its first frames, each with what the one before it left in attachments and buffers,
/// which is found by a run without time (machines of `precision`).
[[nodiscard]] SequenceResult draw_capture_frames(const SceneArguments& scene, const FrameArguments& frames,
                                                 const std::string& about, const models::Precision& precision,
                                                 const Tables& tables, const DrawFrame& draw,
                                                 const TakePicture& take = {});

}  // namespace quadrille::cli
