/// `quadrille compare`: what differs between two frames, from the figures of both.
#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/image_files.h"
#include "cli/process.h"
#include "models/base/error.h"
#include "pipeline/report/comparison.h"
#include "pipeline/report/page.h"
#include "traces/whole_file.h"

namespace quadrille::cli {
namespace {

struct CompareArguments {
  std::string a, b;
  std::optional<std::string> report, json;
  bool quiet = false;
};

pipeline::FiguresFile read(const std::string& path) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30;
  const std::vector<std::byte> bytes = traces::read_whole_file(path, kMaxBytes);
  return {path, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())};
}

int run_compare(const CompareArguments& arguments) {
  if (arguments.report) check_output("--report", *arguments.report, {".html"});
  if (arguments.json) check_json_output("--json", *arguments.json);
  check_distinct({{"A", arguments.a}, {"--report", arguments.report}, {"--json", arguments.json}});
  check_distinct({{"B", arguments.b}, {"--report", arguments.report}, {"--json", arguments.json}});
  const std::string json = pipeline::comparison_json(read(arguments.a), read(arguments.b));
  if (arguments.report)
    write_text(*arguments.report,
               pipeline::comparison_page(arguments.a + " and " + arguments.b + " - Quadrille", json));
  if (arguments.json) write_text(*arguments.json, json);
  Tables(!arguments.quiet, arguments.json).print(pipeline::comparison_table(json));
  return kDone;
}

}  // namespace

void add_compare(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "compare", "Says what differs between two frames, by unit, draw and square of the screen.");
  const auto arguments = std::make_shared<CompareArguments>();
  command->add_option("A", arguments->a, "figures of a frame, as render --stats writes them")->required();
  command->add_option("B", arguments->b, "those of the frame to compare with it")->required();
  command
      ->add_option("--report", arguments->report,
                   "writes everything that differs as a page for a browser (docs/report.md)")
      ->type_name("F.html");
  command
      ->add_option("--json", arguments->json,
                   "writes it as JSON; - is standard output, and the table then goes to standard error")
      ->type_name("F.json|-");
  command->add_flag("-q,--quiet", arguments->quiet, "prints no table");
  command->footer(R"(Examples:
  quadrille render city.gltf --detail draws,tiles,path --stats a.json
  quadrille render city.gltf --detail draws,tiles,path --stats b.json --set gpu.cores=8
  quadrille compare a.json b.json --report cores.html)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return run_compare(*arguments); }; });
}

}  // namespace quadrille::cli
