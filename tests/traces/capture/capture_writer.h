/// Writes files of gfxreconstruct, call by call, so that tests have captures that no other program made.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace quadrille::capture {

enum class Packing : std::uint8_t { kPlain = 0, kLz4 = 1, kZstd = 3 };

class CaptureWriter {
 public:
  explicit CaptureWriter(Packing packing = Packing::kPlain);
  /// A call by its name without "vk". Parameters and members that are not given are 0 or null; sType is the
  /// structure's own; what is pointed to is given as an array, or as what it is if there is one.
  void call(std::string_view name, const nlohmann::json& parameters);
  /// A call that is written as these bytes.
  void raw_call(std::uint32_t id, std::span<const std::byte> parameters);
  void fill_memory(std::uint64_t memory, std::uint64_t offset, std::span<const std::byte> bytes);
  void init_image(std::uint64_t image, std::span<const std::byte> bytes);
  /// Of a device of Mesa's: a CPU if it is lavapipe, else a GPU.
  void device_properties(bool lavapipe);
  /// The file so far.
  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  void block(std::uint32_t type, std::span<const std::byte> head, std::span<const std::byte> body,
             bool names_size);
  Packing packing_;
  std::vector<std::byte> bytes_;
};

/// The number of a call by its name.
[[nodiscard]] std::uint32_t call_number(std::string_view name);

}  // namespace quadrille::capture
