/// Frames captured by gfxreconstruct, as command streams. (docs/real_frames.md)
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "traces/command_stream.h"
#include "traces/frame_contents.h"

namespace quadrille::capture {

struct ImportOptions {
  bool skip_unsupported = false;  ///< what cannot be drawn is left out, and counted
};

struct Import {
  traces::CommandStream stream;
  std::map<std::string, std::size_t> skipped;  ///< by reason, with how often
  std::set<std::string> notes{};               ///< what the capture lacks, a line each
};

/// The frames of a capture, one after the other. Each begins with what the one before it left, once `keep`
/// has been told; else with what the capture holds.
class CaptureFrames {
 public:
  /// Throws `UserError` that names the file.
  explicit CaptureFrames(const std::string& path, const ImportOptions& options = {});
  CaptureFrames(const std::string& name, std::vector<std::byte> bytes, const ImportOptions& options = {});
  ~CaptureFrames();
  CaptureFrames(const CaptureFrames&) = delete;
  CaptureFrames& operator=(const CaptureFrames&) = delete;
  /// The next frame that the file presents, validated; none at its end. Throws `UserError` as
  /// `import_capture` does.
  [[nodiscard]] std::optional<Import> next();
  /// What the latest frame left.
  void keep(const traces::FrameContents& contents);
  /// As `capture_info`.
  [[nodiscard]] static std::string info(const std::string& path);

 private:
  class Reading;
  std::unique_ptr<Reading> reading_;
  ImportOptions options_;
};

/// How many frames a capture presents. Throws `UserError`.
[[nodiscard]] std::size_t count_frames(const std::string& path);

/// The first frame that the file presents, validated. Throws `UserError`: one line with the file, and the
/// block that is damaged, or what of the frame is not supported and how often.
[[nodiscard]] Import import_capture(const std::string& path, const ImportOptions& options = {});
/// The same of a file that was read, or never was one.
[[nodiscard]] Import import_bytes(const std::string& name, std::vector<std::byte> bytes,
                                  const ImportOptions& options = {});

/// What a capture holds: its calls by name with their counts, and which of the frame's commands are not
/// supported. Text of several lines.
[[nodiscard]] std::string capture_info(const std::string& path);

}  // namespace quadrille::capture
