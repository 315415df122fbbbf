#include "cli/process.h"

#include <fmt/format.h>
#include <unistd.h>

namespace quadrille::cli {
namespace {

std::optional<Stopwatch> process_watch;
constexpr double kRefreshSeconds = 0.1;

}  // namespace

void note_start() { process_watch.emplace(); }

double wall_seconds() { return process_watch ? process_watch->seconds() : 0; }

Progress::Progress() : enabled_(isatty(STDERR_FILENO) == 1) {}

void Progress::show(const std::string& text) {
  if (!enabled_) return;
  fmt::print(stderr, "\r\x1b[K{}", text);
  std::fflush(stderr);
  shown_ = true;
}

void Progress::show_cycles(std::int64_t cycles) {
  if (!enabled_) return;
  if (!simulating_) simulating_.emplace();
  const double elapsed = simulating_->seconds();
  if (elapsed < next_ + kRefreshSeconds) return;
  next_ = elapsed;
  const double millions = static_cast<double>(cycles) * 1e-6;
  show(fmt::format("simulating: {:.2f} million cycles, {:.1f} s, {:.2f} million cycles a second", millions, elapsed, millions / elapsed));
}

void Progress::clear() {
  if (!shown_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace quadrille::cli
