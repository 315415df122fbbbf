#include "scenes/data/scene_data.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "models/base/error.h"

namespace quadrille::scenes {

float Bounds::radius() const { return empty() ? 0.0F : 0.5F * glm::length(high - low); }

void Bounds::add(const glm::vec3& point) {
  low = glm::min(low, point);
  high = glm::max(high, point);
}

void Bounds::add(const Bounds& box) {
  if (box.empty()) return;
  add(box.low);
  add(box.high);
}

Bounds Bounds::transformed(const glm::mat4& matrix) const {
  Bounds result;
  if (empty()) return result;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 point{(corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                          (corner & 4) != 0 ? high.z : low.z};
    result.add(glm::vec3(matrix * glm::vec4(point, 1)));
  }
  return result;
}

namespace {

/// Every vertex moves by a weighted sum of deltas, each within its reach.
Bounds morphed(Bounds box, const Primitive& primitive, const std::vector<float>& weights) {
  if (box.empty()) return box;
  for (std::size_t i = 0; i < std::min(weights.size(), primitive.targets.size()); ++i) {
    const Bounds& reach = primitive.targets[i].reach;
    if (weights[i] == 0 || reach.empty()) continue;
    box.low += glm::min(glm::vec3(0), glm::min(weights[i] * reach.low, weights[i] * reach.high));
    box.high += glm::max(glm::vec3(0), glm::max(weights[i] * reach.low, weights[i] * reach.high));
  }
  return box;
}

glm::mat4 matrix_of(const JointMatrix& rows) {
  return glm::transpose(glm::mat4(rows[0], rows[1], rows[2], glm::vec4(0, 0, 0, 1)));
}

}  // namespace

/// A skinned vertex is a mean of where its joints would put it, each within its joint's moved box.
void SceneData::visit_model_boxes(const Instance& instance, const VisitModelBox& visit) const {
  const Primitive& primitive = primitives[instance.primitive];
  if (instance.pose < 0) return visit(primitive.bounds, glm::mat4(1));
  const Pose& pose = poses[static_cast<std::size_t>(instance.pose)];
  if (pose.joints.empty()) return visit(morphed(primitive.bounds, primitive, pose.weights), glm::mat4(1));
  for (std::size_t j = 0; j < std::min(pose.joints.size(), primitive.joint_boxes.size()); ++j)
    visit(morphed(primitive.joint_boxes[j], primitive, pose.weights), matrix_of(pose.joints[j]));
}

Bounds SceneData::model_box(const Instance& instance) const {
  if (instance.pose < 0) return primitives[instance.primitive].bounds;
  Bounds all;
  visit_model_boxes(instance,
                    [&](const Bounds& box, const glm::mat4& matrix) { all.add(box.transformed(matrix)); });
  return all;
}

Bounds SceneData::box(const Instance& instance) const { return PlacedScene(*this).box(instance); }

Bounds SceneData::bounds() const { return PlacedScene(*this).bounds(); }

void PlacedScene::visit_boxes(const Instance& instance, const VisitBox& visit) const {
  const Bounds model = data.model_box(instance);
  if (instance.copies < 0) return visit(model.transformed(glm::mat4(instance.world)));
  for (const glm::dmat4& copy : at.copies[static_cast<std::size_t>(instance.copies)])
    visit(model.transformed(glm::mat4(copy)));
}

void PlacedScene::visit_boxes(const VisitBox& visit) const {
  for (const Bounds& box : at.extent) visit(box);
  if (!at.extent.empty()) return;
  for (const Instance& instance : at.instances) visit_boxes(instance, visit);
}

Bounds PlacedScene::box(const Instance& instance) const {
  Bounds all;
  visit_boxes(instance, [&](const Bounds& one) { all.add(one); });
  return all;
}

Bounds PlacedScene::bounds() const {
  Bounds all;
  visit_boxes([&](const Bounds& one) { all.add(one); });
  return all;
}

SceneImage::SceneImage(std::string name, const std::shared_ptr<const TextureFile>& file)
    : name_(std::move(name)),
      size_({file->width, file->height}),
      unpack_([file] { return decoded_level(*file, 0); }),
      file_(file) {}

SceneImage::Source SceneImage::source() const {
  if (!packed()) return [pixels = pixels_] { return pixels; };
  return [name = name_, size = size(), unpack = unpack_] {
    auto pixels = std::make_shared<const Rgba8Image>(unpack());
    if (pixels->width != size.width || pixels->height != size.height)
      throw user_error("image '{}': its picture is {}x{}, its header says {}x{}", name, pixels->width,
                       pixels->height, size.width, size.height);
    return pixels;
  };
}

}  // namespace quadrille::scenes
