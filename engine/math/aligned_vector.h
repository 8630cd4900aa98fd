// Numbers that begin on a cache line, so that no wide vector of them lies across two.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace engine {

template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  LineAllocator() = default;
  template <class Other>
  LineAllocator(const LineAllocator<Other>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* numbers, std::size_t) { ::operator delete(numbers, kLine); }
  bool operator==(const LineAllocator&) const { return true; }
};

using AlignedVector = std::vector<double, LineAllocator<double>>;

}  // namespace engine
