/// What this process has cost so far, and the line that says on a terminal what it is doing.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace quadrille::cli {

/// Remembers when the process started; first statement of the program.
void note_start();
/// Seconds since then.
[[nodiscard]] double wall_seconds();

/// Seconds that a piece of work takes.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// One line on standard error that is overwritten as the work goes on and erased at its end. Says nothing unless standard error is a terminal.
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
