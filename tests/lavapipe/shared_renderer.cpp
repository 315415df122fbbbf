#include "tests/lavapipe/shared_renderer.h"

#include <catch2/catch.hpp>

#include <memory>

#include "models/base/error.h"

namespace quadrille::lavapipe {

VulkanRenderer* renderer() {
  static const std::unique_ptr<VulkanRenderer> opened = []() -> std::unique_ptr<VulkanRenderer> {
    try {
      return std::make_unique<VulkanRenderer>(false);
    } catch (const UserError& error) {
      WARN("skipped: " << error.what());
      return nullptr;
    }
  }();
  return opened.get();
}

}  // namespace quadrille::lavapipe
