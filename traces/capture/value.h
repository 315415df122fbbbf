/// The parameters of a call as a tree of values, read by the tables of schema.h.
///
/// A value says nothing of what it should be: who asks for a number, a member or an element that is not there
/// gets a `UserError` with the member's name, to which the reader of the file adds the block and the call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traces/capture/schema.h"

namespace quadrille::capture {

class Value {
 public:
  /// A pointer that was null, or whose data was not written.
  [[nodiscard]] bool null() const { return shape_ == Shape::kNull; }
  /// Elements of an array; 1 of a single number or structure, 0 of null.
  [[nodiscard]] std::size_t size() const;

  [[nodiscard]] std::uint64_t u64(std::size_t i = 0) const { return number(i); }
  [[nodiscard]] std::uint32_t u32(std::size_t i = 0) const { return static_cast<std::uint32_t>(number(i)); }
  [[nodiscard]] std::int32_t i32(std::size_t i = 0) const { return static_cast<std::int32_t>(number(i)); }
  [[nodiscard]] float f32(std::size_t i = 0) const;
  [[nodiscard]] bool flag(std::size_t i = 0) const { return number(i) != 0; }
  [[nodiscard]] std::string text() const;
  /// An array of numbers as it lies in the file.
  [[nodiscard]] std::span<const std::byte> bytes() const;

  /// A member of the structure, or of the one structure that is pointed to.
  [[nodiscard]] const Value& operator[](std::string_view member) const;
  /// Is there a member of that name?
  [[nodiscard]] bool has(std::string_view member) const;
  /// A structure of an array.
  [[nodiscard]] const Value& at(std::size_t i) const;
  /// The structure of that VkStructureType behind this one's pNext; null if there is none.
  [[nodiscard]] const Value* next(std::uint32_t type) const;

 private:
  friend class Decoder;
  enum class Shape : std::uint8_t { kNull, kNumbers, kText, kStructure, kList };
  [[nodiscard]] std::uint64_t number(std::size_t i) const;
  [[nodiscard]] std::string_view name() const { return name_; }

  Shape shape_ = Shape::kNull;
  std::uint8_t bytes_each_ = 0;  ///< of numbers
  std::string_view name_;        ///< of the member
  const Structure* structure_ = nullptr;
  std::span<const std::byte> data_;  ///< numbers, or a text
  std::vector<Value> parts_;         ///< members, or elements
};

/// Reads the parameters of a call, all of `bytes`, which must outlive the value. Throws `UserError`.
[[nodiscard]] Value read_parameters(const Structure& call, std::span<const std::byte> bytes);

}  // namespace quadrille::capture
