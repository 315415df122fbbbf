/// `quadrille stability`: the catalogue of stiff and extreme cases.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "cli/command.h"
#include "cli/image_files.h"
#include "cli/process.h"
#include "cli/scene_arguments.h"
#include "models/base/error.h"
#include "studies/stability/report.h"
#include "studies/stability/stability.h"

namespace quadrille::cli {
namespace {

namespace stability = studies::stability;
namespace fs = std::filesystem;

struct StabilityArguments {
  std::vector<std::string> patterns;
  std::optional<std::string> out, json, page, jobs;
  bool list = false, all = false, quick = false;
};

void print_list(std::span<const stability::Case* const> cases) {
  for (const stability::Case* c : cases)
    fmt::print("{:<28}{}{}\n", c->name, c->purpose, c->slow ? " (slow)" : "");
}

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) throw user_error("--out: {}: cannot be made a folder", folder);
}

/// The folder of the pictures as seen from the page, with its slash.
std::string seen_from(const std::string& page, const std::string& folder) {
  return fs::proximate(folder, fs::absolute(page).parent_path()).generic_string() + "/";
}

std::string picture_of(const StabilityArguments& arguments, const std::string& name) {
  return (fs::path(*arguments.out) / (name + ".png")).string();
}
std::string contact_of(const StabilityArguments& arguments) {
  return (fs::path(*arguments.out) / "contact.html").string();
}

void write_pictures(const StabilityArguments& arguments, std::span<const stability::CaseResult> results) {
  for (const stability::CaseResult& r : results) {
    if (!r.picture.pixels.empty()) scenes::save_png(picture_of(arguments, r.about->name), r.picture);
  }
  write_text(contact_of(arguments), stability::contact_html(results));
}

int run_stability(const StabilityArguments& arguments) {
  std::vector<const stability::Case*> cases = stability::select(arguments.patterns);
  if (arguments.quick) std::erase_if(cases, [](const stability::Case* c) { return c->slow; });
  if (cases.empty()) throw user_error("--quick: leaves out every case that was asked for");
  const std::int64_t jobs = arguments.jobs ? parse_whole(*arguments.jobs, "--jobs", 1, 64) : 2;
  if (arguments.json) check_json_output("--json", *arguments.json);
  if (arguments.page) check_output("--page", *arguments.page, {".md"});
  if (arguments.page && !arguments.out)
    throw user_error("--page: it shows the pictures of --out, which is missing");
  if (arguments.list) {
    if (arguments.out || arguments.json || arguments.page)
      throw user_error("--list: runs no case, so there is nothing to write");
    print_list(cases);
    return kDone;
  }
  if (arguments.out) {
    make_folder(*arguments.out);
    for (const stability::Case* c : cases) check_output("--out", picture_of(arguments, c->name), {".png"});
    check_output("--out", contact_of(arguments), {".html"});
  }

  const Tables tables(true, arguments.json);
  const Stopwatch watch;
  const std::vector<stability::CaseResult> results = stability::run_cases(
      cases, static_cast<int>(jobs),
      [&](const auto& result) { tables.print(stability::case_text(result, arguments.all)); });
  if (arguments.out) write_pictures(arguments, results);
  if (arguments.json) write_text(*arguments.json, stability::results_json(results));
  if (arguments.page)
    write_text(*arguments.page,
               stability::results_markdown(results, seen_from(*arguments.page, *arguments.out)));
  tables.print(fmt::format("{}{:.0f} s\n", stability::verdict_text(results), watch.seconds()));
  const bool hold = std::ranges::all_of(results, [](const stability::CaseResult& r) { return r.holds(); });
  return hold ? kDone : kFailed;
}

}  // namespace

void add_stability(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("stability",
                                         "Runs the catalogue of stiff and extreme cases: each with a "
                                         "picture, what must hold, and what was measured.");
  const auto arguments = std::make_shared<StabilityArguments>();
  command->add_option("CASE", arguments->patterns,
                      "names of cases; * and ? match as in a shell (default: all)");
  command->add_flag("--list", arguments->list, "prints the cases' names and purposes, and runs none");
  command->add_flag("--quick", arguments->quick, "leaves out the cases that take more than a few seconds");
  command->add_flag("--all", arguments->all,
                    "prints what every case must hold to as well, even where it holds");
  command
      ->add_option("--out", arguments->out,
                   "writes each case's picture there, and contact.html to look at them")
      ->type_name("DIR");
  command->add_option("--json", arguments->json, "writes all results as JSON; - is standard output")
      ->type_name("F.json|-");
  command
      ->add_option("--page", arguments->page,
                   "writes them as a page of documentation, with the pictures of --out")
      ->type_name("F.md");
  command->add_option("--jobs", arguments->jobs, "processes at a time (default 2)")->type_name("N");
  command->footer(R"(Exit code 1 when anything does not hold.
Examples:
  quadrille stability --quick
  quadrille stability 'world-*' far-scene --out worlds)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return run_stability(*arguments); }; });
}

}  // namespace quadrille::cli
