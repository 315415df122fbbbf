/// What a pass does with an attachment when it begins and when it ends. [VK1.3 #renderpass-load-operations,
/// #renderpass-store-operations]
#pragma once

#include <cstdint>

namespace quadrille::models {

inline constexpr int kMaxColorAttachments = 8;

enum class LoadOp : std::uint8_t {
  kClear,    ///< begins with the clear value
  kLoad,     ///< begins with what the image holds
  kDontCare  ///< begins with anything: with zeros, as a clear that costs as little
};
enum class StoreOp : std::uint8_t {
  kStore,   ///< the image holds what the pass drew
  kDiscard  ///< nobody will read it: nothing is written back
};

}  // namespace quadrille::models
