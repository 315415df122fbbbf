/// A film of frames by ffmpeg, where that is installed: pictures go in as they are drawn, and the file
/// appears whole at the end.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "traces/unfinished.h"

namespace quadrille::cli {

/// Throws `UserError` when there is no ffmpeg to make `--film`.
void check_film_program();

class Film {
 public:
  /// Starts ffmpeg. `path` ends in .mp4 or .gif; `fps`: frames a second. Throws `UserError`.
  Film(const std::string& path, double fps);
  /// Ends ffmpeg and removes what it wrote, unless the film is finished.
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// The next picture, a file of PNG. Throws `UserError` with what ffmpeg says when it does not take it.
  void add(std::span<const std::byte> png);
  /// Waits for ffmpeg and gives the film its name. Throws `UserError` with what ffmpeg says when it failed.
  void finish();

 private:
  [[noreturn]] void fail();
  /// ffmpeg's exit status; -1 where a signal ended it.
  int wait_for_end();

  std::string path_, part_;
  traces::Unfinished unfinished_;
  pid_t process_ = -1;
  int pictures_ = -1, said_ = -1;  ///< ffmpeg's standard input; a file that its messages go to
};

}  // namespace quadrille::cli
