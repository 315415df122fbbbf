/// The payload of a chunk as values one after the other: what writes them, and what reads them back and
/// trusts nothing. Both have the same members, so that one list of fields serves both ways.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "models/base/error.h"
#include "traces/command_stream.h"

namespace quadrille::traces {

static_assert(std::endian::native == std::endian::little,
              "the trace file is little-endian and is copied as it lies in memory");

// of one table: bounds what a hostile count can make us allocate
inline constexpr std::uint64_t kMaxElements = std::uint64_t{1} << 23;

class Writer {
 public:
  static constexpr bool kReads = false;
  explicit Writer(std::uint32_t version) : version_(version) {}
  [[nodiscard]] std::uint32_t version() const { return version_; }
  template <class T>
  void number(const T& value) {
    append(&value, sizeof(T));
  }
  template <class E>
  void choice(const E& value, E) {
    number(static_cast<std::uint8_t>(value));
  }
  template <class T>
  void array(const std::vector<T>& values) {
    number<std::uint64_t>(values.size());
    append(values.data(), values.size() * sizeof(T));
  }
  void text(const std::string& value) {
    number<std::uint64_t>(value.size());
    append(value.data(), value.size());
  }
  template <class T, class F>
  void table(std::vector<T>& values, F&& element) {
    number<std::uint64_t>(values.size());
    for (T& value : values) element(value);
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size) {
    const std::size_t end = bytes_.size();
    bytes_.resize(end + size);
    if (size > 0) std::memcpy(bytes_.data() + end, data, size);
  }
  std::uint32_t version_;
  std::vector<std::byte> bytes_;
};

/// A target of files of version 1: one colour and one depth attachment, of passes that clear and store them.
struct OldTarget {
  std::uint32_t width = 0, height = 0;
  Format color = Format::kUndefined, depth = Format::kUndefined;
};

class Reader {
 public:
  static constexpr bool kReads = true;
  using OldTargets = std::vector<std::pair<Index, Index>>;
  Reader(std::span<const std::byte> bytes, std::uint32_t version, const std::string& place,
         const OldTargets& targets)
      : bytes_(bytes), place_(place), targets_(targets), version_(version) {}
  [[nodiscard]] std::uint32_t version() const { return version_; }
  /// Images of a target, in a file of version 1.
  [[nodiscard]] std::pair<Index, Index> target(Index index) const {
    if (index >= targets_.size()) throw user_error("{}: render target {} does not exist", place_, index);
    return targets_[index];
  }

  template <class T>
  void number(T& value) {
    copy(&value, sizeof(T));
  }
  void number(bool& value) {
    std::uint8_t byte = 0;
    copy(&byte, 1);
    if (byte > 1) throw user_error("{}: byte {} is {} where 0 or 1 is due", place_, at_ - 1, byte);
    value = byte == 1;
  }
  template <class E>
  void choice(E& value, E last) {
    std::uint8_t byte = 0;
    copy(&byte, 1);
    if (byte > static_cast<std::uint8_t>(last))
      throw user_error("{}: byte {} is {}; the largest value there is {}", place_, at_ - 1, byte,
                       static_cast<int>(last));
    value = static_cast<E>(byte);
  }
  template <class T>
  void array(std::vector<T>& values) {
    const std::uint64_t count = length(sizeof(T));
    values.resize(count);
    copy(values.data(), count * sizeof(T));
  }
  void text(std::string& value) {
    value.resize(length(1));
    copy(value.data(), value.size());
  }
  template <class T, class F>
  void table(std::vector<T>& values, F&& element) {
    const std::uint64_t count = length(1);
    if (count > kMaxElements)
      throw user_error("{}: {} elements, the limit is {}", place_, count, kMaxElements);
    values.clear();
    for (std::uint64_t i = 0; i < count; ++i) element(values.emplace_back());
  }
  void finish() const {
    if (at_ != bytes_.size()) throw user_error("{}: {} bytes follow its end", place_, bytes_.size() - at_);
  }
  [[nodiscard]] const std::string& place() const { return place_; }

 private:
  /// Reads a count and makes sure that so many elements of `size` bytes can still follow, before anyone
  /// allocates for them.
  std::uint64_t length(std::size_t size) {
    std::uint64_t count = 0;
    number(count);
    if (count > (bytes_.size() - at_) / size)
      throw user_error("{}: {} elements are announced at byte {} where {} bytes remain", place_, count,
                       at_ - 8, bytes_.size() - at_);
    return count;
  }
  void copy(void* target, std::size_t size) {
    if (size > bytes_.size() - at_)
      throw user_error("{}: ends at byte {}, inside a value", place_, bytes_.size());
    if (size > 0) std::memcpy(target, bytes_.data() + at_, size);
    at_ += size;
  }
  std::span<const std::byte> bytes_;
  const std::string& place_;
  const OldTargets& targets_;
  std::uint32_t version_;
  std::size_t at_ = 0;
};

}  // namespace quadrille::traces
