/// Matrices are made in double and rounded once, so that the vertex shader is where precision is lost, as on
/// a GPU.
#include "scenes/view/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double2.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "models/base/error.h"
#include "scenes/data/named_choice.h"
#include "scenes/view/scene_reach.h"

namespace quadrille::scenes {
namespace {

constexpr double kFramingFov = std::numbers::pi / 4;
constexpr double kUserFov = std::numbers::pi / 3;
constexpr double kFramed = 0.8;  // of the picture's height or width
// each is looked at 23 times [G: some hundredths of a second]
constexpr std::size_t kMostFramedPoints = std::size_t{1} << 20;
constexpr int kOrbitPlaces = 32;
constexpr double kNearestRatio = 1e-4;  // near plane over far plane, at least: keeps 32-bit depth useful

/// Camera axes in world space; the camera looks along -backward.
struct CameraPose {
  glm::dvec3 eye{0}, right{1, 0, 0}, up{0, 1, 0}, backward{0, 0, 1};
};

glm::dmat4 view_matrix(const CameraPose& pose) {
  glm::dmat4 view(1);
  for (int i = 0; i < 3; ++i) {
    view[i][0] = pose.right[i];
    view[i][1] = pose.up[i];
    view[i][2] = pose.backward[i];
  }
  view[3] = glm::dvec4(-glm::dot(pose.right, pose.eye), -glm::dot(pose.up, pose.eye),
                       -glm::dot(pose.backward, pose.eye), 1);
  return view;
}

/// [VK1.3 #vertexpostproc-clipping: 0 <= z <= w, y down]
glm::dmat4 perspective(double yfov, double aspect, double near, std::optional<double> far) {
  const double scale = 1 / std::tan(yfov / 2);
  glm::dmat4 p(0);
  p[0][0] = scale / aspect;
  p[1][1] = -scale;
  p[2][2] = far ? *far / (near - *far) : -1;
  p[2][3] = -1;
  p[3][2] = far ? *far * near / (near - *far) : -near;
  return p;
}

glm::dmat4 orthographic(double half_height, double aspect, double near, double far) {
  glm::dmat4 p(1);
  p[0][0] = 1 / (half_height * aspect);
  p[1][1] = -1 / half_height;
  p[2][2] = 1 / (near - far);
  p[3][2] = near / (near - far);
  return p;
}

View finish(const CameraPose& pose, const glm::dmat4& projection, bool is_orthographic) {
  View view;
  view.view_projection = glm::mat4(projection * view_matrix(pose));
  view.eye = glm::vec3(pose.eye);
  view.right = glm::vec3(pose.right);
  view.up = glm::vec3(pose.up);
  view.toward_viewer = glm::vec3(pose.backward);
  view.orthographic = is_orthographic;
  return view;
}

/// Axes for a camera at `eye` that looks against `backward`, its top toward +y (or -z when it looks straight
/// up or down).
CameraPose upright(const glm::dvec3& eye, const glm::dvec3& backward) {
  CameraPose pose;
  pose.eye = eye;
  pose.backward = glm::normalize(backward);
  const glm::dvec3 top = std::abs(pose.backward.y) > 0.9999 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
  pose.right = glm::normalize(glm::cross(top, pose.backward));
  pose.up = glm::cross(pose.backward, pose.right);
  return pose;
}

template <class Visit>
void for_each_corner(const PlacedScene& scene, const Visit& visit) {
  scene.visit_boxes([&](const Bounds& box) {
    for (int c = 0; !box.empty() && c < 8; ++c)
      visit(glm::dvec3((c & 1) != 0 ? box.high.x : box.low.x, (c & 2) != 0 ? box.high.y : box.low.y,
                       (c & 4) != 0 ? box.high.z : box.low.z));
  });
}

/// Near and far planes that hold the scene as seen from `pose`.
std::pair<double, double> depth_range(const PlacedScene& scene, const CameraPose& pose) {
  double nearest = INFINITY, farthest = 0;
  for_each_corner(scene, [&](const glm::dvec3& corner) {
    const double depth = glm::dot(pose.eye - corner, pose.backward);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  });
  if (farthest <= 0) return {0.1, 100};
  const double far = farthest * 1.01;
  return {std::max(nearest * 0.99, far * kNearestRatio), far};
}

/// A pose carried around the vertical axis through `center` by a part of a turn, counter-clockwise seen from
/// above.
CameraPose turned(const CameraPose& pose, const glm::dvec3& center, double turns) {
  if (turns == 0) return pose;
  const double angle = 2 * std::numbers::pi * turns, c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](const glm::dvec3& v) {
    return glm::dvec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
  };
  return {center + turn(pose.eye - center), turn(pose.right), turn(pose.up), turn(pose.backward)};
}

/// A camera that frames the scene, and the part of its picture plane that it shows: what is middle, in
/// tangents right and up of the view direction.
struct Framing {
  CameraPose pose;
  glm::dvec2 middle{0};
};

/// How far back the eye has to be for the scene to lie within each side of the picture: a point does when it
/// is within the plane through the eye and that side. Right, left, upper, lower; `half` is half the picture
/// in tangents. Over all places of an orbit.
Reaches distances(const SceneReach& reach, const CameraPose& pose, const glm::dvec3& center, int places,
                  const glm::dvec2& middle, const glm::dvec2& half) {
  const glm::dvec2 high = half + middle, low = half - middle;
  Reaches most;
  most.fill(-INFINITY);
  for (int i = 0; i < places; ++i) {
    const CameraPose p = turned(pose, center, static_cast<double>(i) / places);
    const Reaches reaches = reach({p.backward + p.right / high.x, p.backward - p.right / low.x,
                                   p.backward + p.up / high.y, p.backward - p.up / low.y});
    for (std::size_t d = 0; d < most.size(); ++d) most[d] = std::max(most[d], reaches[d]);
  }
  return most;
}

double side(double a, double b) { return a > b ? 1 : a < b ? -1 : 0; }

/// The middle of what the scene takes of the picture plane, seen from `distance` away: each of its sides by
/// halving what is left.
glm::dvec2 middle_of(const SceneReach& reach, const CameraPose& pose, const glm::dvec3& center, int places,
                     const glm::dvec2& half, double distance) {
  constexpr int kHalvings = 10;
  Reaches slope{}, step{half.x, half.x, half.y, half.y};
  for (int i = 0; i < kHalvings; ++i) {
    Reaches most;
    most.fill(-INFINITY);
    for (int k = 0; k < places; ++k) {
      const CameraPose p = turned(pose, center, static_cast<double>(k) / places);
      const Reaches reaches = reach({p.right + slope[0] * p.backward, slope[1] * p.backward - p.right,
                                     p.up + slope[2] * p.backward, slope[3] * p.backward - p.up});
      for (std::size_t d = 0; d < most.size(); ++d) most[d] = std::max(most[d], reaches[d]);
    }
    for (std::size_t d = 0; d < most.size(); ++d)
      slope[d] += step[d] * side(most[d], slope[d] * distance), step[d] /= 2;
  }
  return {places > 1 ? 0 : (slope[0] - slope[1]) / 2, (slope[2] - slope[3]) / 2};
}

/// The eye is on the line from the centre along the pose's view direction. The picture is shifted, as by a
/// shift lens, until opposite sides ask for one distance, by halving what is left; a camera that goes around
/// keeps the centre in the middle from left to right.
Framing framed(const PlacedScene& scene, const CameraPose& pose, const glm::dvec3& center, double aspect,
               int places) {
  constexpr int kHalvings = 12;
  const SceneReach reach(scene, center, kMostFramedPoints / static_cast<std::size_t>(places));
  const double tangent = std::tan(kFramingFov / 2) * kFramed;
  const glm::dvec2 half(tangent * aspect, tangent);
  Framing framing{pose};
  glm::dvec2 step = half * 0.45;
  if (places > 1) step.x = 0;
  Reaches d = distances(reach, pose, center, places, framing.middle, half);
  for (int i = 0; i < kHalvings; ++i, step *= 0.5) {
    framing.middle += step * glm::dvec2(side(d[0], d[1]), side(d[2], d[3]));
    d = distances(reach, pose, center, places, framing.middle, half);
  }
  const double distance = std::max({d[0], d[1], d[2], d[3]});
  if (distance > 0) framing.middle = middle_of(reach, pose, center, places, half, distance);
  framing.pose.eye = center + pose.backward * (distance > 0 ? distance : 1.0);
  return framing;
}

Framing framing(const PlacedScene& scene, double aspect, bool orbiting) {
  const Bounds box = scene.bounds();
  const glm::dvec3 center = box.empty() ? glm::dvec3(0) : glm::dvec3(box.center());
  return framed(scene, upright(center, {0.55, 0.42, 1}), center, aspect, orbiting ? kOrbitPlaces : 1);
}

View user_view(const PlacedScene& scene, const SceneOptions& options, double aspect) {
  const Bounds box = scene.bounds();
  const glm::dvec3 at = options.at    ? glm::dvec3(*options.at)
                        : box.empty() ? glm::dvec3(0)
                                      : glm::dvec3(box.center());
  const glm::dvec3 eye =
      options.eye ? glm::dvec3(*options.eye) : framing(scene, aspect, options.orbit.has_value()).pose.eye;
  const double distance = glm::length(eye - at);
  if (!std::isfinite(distance) || !(distance > 0))
    throw user_error("camera: the eye is where it looks at ({}, {}, {})", at.x, at.y, at.z);
  const CameraPose pose = turned(upright(eye, eye - at), at, options.orbit.value_or(0));
  const auto [near, far] = depth_range(scene, pose);
  return finish(pose, perspective(kUserFov, aspect, near, far), false);
}

/// A file may hold a camera of pi and more, but should not. [glTF2.0 #reference-camera-perspective: yfov]
void require_field_of_view(const PlacedScene& scene, const Camera& camera) {
  if (camera.perspective && !(camera.yfov < std::numbers::pi)) {
    throw user_error("{}: cameras[{}]: yfov {} is outside 0..pi; --camera or --eye takes another",
                     scene.data.name, &camera - scene.at.cameras.data(), camera.yfov);
  }
}

/// The node's pose without its scale, which glTF gives no meaning for a camera. [glTF2.0 #cameras]
View file_view(const PlacedScene& scene, const Camera& camera, const SceneOptions& options, double aspect) {
  require_field_of_view(scene, camera);
  const glm::dmat4 world{glm::mat4(*camera.pose)};
  const glm::dvec3 z(world[2]), y(world[1]);
  if (!(glm::length(z) > 0) || !(glm::length(glm::cross(y, z)) > 0))
    throw user_error("{}: camera '{}': its node's matrix is singular", scene.data.name, camera.name);
  CameraPose pose;
  pose.eye = glm::dvec3(world[3]);
  pose.backward = glm::normalize(z);
  pose.right = glm::normalize(glm::cross(y, z));
  pose.up = glm::cross(pose.backward, pose.right);
  if (options.orbit) {
    const Bounds box = scene.bounds();
    pose = turned(pose, box.empty() ? glm::dvec3(0) : glm::dvec3(box.center()), *options.orbit);
  }
  if (camera.perspective)
    return finish(pose, perspective(camera.yfov, aspect, camera.near, camera.far), false);
  return finish(pose,
                orthographic(camera.half_height, aspect, camera.near, camera.far.value_or(camera.near + 1)),
                true);
}

const Camera* chosen_camera(const PlacedScene& scene, const SceneOptions& options) {
  if (options.camera < 0 && options.camera_name.empty()) {
    const auto placed =
        std::ranges::find_if(scene.at.cameras, [](const Camera& c) { return c.pose.has_value(); });
    return placed == scene.at.cameras.end() ? nullptr : &*placed;
  }
  std::vector<std::string> names;
  for (const Camera& camera : scene.at.cameras) names.push_back(camera.name);
  const std::string wanted = options.camera < 0 ? options.camera_name : std::to_string(options.camera);
  const std::optional<std::size_t> index = find_choice(names, wanted);
  if (!index)
    throw user_error("{}: camera '{}' does not exist; cameras: {}", scene.data.name, wanted.substr(0, 60),
                     list_of_choices(names));
  if (!scene.at.cameras[*index].pose)
    throw user_error("{}: camera {} '{}' is not placed by any node of the scene", scene.data.name, *index,
                     names[*index].substr(0, 60));
  return &scene.at.cameras[*index];
}

}  // namespace

View framing_view(const PlacedScene& scene, double aspect, std::optional<double> orbit) {
  const Bounds box = scene.bounds();
  const glm::dvec3 center = box.empty() ? glm::dvec3(0) : glm::dvec3(box.center());
  const Framing placed = framing(scene, aspect, orbit.has_value());
  const CameraPose pose = turned(placed.pose, center, orbit.value_or(0));
  const auto [near, far] = depth_range(scene, pose);
  glm::dmat4 projection = perspective(kFramingFov, aspect, near, far);
  projection[2][0] = projection[0][0] * placed.middle.x;
  projection[2][1] = projection[1][1] * placed.middle.y;
  return finish(pose, projection, false);
}

View make_view(const PlacedScene& scene, const SceneOptions& options) {
  const double aspect = static_cast<double>(options.width) / options.height;
  if (options.eye || options.at) return user_view(scene, options, aspect);
  const Camera* camera = chosen_camera(scene, options);
  return camera != nullptr ? file_view(scene, *camera, options, aspect)
                           : framing_view(scene, aspect, options.orbit);
}

}  // namespace quadrille::scenes
