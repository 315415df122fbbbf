/// Hostile input through the program: what is tried, under which limits, and what must hold afterwards.
///
/// A case prepares files in a folder of its own and gives the program's arguments. Whatever it is, the
/// program ends by itself with exit code 0 or 2 within 2 GiB and 10 s of processor time (on a slower or busy
/// host as much more as a fixed piece of work takes longer there: tests/host_speed.h); a refusal is one line
/// that names the culprit; an output file is whole or absent, and nothing else is left behind.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace quadrille::hostile {

namespace fs = std::filesystem;

enum class Expect { kEither, kRendered, kRefused };

struct Case {
  std::string name;                                     ///< what is wrong with it
  std::vector<std::string> arguments;                   ///< of the program, which runs in the case's folder
  std::string culprit;                                  ///< a refusal has to say this
  std::function<void(const fs::path& folder)> prepare;  ///< makes the files; may be empty
  Expect expect = Expect::kEither;
};

struct Outcome {
  int exit_code = -1;  ///< -1: ended by a signal or for its time
  double seconds = 0;  ///< of the host's processors
  double peak_mib = 0;
  std::string error;                  ///< standard error
  std::vector<std::string> problems;  ///< what does not hold; empty when all does
};

inline constexpr double kMaxSeconds = 10, kMaxMib = 2048;

/// Runs the case in a new folder.
[[nodiscard]] Outcome run_case(const Case& c);

/// A group of cases: one test, one row of docs/robustness.md.
struct Group {
  std::string name, about;
  std::vector<Case> cases;
};

[[nodiscard]] Group scene_cases();
[[nodiscard]] Group binary_scene_cases();
[[nodiscard]] Group large_scene_cases();
[[nodiscard]] Group image_cases();
[[nodiscard]] Group trace_cases();
[[nodiscard]] Group capture_cases();
[[nodiscard]] Group machine_cases();
[[nodiscard]] Group energy_cases();
[[nodiscard]] Group flag_cases();
[[nodiscard]] Group shader_cases();
[[nodiscard]] Group output_cases();
/// Files that this project did not write; empty where they are absent. Twice each: functional and exact.
[[nodiscard]] Group outside_cases();
/// All of the above, to be made one after another: a run inherits the pages of the process that starts it, so
/// the texts of a group should go before the next.
[[nodiscard]] std::vector<Group (*)()> all_groups();

[[nodiscard]] inline std::string repeated(const std::string& text, std::size_t count) {
  std::string out;
  out.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) out += text;
  return out;
}

/// Puts text or bytes into a file.
void write_file(const fs::path& path, std::string_view text);
/// A case that renders the scene file `name`, made of `text`, at 64x64.
[[nodiscard]] Case scene_case(const std::string& what, const std::string& text,
                              const std::string& name = "t.gltf", Expect expect = Expect::kEither);
/// The arguments that render `scene` at 64x64 with both outputs.
[[nodiscard]] std::vector<std::string> render_arguments(const std::string& scene,
                                                        const std::string& fidelity = "exact");

}  // namespace quadrille::hostile
