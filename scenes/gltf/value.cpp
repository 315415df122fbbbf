#include "scenes/gltf/value.h"

#include <cmath>

#include "models/base/error.h"

namespace quadrille::scenes {

GltfObject::GltfObject(const std::string& path, std::string place, const tinygltf::Value& value)
    : path_(path), place_(std::move(place)), value_(value) {
  if (!value.IsObject()) throw user_error("{}: {}: an object is due", path_, place_);
}

void GltfObject::fail(const std::string& member, const std::string& reason) const {
  throw user_error("{}: {}.{}: {}", path_, place_, member, reason);
}

std::uint64_t GltfObject::integer(const char* name, std::uint64_t absent) const {
  if (!has(name)) return absent;
  const tinygltf::Value& member = value_.Get(name);
  const double number = member.IsNumber() ? member.GetNumberAsDouble() : -1;
  if (!(number >= 0 && number < 9007199254740992.0) || number != std::floor(number))
    fail(name, "a non-negative integer is due");
  return static_cast<std::uint64_t>(number);
}

std::uint64_t GltfObject::required_integer(const char* name) const {
  if (!has(name)) fail(name, "it is missing");
  return integer(name, 0);
}

int GltfObject::index(const char* name, std::size_t size) const {
  const std::uint64_t number = required_integer(name);
  if (number >= size) fail(name, fmt::format("{} does not exist (the file has {})", number, size));
  return static_cast<int>(number);
}

float GltfObject::number(const char* name, double absent) const {
  if (!has(name)) return static_cast<float>(absent);
  const tinygltf::Value& member = value_.Get(name);
  const float result = member.IsNumber() ? static_cast<float>(member.GetNumberAsDouble()) : NAN;
  if (!std::isfinite(result)) fail(name, "a finite number is due");
  return result;
}

float GltfObject::number(const char* name, double absent, double low, double high) const {
  const float result = number(name, absent);
  if (!(result >= static_cast<float>(low) && result <= static_cast<float>(high)))
    fail(name, fmt::format("{} is outside {}..{}", result, low, high));
  return result;
}

glm::vec3 GltfObject::color(const char* name, const glm::vec3& absent) const {
  if (!has(name)) return absent;
  const tinygltf::Value& member = value_.Get(name);
  if (!member.IsArray() || member.ArrayLen() != 3) fail(name, "three numbers are due");
  glm::vec3 result(0);
  for (int i = 0; i < 3; ++i) {
    const tinygltf::Value& part = member.Get(i);
    result[i] = part.IsNumber() ? static_cast<float>(part.GetNumberAsDouble()) : NAN;
    if (!std::isfinite(result[i]) || result[i] < 0) fail(name, "three finite numbers of 0 and more are due");
  }
  return result;
}

std::string GltfObject::text(const char* name, const std::string& absent) const {
  if (!has(name)) return absent;
  if (!value_.Get(name).IsString()) fail(name, "a string is due");
  return value_.Get(name).Get<std::string>();
}

GltfObject GltfObject::object(const char* name) const {
  return {path_, place_ + "." + name, value_.Get(name)};
}

}  // namespace quadrille::scenes
