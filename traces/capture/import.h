/// Frames captured by gfxreconstruct, as command streams. (docs/real_frames.md)
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::capture {

struct ImportOptions {
  bool skip_unsupported = false;  ///< what cannot be drawn is left out, and counted
};

struct Import {
  traces::CommandStream stream;
  std::map<std::string, std::size_t> skipped;  ///< by reason, with how often
  std::set<std::string> notes{};               ///< what the capture lacks, a line each
};

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
