// Aligned memory for vectorised loops.
// Thread guarantee: slow side (allocates).
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>

namespace palpate {

// `count` values, set to zero, aligned to a cache line and to the widest vector.
template <typename T>
std::shared_ptr<T[]> aligned_array(std::size_t count) {
  constexpr std::align_val_t kAlignment{64};
  void* memory = ::operator new[](std::max<std::size_t>(1, count) * sizeof(T), kAlignment);
  T* first = static_cast<T*>(memory);
  std::uninitialized_value_construct_n(first, count);
  return std::shared_ptr<T[]>(first, [](T* p) { ::operator delete[](static_cast<void*>(p), kAlignment); });
}

}  // namespace palpate
