// Work of many equal parts, each by itself, on all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace render {

/// Calls part(i) for each i below `count`, in any order and at once. Parts must not throw and must not meet. All threads have ended
/// when it returns: processes may be forked after it.
template <class Part>
void in_parallel(std::size_t count, Part part) {
  const std::size_t threads = std::min<std::size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) part(i);
  };
  std::vector<std::jthread> others;
  for (std::size_t t = 1; t < threads; ++t) others.emplace_back(work);
  work();
}

}  // namespace render
