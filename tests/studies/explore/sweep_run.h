/// A sweep of a test with all that it takes to draw it.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.h"
#include "studies/explore/exploration.h"
#include "tests/studies/explore/sweep_folder.h"

namespace quadrille::studies::explore {

struct SweepRun {
  /// Draws a square picture of `scene`, whatever the sweep calls it.
  explicit SweepRun(const std::string& text, const std::string& scene = "builtin:triangle",
                    std::uint32_t side = 16)
      : sweep(folder.sweep(text)), space(sweep), plan(space.grid()) {
    scenes::SceneOptions options;
    options.width = options.height = side;
    scenes.push_back(with_hash(sweep.scenes.front(), scenes::load_scene(scene, options)));
    setting.version = "one";
  }
  [[nodiscard]] std::string results_file() const { return folder.file("r.db"); }
  SweepFolder folder;
  Sweep sweep;
  Space space;
  Plan plan;
  std::vector<LoadedScene> scenes;
  ExploreSetting setting;
};

}  // namespace quadrille::studies::explore
