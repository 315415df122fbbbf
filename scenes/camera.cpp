/// Matrices are made in double and rounded once, so that the vertex shader is where precision is lost, as on a GPU.
#include "scenes/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "models/base/error.h"
#include "scenes/named_choice.h"

namespace quadrille::scenes {
namespace {

constexpr double kFramingFov = std::numbers::pi / 4;
constexpr double kUserFov = std::numbers::pi / 3;
constexpr double kMargin = 1.04;
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
  view[3] = glm::dvec4(-glm::dot(pose.right, pose.eye), -glm::dot(pose.up, pose.eye), -glm::dot(pose.backward, pose.eye), 1);
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

/// Axes for a camera at `eye` that looks against `backward`, its top toward +y (or -z when it looks straight up or down).
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
      visit(
          glm::dvec3((c & 1) != 0 ? box.high.x : box.low.x, (c & 2) != 0 ? box.high.y : box.low.y, (c & 4) != 0 ? box.high.z : box.low.z));
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

/// A pose carried around the vertical axis through `center` by a part of a turn, counter-clockwise seen from above.
CameraPose turned(const CameraPose& pose, const glm::dvec3& center, double turns) {
  if (turns == 0) return pose;
  const double angle = 2 * std::numbers::pi * turns, c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](const glm::dvec3& v) { return glm::dvec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x); };
  return {center + turn(pose.eye - center), turn(pose.right), turn(pose.up), turn(pose.backward)};
}

/// How far before the centre a camera with the axes of `pose` has to stand to hold the scene.
double framing_distance(const PlacedScene& scene, const CameraPose& pose, const glm::dvec3& center, double aspect) {
  const double tangent_y = std::tan(kFramingFov / 2) / kMargin, tangent_x = tangent_y * aspect;
  double distance = 0;
  for_each_corner(scene, [&](const glm::dvec3& corner) {
    const glm::dvec3 offset = corner - center;
    const double reach = std::max(std::abs(glm::dot(offset, pose.right)) / tangent_x, std::abs(glm::dot(offset, pose.up)) / tangent_y);
    distance = std::max(distance, glm::dot(offset, pose.backward) + reach);
  });
  return distance;
}

CameraPose framing_pose(const PlacedScene& scene, double aspect, bool orbiting) {
  const Bounds box = scene.bounds();
  const glm::dvec3 center = box.empty() ? glm::dvec3(0) : glm::dvec3(box.center());
  const CameraPose pose = upright(center, {0.55, 0.42, 1});
  double distance = 0;
  // A camera that goes around stays as far away as its worst place needs.
  const int places = orbiting ? kOrbitPlaces : 1;
  for (int i = 0; i < places; ++i)
    distance = std::max(distance, framing_distance(scene, turned(pose, center, static_cast<double>(i) / places), center, aspect));
  CameraPose placed = pose;
  placed.eye = center + pose.backward * (distance > 0 ? distance : 1.0);
  return placed;
}

View user_view(const PlacedScene& scene, const SceneOptions& options, double aspect) {
  const Bounds box = scene.bounds();
  const glm::dvec3 at = options.at ? glm::dvec3(*options.at) : box.empty() ? glm::dvec3(0) : glm::dvec3(box.center());
  const glm::dvec3 eye = options.eye ? glm::dvec3(*options.eye) : framing_pose(scene, aspect, options.orbit.has_value()).eye;
  const double distance = glm::length(eye - at);
  if (!std::isfinite(distance) || !(distance > 0)) throw user_error("camera: the eye is where it looks at ({}, {}, {})", at.x, at.y, at.z);
  const CameraPose pose = turned(upright(eye, eye - at), at, options.orbit.value_or(0));
  const auto [near, far] = depth_range(scene, pose);
  return finish(pose, perspective(kUserFov, aspect, near, far), false);
}

/// A file may hold a camera of pi and more, but should not. [glTF2.0 #reference-camera-perspective: yfov]
void require_field_of_view(const PlacedScene& scene, const Camera& camera) {
  if (camera.perspective && !(camera.yfov < std::numbers::pi)) {
    throw user_error("{}: cameras[{}]: yfov {} is outside 0..pi; --camera or --eye takes another", scene.data.name,
                     &camera - scene.at.cameras.data(), camera.yfov);
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
  if (camera.perspective) return finish(pose, perspective(camera.yfov, aspect, camera.near, camera.far), false);
  return finish(pose, orthographic(camera.half_height, aspect, camera.near, camera.far.value_or(camera.near + 1)), true);
}

const Camera* chosen_camera(const PlacedScene& scene, const SceneOptions& options) {
  if (options.camera < 0 && options.camera_name.empty()) {
    const auto placed = std::ranges::find_if(scene.at.cameras, [](const Camera& c) { return c.pose.has_value(); });
    return placed == scene.at.cameras.end() ? nullptr : &*placed;
  }
  std::vector<std::string> names;
  for (const Camera& camera : scene.at.cameras) names.push_back(camera.name);
  const std::string wanted = options.camera < 0 ? options.camera_name : std::to_string(options.camera);
  const std::optional<std::size_t> index = find_choice(names, wanted);
  if (!index)
    throw user_error("{}: camera '{}' does not exist; cameras: {}", scene.data.name, wanted.substr(0, 60), list_of_choices(names));
  if (!scene.at.cameras[*index].pose)
    throw user_error("{}: camera {} '{}' is not placed by any node of the scene", scene.data.name, *index, names[*index].substr(0, 60));
  return &scene.at.cameras[*index];
}

}  // namespace

View framing_view(const PlacedScene& scene, double aspect, std::optional<double> orbit) {
  const Bounds box = scene.bounds();
  const glm::dvec3 center = box.empty() ? glm::dvec3(0) : glm::dvec3(box.center());
  const CameraPose pose = turned(framing_pose(scene, aspect, orbit.has_value()), center, orbit.value_or(0));
  const auto [near, far] = depth_range(scene, pose);
  return finish(pose, perspective(kFramingFov, aspect, near, far), false);
}

View make_view(const PlacedScene& scene, const SceneOptions& options) {
  const double aspect = static_cast<double>(options.width) / options.height;
  if (options.eye || options.at) return user_view(scene, options, aspect);
  const Camera* camera = chosen_camera(scene, options);
  return camera != nullptr ? file_view(scene, *camera, options, aspect) : framing_view(scene, aspect, options.orbit);
}

}  // namespace quadrille::scenes
