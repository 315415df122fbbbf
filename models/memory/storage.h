/// Memory that programs write: storage buffers, and the rules by which a frame's values stay independent of
/// the machine's timing.
///
/// Within a pass, invocations of programs run in any order. So what they do to one word must not depend on
/// it:
/// - of stores by several invocations the one that is last in API order stays (`Invocation` has that order);
/// - atomic operations may meet in any order; only the values that they return depend on it;
/// - a word that one invocation stores, and another one reads or updates by an atomic operation, is a race,
///   and so is one that is read and updated: a `UserError`, whichever comes first.
/// Passes follow each other, so a pass may read what earlier ones wrote.
///
/// An access outside of its buffer reads 0 or does nothing. [VK1.3 robustBufferAccess]
#pragma once

#include "models/memory/device_memory.h"

#include <compare>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::models {

/// One run of a program for a vertex or a fragment, in API order. A vertex may be run several times; all of
/// them are one invocation.
struct Invocation {
  std::uint64_t draw = 0;  ///< draw, stage, instance: `invocation_of_vertex`, `invocation_of_fragment`
  std::uint64_t work = 0;  ///< vertex, or primitive, pixel (below 2^14) and sample
  // The check takes what the compiler makes of this for a null pointer.
  friend auto operator<=>(const Invocation&, const Invocation&) = default;  // NOLINT(modernize-use-nullptr)
};
[[nodiscard]] constexpr Invocation invocation_of_vertex(std::uint32_t draw, std::uint32_t instance,
                                                        std::uint32_t vertex) {
  return {std::uint64_t{draw} << 33 | instance, vertex};
}
[[nodiscard]] constexpr Invocation invocation_of_fragment(std::uint32_t draw, std::uint32_t instance,
                                                          std::uint32_t primitive, std::uint16_t x,
                                                          std::uint16_t y, std::uint8_t sample = 0) {
  return {std::uint64_t{draw} << 33 | std::uint64_t{1} << 32 | instance,
          std::uint64_t{primitive} << 32 | std::uint64_t{y} << 18 | std::uint64_t{x} << 4 | sample};
}

enum class AtomicOp : std::uint8_t {
  kAdd,
  kIMin,
  kUMin,
  kIMax,
  kUMax,
  kAnd,
  kOr,
  kXor,
  kExchange,
  kCompareExchange
};

/// A range of a buffer that a program accesses.
struct StorageView {
  static constexpr std::uint32_t kReadOnly = 0xffffffffu;
  std::uint64_t address = 0;  ///< of its first byte, a multiple of 4
  std::uint32_t bytes = 0;
  std::uint32_t buffer = kReadOnly;  ///< what `watch` returned, of a buffer that programs write
};

class StorageMemory {
 public:
  explicit StorageMemory(DeviceMemory& memory) : memory_(memory) {}

  /// Names a buffer that programs of the frame write.
  [[nodiscard]] std::uint32_t watch(std::string name, std::uint64_t address, std::uint64_t bytes);

  /// Who accesses, and in which pass of the frame.
  struct Access {
    Invocation who;
    std::uint32_t pass = 0;
  };
  /// The word at `offset` bytes of the view, a multiple of 4.
  [[nodiscard]] std::uint32_t load(const StorageView& view, std::uint32_t offset, const Access& access);
  void store(const StorageView& view, std::uint32_t offset, std::uint32_t value, const Access& access);
  struct Update {
    AtomicOp op = AtomicOp::kAdd;
    std::uint32_t value = 0;
    std::uint32_t comparator = 0;  ///< kCompareExchange: writes only where it equals the old word
    /// Number of this update among its invocation's. An invocation's update that was done already (its vertex
    /// was run again) returns what it returned then.
    std::uint32_t ordinal = 0;
    bool may_repeat = false;
  };
  /// Updates the word and returns what it was.
  std::uint32_t update(const StorageView& view, std::uint32_t offset, const Update& update,
                       const Access& access);

 private:
  /// Nobody, one invocation or several.
  struct Group {
    Invocation one;  ///< the last one in API order
    std::uint8_t members = 0;
    void add(const Invocation& who);
    [[nodiscard]] bool has_other_than(const Invocation& who) const {
      return members > 1 || (members == 1 && one != who);
    }
  };
  /// What a pass did to a word.
  struct Word {
    std::uint32_t pass = 0;
    Group readers, writers, updaters;
  };
  struct Watched {
    std::string name;
    std::uint64_t address = 0;
    std::vector<Word> words;
  };
  [[nodiscard]] static bool inside(const StorageView& view, std::uint32_t offset) {
    return offset <= view.bytes && view.bytes - offset >= 4;
  }
  Word& word(const StorageView& view, std::uint32_t offset, std::uint32_t pass);
  [[noreturn]] void race(const StorageView& view, std::uint32_t offset, const char* what) const;

  DeviceMemory& memory_;
  std::deque<Watched> watched_;
  std::map<std::pair<Invocation, std::uint32_t>, std::uint32_t> returned_;  ///< of updates that may repeat
};

}  // namespace quadrille::models
