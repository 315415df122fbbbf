/// A subcommand of the program: it registers its options, and hands over what to run when it was the one
/// chosen.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace quadrille::cli {

/// Exit codes. A user's mistake and a failed check are told apart, so that a script can tell a wrong flag
/// from a wrong machine.
inline constexpr int kDone = 0, kFailed = 1, kUserError = 2, kInternalError = 3;

using Command = std::function<int()>;

void add_render(CLI::App& app, Command& chosen);
void add_compare(CLI::App& app, Command& chosen);
void add_diff(CLI::App& app, Command& chosen);
void add_experiment(CLI::App& app, Command& chosen);
void add_describe(CLI::App& app, Command& chosen);
void add_trace(CLI::App& app, Command& chosen);
void add_accuracy(CLI::App& app, Command& chosen);
void add_leave_out(CLI::App& app, Command& chosen);
void add_lists(CLI::App& app, Command& chosen);
void add_why(CLI::App& app, Command& chosen);
void add_explore(CLI::App& app, Command& chosen);
void add_stability(CLI::App& app, Command& chosen);

}  // namespace quadrille::cli
