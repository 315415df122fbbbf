/// Numbers of descriptors: a binding of a descriptor set, and of a binding that is an array, an element.
///
/// Both are one number: the binding, and the element above it. So a binding that is no array has its own
/// number, and every element of an array is a binding for itself. [VK1.3 #interfaces-resources-setandbinding]
#pragma once

#include <cstdint>
#include <string>

namespace quadrille::models {

inline constexpr unsigned kBindingBits = 16;
inline constexpr std::uint32_t kMaxBinding = 0xffff;
/// Elements that a shader's array of descriptors may have. A program chooses among them by branches.
inline constexpr std::uint32_t kMaxDescriptorElements = 256;

[[nodiscard]] constexpr std::uint32_t element_binding(std::uint32_t binding, std::uint32_t element) {
  return binding | element << kBindingBits;
}
[[nodiscard]] constexpr std::uint32_t binding_of(std::uint32_t number) { return number & kMaxBinding; }
[[nodiscard]] constexpr std::uint32_t element_of(std::uint32_t number) { return number >> kBindingBits; }

/// "3", or of an array's element "3[2]". Of an array, element 0 is shown as what is no array.
[[nodiscard]] inline std::string binding_text(std::uint32_t number) {
  std::string text = std::to_string(binding_of(number));
  if (element_of(number) != 0) text += "[" + std::to_string(element_of(number)) + "]";
  return text;
}

}  // namespace quadrille::models
