/// quadrille_random_traces: the frames of the random tests as traces, for a device that has no tests. Draw
/// them there with `quadrille_measure_vulkan --scene F.qtrace --pictures P`, and here with `quadrille
/// render`.
///
/// Exit code: 0 written, 2 a mistake in what was given.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>

#include "models/base/error.h"
#include "tests/pipeline/passes_stream.h"
#include "tests/pipeline/random_stream.h"
#include "tests/pipeline/states_stream.h"
#include "traces/trace_file.h"

namespace quadrille::lavapipe {
namespace {

struct Arguments {
  std::string kind, folder;
  std::uint64_t first = 1, count = 10;
};

constexpr std::uint32_t kWidth = 64, kHeight = 48;

/// Of states, every fourth has four samples a pixel.
traces::CommandStream random_frame(const std::string& kind, std::uint64_t seed) {
  if (kind == "passes") return pipeline::test::passes_stream(seed);
  if (kind == "primitives") return pipeline::test::random_primitives(seed);
  return pipeline::test::states_stream(seed, kWidth, kHeight, {.samples = seed % 4 == 0 ? 4U : 1U});
}

void run(const Arguments& a) {
  std::error_code error;
  if (!std::filesystem::is_directory(a.folder, error)) throw user_error("{}: not a folder", a.folder);
  for (std::uint64_t seed = a.first; seed < a.first + a.count; ++seed) {
    const std::string name = fmt::format("{}_{}.qtrace", a.kind, seed);
    traces::write_trace(random_frame(a.kind, seed), (std::filesystem::path(a.folder) / name).string());
  }
}

}  // namespace
}  // namespace quadrille::lavapipe

int main(int argc, char** argv) {
  using namespace quadrille;
  CLI::App app("Writes the frames of the random tests as traces.", "quadrille_random_traces");
  lavapipe::Arguments arguments;
  app.add_option("kind", arguments.kind, "what is random about them")
      ->required()
      ->check(CLI::IsMember({"states", "passes", "primitives"}));
  app.add_option("folder", arguments.folder, "that receives them, KIND_SEED.qtrace each")->required();
  app.add_option("--first", arguments.first, "seed of the first")->capture_default_str();
  app.add_option("--count", arguments.count, "how many")->capture_default_str();
  try {
    app.parse(argc, argv);
    lavapipe::run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const UserError& error) {
    fmt::print(stderr, "quadrille_random_traces: {}\n", error.what());
    return 2;
  }
  return 0;
}
