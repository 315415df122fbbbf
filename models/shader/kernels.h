/// How an operation on eight lanes becomes the function that executes an instruction on a warp: one instance
/// for each choice of operand kinds, modifiers, saturation and masking, so that nothing is decided in the
/// loop.
///
/// An operation is a struct with `apply`, the traits below, and no state.
#pragma once

#include "models/shader/decode.h"
#include "models/shader/lanes.h"

#include <array>
#include <utility>

namespace quadrille::models {

enum class SourceKind { kRow, kWord };

/// Reads one operand, eight lanes at a time.
template <SourceKind kKind, bool kModified>
class Source {
 public:
  Source(const DecodedOperand& operand, const ExecutionContext& x) {
    if constexpr (kModified) {
      keep_ = splat_word(operand.keep);
      flip_ = splat_word(operand.flip);
    }
    if constexpr (kKind == SourceKind::kWord) word_ = modified(splat_word(x.constants[operand.offset]));
    if constexpr (kKind == SourceKind::kRow) row_ = x.regs + operand.offset;
  }
  [[nodiscard]] Lanes group(int g) const {
    if constexpr (kKind == SourceKind::kWord) return word_;
    if constexpr (kKind == SourceKind::kRow) return modified(load_words(row_ + g * 32));
  }

 private:
  [[nodiscard]] Words modified(Words bits) const {
    if constexpr (kModified) return (bits & keep_) ^ flip_;
    return bits;
  }
  const std::byte* row_ = nullptr;
  Words word_{}, keep_{}, flip_{};
};

/// Clamps to [0, 1]; NaN gives 0 and -0 gives 0 (max returns its second operand then).
inline Lanes saturated(Floats x) {
  return Floats{_mm256_min_ps(_mm256_max_ps(x.v, splat(0.0f).v), splat(1.0f).v)};
}

/// Writes eight lanes of a row, all of them or those that execute.
template <bool kMasked>
void write_group(std::byte* row, int g, Lanes value, const ExecutionContext& x) {
  std::byte* at = row + g * 32;
  if constexpr (kMasked)
    value = choose(load_words(x.exec_lanes.data() + g * kGroupLanes), value, load_words(at));
  store(at, value);
}

/// The shape of a kernel as template argument: bits of KernelShape::constants, then modified, then saturate.
template <class Operation, unsigned kShape, bool kMasked>
void execute(const DecodedInstruction& d, ExecutionContext& x) {
  constexpr int kSources = Operation::kSources;
  constexpr bool kModified = ((kShape >> kSources) & 1u) != 0;
  constexpr bool kSaturate = ((kShape >> (kSources + 1)) & 1u) != 0;
  constexpr auto kKind = [](int i) {
    return ((kShape >> i) & 1u) != 0 ? SourceKind::kWord : SourceKind::kRow;
  };
  std::byte* const dst = x.regs + d.dst;
  const auto finish = [&](int g, Lanes value) {
    if constexpr (kSaturate) value = saturated(value);
    write_group<kMasked>(dst, g, value, x);
  };
  const Source<kKind(0), kModified> a(d.a, x);
  if constexpr (kSources == 1) {
    for (int g = 0; g < kWarpGroups; ++g) finish(g, Operation::apply(a.group(g)));
  } else {
    const Source<kKind(1), kModified> b(d.b, x);
    if constexpr (kSources == 2) {
      for (int g = 0; g < kWarpGroups; ++g) finish(g, Operation::apply(a.group(g), b.group(g)));
    } else {
      const Source<kSources == 3 ? kKind(2) : SourceKind::kRow, kModified> c(d.c, x);
      for (int g = 0; g < kWarpGroups; ++g) finish(g, Operation::apply(a.group(g), b.group(g), c.group(g)));
    }
  }
}

// What an operation may have besides plain sources.
template <int kCount>
struct IntegerOperation {
  static constexpr int kSources = kCount;
  static constexpr bool kModifiable = false, kSaturable = false;
};
template <int kCount>
struct FloatOperation {
  static constexpr int kSources = kCount;
  static constexpr bool kModifiable = true, kSaturable = true;
};
template <int kCount>
struct FloatTest {
  static constexpr int kSources = kCount;
  static constexpr bool kModifiable = true, kSaturable = false;
};

/// The kernel of `Operation` for a shape that the program checker allowed.
template <class Operation>
[[nodiscard]] Kernel kernel_of(const KernelShape& shape) {
  constexpr unsigned kShapes = 1u << (Operation::kSources + (Operation::kSaturable    ? 2
                                                             : Operation::kModifiable ? 1
                                                                                      : 0));
  static constexpr auto kTable = []<unsigned... kShape>(std::integer_sequence<unsigned, kShape...>) {
    return std::array<Kernel, kShapes>{
        Kernel{&execute<Operation, kShape, false>, &execute<Operation, kShape, true>}...};
  }
  (std::make_integer_sequence<unsigned, kShapes>{});
  const unsigned modified = shape.modified ? 1u : 0u, saturate = shape.saturate ? 2u : 0u;
  return kTable[shape.constants | ((modified | saturate) << Operation::kSources)];
}

}  // namespace quadrille::models
