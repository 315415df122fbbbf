/// The `quadrille` program: finds the subcommand and turns every error into one line and an exit code.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <new>
#include <system_error>

#include "cli/command.h"
#include "cli/process.h"
#include "models/base/error.h"

/// SystemC's library refers to it; the machine is elaborated and run by the pipeline instead.
extern "C" int sc_main(int /*argc*/, char** /*argv*/) { return quadrille::cli::kDone; }

namespace quadrille::cli {
namespace {

constexpr const char* kAbout =
    R"(Quadrille simulates a GPU's graphics pipeline: a scene goes in; out come the picture that the machine draws,
the cycles it takes, and for every unit where its time went.)";

constexpr const char* kExamples = R"(Examples:
  quadrille render builtin:courtyard --out courtyard.png
  quadrille render helmet.gltf --size 1280x720 --machine large --set gpu.cores=8 --stats helmet.json
  quadrille describe texture        parameters and counters of the texture unit
  quadrille diff a.png b.png        how far apart two pictures are
  quadrille accuracy builtin:courtyard      what speed costs in truth: windows and precisions
  quadrille trace record helmet.gltf -o helmet.qtrace
  quadrille stability --quick       frames and machines at the edge of what is possible
Each subcommand has its own --help.
Exit code: 0 done, 1 a check failed or pictures differ, 2 something given was wrong.)";

int fail(int code, std::string message) {
  fmt::print(stderr, "quadrille: {}\n", message);
  return code;
}

/// What CLI11 says of a wrong command line, as one line.
int refuse(const CLI::App& app, const CLI::ParseError& error) {
  const std::string text = one_line(error.what());
  const auto parsed = app.get_subcommands();
  return fail(kUserError, fmt::format("{}; see quadrille{} --help", text, parsed.empty() ? "" : " " + parsed.front()->get_name()));
}

int run(int argc, char** argv) {
  CLI::App app(kAbout, "quadrille");
  app.footer(kExamples);
  app.set_version_flag("--version", "quadrille " QUADRILLE_VERSION);
  app.require_subcommand(0, 1);  // none is refused below, after an unknown word was named
  Command chosen;
  add_render(app, chosen);
  add_diff(app, chosen);
  add_describe(app, chosen);
  add_trace(app, chosen);
  add_accuracy(app, chosen);
  add_leave_out(app, chosen);
  add_lists(app, chosen);
  add_stability(app, chosen);
  try {
    app.parse(argc, argv);
    if (!chosen) return fail(kUserError, "a subcommand is missing; see quadrille --help");
    const int code = chosen();
    return std::fflush(stdout) == 0 ? code : fail(kUserError, "standard output cannot be written");
  } catch (const CLI::Success& answered) {
    return app.exit(answered);  // --help and --version
  } catch (const CLI::ParseError& error) { return refuse(app, error); } catch (const UserError& error) {
    return fail(kUserError, error.what());
  } catch (const std::bad_alloc&) {
    return fail(kUserError, "out of memory; try a smaller --size, or a machine with less gpu.memory_mib");
  } catch (const std::system_error& error) {
    return fail(kUserError, one_line(error.what()));  // standard output is full or gone
  } catch (const std::exception& error) { return fail(kInternalError, fmt::format("internal error: {}", error.what())); }
}

}  // namespace
}  // namespace quadrille::cli

int main(int argc, char** argv) {
  quadrille::cli::note_start();
  setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 1);  // its banner would be the first line of every report
  return quadrille::cli::run(argc, argv);
}
