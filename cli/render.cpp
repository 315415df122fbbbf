/// `quadrille render`: one frame of a scene through the machine.
#include <memory>

#include "cli/command.h"
#include "cli/render_job.h"

namespace quadrille::cli {

void add_render(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "render", "Renders a frame, or several: the picture, its cycles, and where every unit's time went.");
  const auto job = std::make_shared<RenderJob>();
  job->scene.add_to(*command);
  job->scene.add_samples_to(*command);
  job->scene.add_queries_to(*command);
  job->scene.add_formats_to(*command);
  job->scene.add_transparency_to(*command);
  job->scene.add_compress_to(*command);
  job->add_to(*command);
  job->frames.add_to(*command);
  command->footer(R"(Examples:
  quadrille render builtin:triangle --size 320x240
      the table of figures alone
  quadrille render helmet.gltf --out helmet.png --stats helmet.json
      with the picture and all figures as JSON
  quadrille render helmet.gltf --report helmet.html
      where the time went, as a page for a browser
  quadrille render city.gltf --eye 10,4,0 --at 0,2,0 --fidelity functional --out view.png
      no machine, only the picture: the fast way to look for a view
  quadrille render walk.glb --time 0.4 --out step.png
      0.4 seconds into its animation
  quadrille render walk.glb --frames 24 --out walk_##.png --stats walk.json
      24 frames over the animation: a picture and a row of figures each
  quadrille render city.gltf --machine small --set l2.cache_lines=4096 --set link.client_to_l2.latency=20
      another machine, two of its parameters changed
  quadrille render city.gltf -q --stats - | jq .frame.cycles
      figures to another program
  quadrille render teapot.gltf --shading gouraud --out teapot.png
      as a lecture draws it: lit at the vertices
  quadrille render cube.gltf --frag toon.frag --out toon.png
      with a fragment shader of your own
Files are checked before the simulation starts, and appear whole or not at all.)");
  command->callback([job, &chosen] { chosen = [job] { return job->run(); }; });
}

}  // namespace quadrille::cli
