/// The `quadrille` program: finds the subcommand and turns every error into one line and an exit code.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>
#include <span>
#include <system_error>

#include "cli/command.h"
#include "cli/process.h"
#include "models/base/error.h"
#include "models/base/near_name.h"
#include "models/base/say.h"

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
  quadrille compare a.json b.json   what differs between two frames
  quadrille accuracy builtin:courtyard      what speed costs in truth: windows and precisions
  quadrille explore caches.toml     scenes on many machines, as a sweep file says
  quadrille trace record helmet.gltf -o helmet.qtrace
  quadrille stability --quick       frames and machines at the edge of what is possible
  quadrille experiment memory-scheduling    what others measured, on the simulated machine
Each subcommand has its own --help.
Exit code: 0 done, 1 a check failed or pictures differ, 2 something given was wrong.)";

int fail(int code, const std::string& message) {
  say(fmt::format("quadrille: {}\n", message));
  return code;
}

/// The innermost subcommand that was recognised, or the program.
const CLI::App& recognised(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : recognised(*parsed.front());
}

/// "quadrille trace record"
std::string command_line_of(const CLI::App& app, const CLI::App& command) {
  return &app == &command ? app.get_name()
                          : command_line_of(app, *command.get_parent()) + " " + command.get_name();
}

std::vector<std::string> subcommands_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

std::vector<std::string> flags_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// The first word of the command line that nothing takes, in the order in which they were typed; none when
/// all are taken.
std::optional<std::string> first_unknown(const CLI::App& app, std::span<char* const> words) {
  const std::vector<std::string> unknown = app.remaining(true);
  for (const char* word : words) {
    if (std::ranges::find(unknown, word) != unknown.end()) return word;
  }
  return std::nullopt;
}

/// What is wrong with a word that nothing takes, and what it may have been meant to be.
std::string unknown_text(const CLI::App& command, const std::string& word) {
  if (word.starts_with('-') && word.size() > 1)
    return fmt::format("unknown option '{}'{}", word,
                       did_you_mean(word.substr(0, word.find('=')), flags_of(command)));
  const std::vector<std::string> subs = subcommands_of(command);
  if (subs.empty()) return fmt::format("unexpected argument '{}'", word);
  const std::string meant = did_you_mean(word, subs);
  return fmt::format("unknown subcommand '{}'{}", word,
                     meant.empty() ? fmt::format("; there are {}", fmt::join(subs, ", ")) : meant);
}

/// What is wrong with a command line, as one line. A word that nothing takes is named before what is missing:
/// it is often the reason.
int refuse(const CLI::App& app, std::span<char* const> words, const CLI::ParseError& error) {
  const CLI::App& command = recognised(app);
  const std::optional<std::string> unknown = first_unknown(app, words);
  const std::string text = one_line(unknown ? unknown_text(command, *unknown) : error.what());
  return fail(kUserError, fmt::format("{}; see {} --help", text, command_line_of(app, command)));
}

/// Standard output is full, closed or gone.
int output_lost(const std::system_error& error) {
  if (error.code().value() == EPIPE) end_by_pipe();
  if (std::ferror(stdout) == 0) return fail(kUserError, one_line(error.what()));
  return fail(kUserError, fmt::format("standard output cannot be written: {}", error.code().message()));
}

int run(int argc, char** argv) {
  CLI::App app(kAbout, "quadrille");
  app.footer(kExamples);
  app.set_version_flag("--version", "quadrille " QUADRILLE_VERSION);
  app.require_subcommand(0, 1);  // none is refused below, after an unknown word was named
  Command chosen;
  add_render(app, chosen);
  add_compare(app, chosen);
  add_diff(app, chosen);
  add_describe(app, chosen);
  add_trace(app, chosen);
  add_accuracy(app, chosen);
  add_leave_out(app, chosen);
  add_why(app, chosen);
  add_explore(app, chosen);
  add_lists(app, chosen);
  add_stability(app, chosen);
  add_experiment(app, chosen);
  try {
    try {
      app.parse(argc, argv);
    } catch (const CLI::Success& answered) {
      chosen = [&app, answered] { return app.exit(answered); };
    }  // --help and --version
    if (!chosen) return fail(kUserError, "a subcommand is missing; see quadrille --help");
    const int code = chosen();
    flush_output();
    return code;
  } catch (const CLI::ParseError& error) {
    return refuse(app, {argv + 1, argv + argc}, error);
  } catch (const UserError& error) { return fail(kUserError, error.what()); } catch (const std::bad_alloc&) {
    return fail(kUserError, "out of memory; try a smaller --size, or a machine with less gpu.memory_mib");
  } catch (const std::system_error& error) {
    return output_lost(error);
  } catch (const std::exception& error) {
    return fail(kInternalError, fmt::format("internal error: {}", error.what()));
  }
}

}  // namespace
}  // namespace quadrille::cli

int main(int argc, char** argv) {
  quadrille::cli::start_process();
  setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 1);  // its banner would be the first line of every report
  return quadrille::cli::run(argc, argv);
}
