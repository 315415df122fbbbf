/// The materials and textures of the built-in courtyard.
#pragma once

#include "scenes/data/scene_data.h"

namespace quadrille::scenes::courtyard {

/// Material numbers, in the order in which `add_materials` adds them.
enum MaterialId : int {
  kPaving,
  kPlaster,
  kStone,
  kRoof,
  kBasin,
  kWater,
  kGold,
  kBark,
  kLeaves,
  kIron,
  kGlass,
  kLamp,
  kSky,
  kWood,
  kHedge,
  kMaterialCount
};

/// Paints all textures and fills `scene.materials`.
void add_materials(SceneData& scene);

}  // namespace quadrille::scenes::courtyard
