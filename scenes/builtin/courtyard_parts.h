/// The parts of the built-in courtyard and its plan. Metres, y up, the fountain at the origin, the viewer
/// toward +z.
#pragma once

#include <array>
#include <numbers>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scenes/builtin/courtyard_shade.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/data/scene_data.h"

namespace quadrille::scenes::courtyard {

inline constexpr float kTurn = 2 * std::numbers::pi_v<float>;
inline constexpr float kWall = 11;  // inner face of the walls
inline constexpr float kWallHeight = 6.2F;
inline constexpr float kArcade = 8;     // axis of the columns
inline constexpr float kBay = 2;        // from column to column
inline constexpr float kSpring = 2.5F;  // where the arches start
inline constexpr float kTop = 3.9F;     // top of the arcade
inline constexpr float kColumn = 0.19F;
inline constexpr std::array<glm::vec3, 4> kTrees{
    {{-5.2F, 0, -3.6F}, {4.9F, 0, -4.4F}, {-6.1F, 0, 4.4F}, {5.6F, 0, 2.6F}}};
inline constexpr std::array<glm::vec3, 4> kLamps{
    {{-3.1F, 0, -2.6F}, {3.1F, 0, -2.6F}, {-3.1F, 0, 3.0F}, {3.1F, 0, 3.0F}}};
inline constexpr float kCrownHeight = 3.7F, kCrownRadius = 1.75F;

[[nodiscard]] glm::mat4 moved(const glm::vec3& by);
/// A turn around the y axis, in radians.
[[nodiscard]] glm::mat4 turned(float angle);

/// Radius and height along a turned shape, from its top (v = 0) to its foot (v = 1).
using Profile = std::vector<glm::vec2>;
/// Turns a profile around the y axis; seen from outside u goes right. The texture repeats `repeats` times
/// around and along.
void lathe(MeshBuilder& mesh, const Profile& profile, std::uint32_t sides, std::uint32_t rings,
           glm::vec2 repeats);
void sphere(MeshBuilder& mesh, const glm::vec3& center, float radius, std::uint32_t sides);

// courtyard_stone.cpp
void add_ground(SceneData& scene, const Shade& shade);
void add_walls(SceneData& scene, const Shade& shade);
void add_arcades(SceneData& scene);
void add_fountain(SceneData& scene);

// courtyard_garden.cpp
void add_trees(SceneData& scene);
/// Stone troughs with clipped hedges.
void add_planters(SceneData& scene);
void add_benches(SceneData& scene);
void add_lamps(SceneData& scene);

}  // namespace quadrille::scenes::courtyard
