// A vector of fixed capacity that lives on the stack: contact functions must not allocate.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>

namespace engine {

template <class T, int kCapacity>
class SmallVector {
 public:
  void push_back(const T& value) {
    assert(size_ < kCapacity && "the caller checks full() first");
    items_[static_cast<std::size_t>(size_++)] = value;
  }
  void clear() { size_ = 0; }
  void resize_down(int size) { size_ = size < size_ ? size : size_; }
  int size() const { return size_; }
  bool empty() const { return size_ == 0; }
  bool full() const { return size_ == kCapacity; }
  T& operator[](int i) { return items_[static_cast<std::size_t>(i)]; }
  const T& operator[](int i) const { return items_[static_cast<std::size_t>(i)]; }
  T* begin() { return items_.data(); }
  T* end() { return items_.data() + size_; }
  const T* begin() const { return items_.data(); }
  const T* end() const { return items_.data() + size_; }

 private:
  std::array<T, static_cast<std::size_t>(kCapacity)> items_{};
  int size_ = 0;
};

}  // namespace engine
