/// `quadrille trace`: frames as files of commands, to record, look at and replay.
#include <fmt/format.h>

#include <memory>

#include "cli/command.h"
#include "cli/image_files.h"
#include "cli/process.h"
#include "cli/render_job.h"
#include "models/base/error.h"
#include "traces/trace_file.h"

namespace quadrille::cli {
namespace {

void add_record(CLI::App& trace, Command& chosen) {
  CLI::App* command = trace.add_subcommand("record", "Records the commands of one frame of a scene.");
  const auto scene = std::make_shared<SceneArguments>();
  const auto file = std::make_shared<std::string>();
  scene->add_to(*command);
  scene->add_samples_to(*command);
  scene->add_queries_to(*command);
  scene->add_formats_to(*command);
  scene->add_transparency_to(*command);
  scene->add_compress_to(*command);
  command->add_option("-o,--out", *file, "the trace to write")->type_name("F.qtrace")->required();
  command->callback([=, &chosen] {
    chosen = [=] {
      scene->check();
      check_output("--out", *file, {".qtrace"});
      Progress progress;
      progress.show(fmt::format("recording {}", scene->scene));
      traces::write_trace(scene->load().stream, *file);
      return kDone;
    };
  });
}

/// A trace by its name; a scene is refused here, since it would be recorded unseen.
void require_trace(const SceneArguments& scene) {
  if (!scene.is_trace()) throw user_error("{}: not a trace; the name has to end in .qtrace", scene.scene);
}

void add_info(CLI::App& trace, Command& chosen) {
  CLI::App* command = trace.add_subcommand("info", "Says what a trace holds.");
  const auto scene = std::make_shared<SceneArguments>();
  scene->add_trace_to(*command);
  command->callback([=, &chosen] {
    chosen = [=] {
      require_trace(*scene);
      fmt::print("{}", traces::trace_info(scene->load().stream));
      return kDone;
    };
  });
}

void add_replay(CLI::App& trace, Command& chosen) {
  CLI::App* command =
      trace.add_subcommand("replay", "Renders a trace: the same as quadrille render F.qtrace.");
  const auto job = std::make_shared<RenderJob>();
  job->scene.add_trace_to(*command);
  job->add_to(*command);
  command->callback([=, &chosen] {
    chosen = [=] {
      require_trace(job->scene);
      return job->run();
    };
  });
}

}  // namespace

void add_trace(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("trace", "Records, inspects and replays the commands of a frame.");
  command->require_subcommand(0, 1);
  command->callback([&chosen] {
    if (!chosen) throw CLI::RequiredError("record, info or replay");
  });
  command->footer(R"(Examples:
  quadrille trace record city.gltf --camera 2 -o city.qtrace
  quadrille trace info city.qtrace
  quadrille trace replay city.qtrace --machine large --out city.png
A trace is self-contained: buffers, textures, shaders, size and view are in it (docs/trace_format.md).)");
  add_record(*command, chosen);
  add_info(*command, chosen);
  add_replay(*command, chosen);
}

}  // namespace quadrille::cli
