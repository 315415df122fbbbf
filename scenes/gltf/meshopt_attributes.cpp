#include "scenes/gltf/meshopt_attributes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace quadrille::scenes {
namespace {

constexpr std::byte kHeader{0xa1};
constexpr std::size_t kGroup = 16, kMostOfBlock = 256, kBlockBytes = 8192, kLeastTail = 24;
// controls; 0 and 1 choose among the widths below
constexpr unsigned kZeros = 2, kLiteral = 3;
constexpr unsigned kBytes = 0, kHalves = 1, kWords = 2;                                  // modes of a channel
constexpr std::array<std::array<unsigned, 4>, 2> kWidths{{{0, 1, 2, 4}, {1, 2, 4, 8}}};  // bits of a delta

unsigned number(std::byte b) { return std::to_integer<unsigned>(b); }

/// A folded difference, 0, -1, 1, -2 ... from 0, 1, 2, 3 ...
template <class T>
T unfolded(T v) {
  return static_cast<T>((v & 1) != 0 ? ~(v >> 1) : v >> 1);
}

class Decoder {
 public:
  Decoder(std::span<const std::byte> source, std::size_t stride, std::vector<std::byte>& out)
      : source_(source), stride_(stride), out_(out), deltas_(stride * kMostOfBlock) {}

  bool run(std::uint64_t count) {
    const std::size_t tail = stride_ + stride_ / 4, padded = std::max(tail, kLeastTail);
    if (source_.size() < 1 + padded) return false;
    modes_ = source_.last(stride_ / 4);
    const std::span<const std::byte> first = source_.last(tail).first(stride_);
    last_.assign(first.begin(), first.end());
    source_ = source_.subspan(1, source_.size() - 1 - padded);
    if (!std::ranges::all_of(modes_, legal)) return false;
    const std::size_t most = std::min(kBlockBytes / stride_ & ~(kGroup - 1), kMostOfBlock);
    for (std::uint64_t done = 0; done < count;) {
      const auto elements = static_cast<std::size_t>(std::min<std::uint64_t>(most, count - done));
      if (!block(elements)) return false;
      undo_deltas(done * stride_, elements);
      done += elements;
    }
    return source_.empty();
  }

 private:
  /// The high half of a mode is the rotation of words; others have none.
  static bool legal(std::byte mode) {
    return (number(mode) & 15) == kWords || number(mode) == kBytes || number(mode) == kHalves;
  }

  bool take(std::size_t bytes, std::span<const std::byte>& part) {
    if (source_.size() < bytes) return false;
    part = source_.first(bytes);
    source_ = source_.subspan(bytes);
    return true;
  }

  bool block(std::size_t elements) {
    std::span<const std::byte> controls;
    if (!take(stride_ / 4, controls)) return false;
    for (std::size_t k = 0; k < stride_; ++k) {
      if (!position(number(controls[k / 4]) >> 2 * (k % 4) & 3, elements, &deltas_[k * kMostOfBlock]))
        return false;
    }
    return true;
  }

  /// The deltas of one byte of all elements of a block.
  bool position(unsigned control, std::size_t elements, std::byte* deltas) {
    std::fill_n(deltas, elements, std::byte{0});
    if (control == kZeros) return true;
    std::span<const std::byte> part;
    if (control == kLiteral) {
      if (!take(elements, part)) return false;
      std::ranges::copy(part, deltas);
      return true;
    }
    const std::size_t groups = (elements + kGroup - 1) / kGroup;
    if (!take((groups + 3) / 4, part)) return false;
    for (std::size_t g = 0; g < groups; ++g) {
      if (!group(kWidths[control][number(part[g / 4]) >> 2 * (g % 4) & 3], deltas + g * kGroup)) return false;
    }
    return true;
  }

  /// Sixteen deltas of so many bits; one of all ones stands for a byte that follows.
  bool group(unsigned bits, std::byte* deltas) {
    std::span<const std::byte> packed, byte;
    if (!take(kGroup * bits / 8, packed)) return false;
    if (bits == 8) std::ranges::copy(packed, deltas);
    if (bits == 0 || bits == 8) return true;
    const unsigned ones = (1u << bits) - 1, in_byte = 8 / bits;
    for (unsigned i = 0; i < kGroup; ++i) {
      const unsigned place =
          bits == 1
              ? i % in_byte
              : in_byte - 1 - i % in_byte;  // single bits begin with the lowest, others with the highest
      const unsigned value = number(packed[i / in_byte]) >> bits * place & ones;
      if (value == ones && !take(1, byte)) return false;
      deltas[i] = value == ones ? byte[0] : static_cast<std::byte>(value);
    }
    return true;
  }

  void undo_deltas(std::size_t at, std::size_t elements) {
    for (std::size_t i = 0; i < elements; ++i) {
      for (std::size_t k = 0; k < stride_; k += 4) {
        std::uint32_t delta = 0, value = 0;
        for (std::size_t b = 0; b < 4; ++b) delta |= number(deltas_[(k + b) * kMostOfBlock + i]) << 8 * b;
        std::memcpy(&value, &last_[k], 4);
        value = next(value, delta, number(modes_[k / 4]));
        std::memcpy(&last_[k], &value, 4);
      }
      std::memcpy(&out_[at + i * stride_], last_.data(), stride_);
    }
  }

  static std::uint32_t next(std::uint32_t value, std::uint32_t delta, unsigned mode) {
    if ((mode & 15) == kWords) return value ^ std::rotl(delta, static_cast<int>(mode >> 4));
    return mode == kBytes ? summed<std::uint8_t>(value, delta) : summed<std::uint16_t>(value, delta);
  }

  /// Each part by itself, without carry.
  template <class T>
  static std::uint32_t summed(std::uint32_t value, std::uint32_t delta) {
    std::uint32_t sum = 0;
    for (unsigned shift = 0; shift < 32; shift += 8 * sizeof(T)) {
      const T part = unfolded(static_cast<T>(delta >> shift));
      sum |= static_cast<std::uint32_t>(static_cast<T>((value >> shift) + part)) << shift;
    }
    return sum;
  }

  std::span<const std::byte> source_, modes_;
  std::size_t stride_;
  std::vector<std::byte>& out_;
  std::vector<std::byte> deltas_, last_;  ///< of a block, position by position; the element before
};

}  // namespace

bool is_attribute_stream_1(std::span<const std::byte> source) {
  return !source.empty() && source.front() == kHeader;
}

bool decode_attribute_stream_1(std::span<const std::byte> source, std::uint64_t count, std::uint64_t stride,
                               std::vector<std::byte>& out) {
  return is_attribute_stream_1(source) && Decoder(source, stride, out).run(count);
}

}  // namespace quadrille::scenes
