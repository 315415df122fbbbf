/// Numbers that name one of several, each kind a type of its own, so that the number of a draw is not taken
/// for that of a pass.
///
/// An id is made from a number explicitly and gives it back by `index()`, for containers. It can be compared
/// and hashed, but there is no arithmetic with it.
#pragma once

#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace quadrille::models {

template <class Tag>
class Id {
 public:
  constexpr Id() = default;
  template <std::integral Number>
  constexpr explicit Id(Number number) : number_(static_cast<std::uint32_t>(number)) {}
  [[nodiscard]] constexpr std::uint32_t index() const { return number_; }
  // The check takes what the compiler makes of this for a null pointer.
  friend constexpr auto operator<=>(const Id&, const Id&) = default;  // NOLINT(modernize-use-nullptr)

 private:
  std::uint32_t number_ = 0;
};

/// A draw and a pass of the frame, from 0 in the order of the command stream.
using DrawId = Id<struct DrawTag>;
using PassId = Id<struct PassTag>;
/// A part of the screen that has a depth unit and a ROP of its own.
using PartitionId = Id<struct PartitionTag>;
/// A place for a fragment warp, among those of its partition.
using WarpSlotId = Id<struct WarpSlotTag>;

}  // namespace quadrille::models

template <class Tag>
struct std::hash<quadrille::models::Id<Tag>> {
  std::size_t operator()(quadrille::models::Id<Tag> id) const noexcept {
    return std::hash<std::uint32_t>{}(id.index());
  }
};
