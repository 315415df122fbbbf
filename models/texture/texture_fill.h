/// A texture whose texels come when something first samples it. Address and layout stand from the start, so
/// no unit can tell when they came.
#pragma once

#include <functional>
#include <utility>

namespace quadrille::models {

class TextureFill {
 public:
  /// `bring` writes the texels of every level to device memory. What it throws leaves the texture without
  /// them.
  explicit TextureFill(std::function<void()> bring) : bring_(std::move(bring)) {}
  [[nodiscard]] bool pending() const { return bring_ != nullptr; }
  /// Brings the texels, the first time. Before the first read of any of them.
  void need() {
    if (!pending()) return;
    bring_();
    bring_ = nullptr;
  }

 private:
  std::function<void()> bring_;
};

}  // namespace quadrille::models
