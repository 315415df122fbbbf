/// `quadrille scenes` and `quadrille machines`: what comes with the program, and what a scene file has to
/// choose from.
#include <fmt/format.h>

#include <memory>

#include "cli/command.h"
#include "models/base/error.h"
#include "pipeline/machine/machine_config.h"
#include "scenes/builtin/builtin.h"
#include "scenes/contents.h"
#include "scenes/scene.h"

namespace quadrille::cli {
namespace {

int list_scenes() {
  for (const scenes::BuiltinScene& scene : scenes::builtin_scenes())
    fmt::print("builtin:{:<10} {}\n", scene.name, scene.description);
  return kDone;
}

/// Scenes, cameras and animations of a file, numbered as --scene, --camera and --animation take them.
int list_contents(const std::string& file) {
  const scenes::SceneContents contents = scenes::scene_contents(file);
  const auto named = [](const std::string& name) {
    return name.empty() ? std::string("(no name)") : fmt::format("'{}'", one_line(name));
  };
  fmt::print("{}: scenes {}, cameras {}, animations {}\n", one_line(file), contents.scenes.size(),
             contents.cameras.size(), contents.animations.size());
  for (std::size_t i = 0; i < contents.scenes.size(); ++i)
    fmt::print("  scene     {:>3}  {}{}\n", i, named(contents.scenes[i]),
               i == contents.own_scene ? ", drawn by default" : "");
  for (std::size_t i = 0; i < contents.cameras.size(); ++i)
    fmt::print("  camera    {:>3}  {}, {}\n", i, named(contents.cameras[i].name),
               contents.cameras[i].perspective ? "perspective" : "orthographic");
  for (std::size_t i = 0; i < contents.animations.size(); ++i) {
    const auto& animation = contents.animations[i];
    fmt::print("  animation {:>3}  {}, {:g} s{}\n", i, named(animation.name), animation.length,
               animation.tracks > 0 ? fmt::format(", {} channels", animation.tracks) : "");
  }
  return kDone;
}

/// The size of a machine in one line.
int list_machines() {
  for (const std::string& name : pipeline::machine_names()) {
    pipeline::MachineConfig config;
    pipeline::load_machine(config, name);
    const pipeline::GpuParams& gpu = config.gpu;
    fmt::print(
        "{:<10} cores {} (of {} SIMDs x {} lanes), partitions {}, memory channels {}, {:g} MHz, memory {:g} "
        "MHz\n",
        name, gpu.cores.value(), config.core.simds.value(), config.core.simd_lanes.value(),
        gpu.partitions.value(), gpu.channels.value(), gpu.clock_mhz.value(), gpu.memory_mhz.value());
  }
  return kDone;
}

}  // namespace

void add_lists(CLI::App& app, Command& chosen) {
  CLI::App* scenes = app.add_subcommand(
      "scenes", "Lists the built-in scenes, or the scenes, cameras and animations of a file.");
  const auto file = std::make_shared<std::string>();
  scenes->add_option("FILE", *file, "a .gltf or .glb file, or builtin:NAME");
  scenes->callback(
      [file, &chosen] { chosen = [file] { return file->empty() ? list_scenes() : list_contents(*file); }; });
  app.add_subcommand("machines", "Lists the machines that come with the program.")->callback([&chosen] {
    chosen = list_machines;
  });
}

}  // namespace quadrille::cli
