/// A sweep: which machines draw which scenes, and what of the frames is asked for.
///
/// The file is TOML; docs/explore.md has every key. Everything that can be judged without a run is judged
/// when it is read, and errors name the file and the line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/explore/expression.h"

namespace quadrille::studies::explore {

/// Which machines of the space are drawn.
enum class DesignKind : std::uint8_t { kGrid, kRandom, kLatinHypercube, kSobol, kSearch };
inline constexpr std::string_view kDesignNames[] = {"grid", "random", "latin_hypercube", "sobol", "search"};

/// A key with its value, as text, and the place that errors name: "sweep.toml:12".
struct Entry {
  std::string key, value, where;
};

/// A scene with the options of `quadrille render` that say how it is seen: size = "320x180".
struct SceneEntry {
  std::string scene;  ///< a path that leads from where the program runs, or builtin:NAME
  std::string name;   ///< in tables
  std::vector<Entry> options;
  std::string where;
};

/// Something that differs from machine to machine: a parameter, the machine itself ("machine"), or a name
/// without a dot that formulas use.
struct Dimension {
  std::string name, where;
  std::vector<std::string> levels;  ///< as `MachineConfig::set` reads them; empty: all between two numbers
  double from = 0, to = 0;
  bool logarithmic = false, whole = false;
  [[nodiscard]] bool continuous() const { return levels.empty(); }
  /// The value at a place 0..1 of the dimension, each level as likely.
  [[nodiscard]] std::string at(double place) const;
};

/// A parameter, or a name without a dot, that follows from others.
struct Derived {
  std::string name;
  Expression formula;
};

/// What a front is made of.
struct Objective {
  enum class Over : std::uint8_t { kWorst, kMean, kSum };
  std::string name, unit;
  Expression formula;
  bool most = false;  ///< more is better
  Over over = Over::kWorst;
  std::optional<double> at_most = std::nullopt, at_least = std::nullopt;  ///< what a machine must hold
  double noise = 0;  ///< differences up to this part of the value are none
};

/// All machines are drawn with a window, and the best of them exactly (screening.h).
struct ScreenEntry {
  std::int64_t window = 0;  ///< cycles
  std::uint32_t machines = 0;
};

struct Sweep {
  std::string file, text;
  DesignKind design = DesignKind::kGrid;
  std::uint32_t points = 0;  ///< machines to draw, of all designs but the grid
  std::uint64_t seed = 1;
  double seconds = 3600;         ///< a frame may take
  std::uint64_t memory_mib = 0;  ///< it may use; 0: no limit
  std::int64_t window = 0;       ///< cycles, as `render --window`
  std::optional<ScreenEntry> screen = std::nullopt;
  std::vector<SceneEntry> scenes;
  std::vector<std::string> machines;  ///< names, or paths that lead from where the program runs
  std::vector<Entry> settings;        ///< set on all machines
  std::vector<Dimension> dimensions;
  std::vector<Derived> derived;
  std::vector<Expression> constraints;
  std::vector<Objective> objectives;
};

/// Reads and checks a sweep. Throws `UserError` with file, line and legal values.
[[nodiscard]] Sweep read_sweep(const std::string& file);

}  // namespace quadrille::studies::explore
