/// The queue inside a unit: what waits between two of its actions, in order. A ring that grows when it is
/// full and keeps its memory, so that a steady flow allocates nothing and an unused queue costs nothing (a
/// machine of many units has tens of thousands of them).
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace quadrille::hw {

template <class T>
class Queue {
 public:
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Counted from the front.
  [[nodiscard]] T& operator[](std::size_t i) { return places_[place(i)]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return places_[place(i)]; }
  [[nodiscard]] T& front() { return places_[first_]; }
  [[nodiscard]] const T& front() const { return places_[first_]; }
  [[nodiscard]] T& back() { return (*this)[size_ - 1]; }
  [[nodiscard]] const T& back() const { return (*this)[size_ - 1]; }
  void push_back(T entry) {
    if (size_ == places_.size()) grow();
    places_[place(size_)] = std::move(entry);
    ++size_;
  }
  void pop_front() {
    first_ = place(1);
    --size_;
  }

 private:
  /// The number of places is a power of two.
  [[nodiscard]] std::size_t place(std::size_t i) const { return (first_ + i) & (places_.size() - 1); }
  void grow() {
    std::vector<T> more(places_.empty() ? 4 : 2 * places_.size());
    for (std::size_t i = 0; i < size_; ++i) more[i] = std::move((*this)[i]);
    places_.swap(more);
    first_ = 0;
  }

  std::vector<T> places_;
  std::size_t first_ = 0, size_ = 0;
};

}  // namespace quadrille::hw
