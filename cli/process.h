/// What this process has cost so far, what it does at its borders (standard streams, signals), and the line
/// that says on a terminal what it is doing.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace quadrille::cli {

/// First statement of the program. Remembers when it started. A standard stream that is closed is taken, so
/// that no file is opened in its place; a write to it fails. A limit of a file's size, or a pipe that nobody
/// reads, fails the write instead of ending the process; other signals that end it remove unfinished files.
void start_process();
/// Sends on what was printed. Throws `std::system_error` when standard output cannot be written.
void flush_output();
/// Ends the program for an output that nobody reads any more as other programs end: by SIGPIPE, unless that
/// was ignored when it started.
void end_by_pipe();
/// Seconds since then.
[[nodiscard]] double wall_seconds();

/// Where a command's tables go: to standard output; to standard error where a JSON document takes that;
/// nowhere when they are not wanted.
class Tables {
 public:
  enum class Place : std::uint8_t { kOutput, kError, kNowhere };
  /// `json` is the name given for the document, if any.
  Tables(bool wanted, const std::optional<std::string>& json);
  /// Prints at once. Throws `std::system_error` when standard output cannot be written.
  void print(const std::string& text) const;

 private:
  Place place_;
};

/// Seconds that a piece of work takes.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// One line on standard error that is overwritten as the work goes on and erased at its end. Says nothing
/// unless standard error is a terminal.
class Progress {
 public:
  Progress();
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows `text` at once.
  void show(const std::string& text);
  /// Shows simulated cycles and their speed, a few times a second at most.
  void show_cycles(std::int64_t cycles);
  void clear();

 private:
  bool enabled_;
  bool shown_ = false;
  std::optional<Stopwatch> simulating_;  ///< since the first cycles were shown
  double next_ = 0;
};

}  // namespace quadrille::cli
