/// Vertex attributes in formats that the vertex fetch does not read: expanded to one that it does, as a
/// buffer of their own. (docs/deviations.md#D172)
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::capture {

/// The format that an attribute of a VkFormat is expanded to; `kUndefined` if it cannot be.
[[nodiscard]] traces::Format expanded_attribute_format(std::uint32_t format);

/// Where the attribute lies in a buffer.
struct AttributeSource {
  std::uint32_t format = 0;  ///< VkFormat
  std::uint64_t offset = 0;  ///< of the first one
  std::uint32_t stride = 0;
};
/// As many as the buffer holds, one after the other.
[[nodiscard]] std::vector<std::byte> expanded_attributes(std::span<const std::byte> buffer,
                                                         const AttributeSource& source);

}  // namespace quadrille::capture
