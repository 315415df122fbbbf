/// The members of an extension's JSON object, with the place for errors.
#pragma once

#include <cstdint>
#include <string>

#include <glm/vec3.hpp>

#include "scenes/gltf/tiny_gltf.h"

namespace quadrille::scenes {

/// Reads an object of the file `path` at `place` ("materials[2].KHR_materials_ior"). Every function throws
/// `UserError` naming the member when its value is of another type, not finite or out of range. A member that
/// is absent has the default that is given.
class GltfObject {
 public:
  GltfObject(const std::string& path, std::string place, const tinygltf::Value& value);

  [[nodiscard]] bool has(const char* name) const { return value_.Has(name); }
  /// A non-negative integer below 2^53.
  [[nodiscard]] std::uint64_t integer(const char* name, std::uint64_t absent) const;
  [[nodiscard]] std::uint64_t required_integer(const char* name) const;
  /// A required index into one of the file's tables of `size` things.
  [[nodiscard]] int index(const char* name, std::size_t size) const;
  [[nodiscard]] float number(const char* name, double absent) const;
  /// A number within `low`..`high`.
  [[nodiscard]] float number(const char* name, double absent, double low, double high) const;
  /// Three numbers, none negative.
  [[nodiscard]] glm::vec3 color(const char* name, const glm::vec3& absent) const;
  [[nodiscard]] std::string text(const char* name, const std::string& absent) const;
  [[nodiscard]] GltfObject object(const char* name) const;
  [[nodiscard]] const tinygltf::Value& value() const { return value_; }
  [[nodiscard]] const std::string& place() const { return place_; }
  [[noreturn]] void fail(const std::string& member, const std::string& reason) const;

 private:
  const std::string& path_;
  std::string place_;
  const tinygltf::Value& value_;
};

}  // namespace quadrille::scenes
