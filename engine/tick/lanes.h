// Four doubles to an instruction where the processor has it, as GCC and Clang both know
// them: the same operations in the same order as one after the other, so the same bits.
// A function that works on lanes is compiled twice, plainly and with [[gnu::target("avx2")]],
// from one PALPATE_INLINE template, and `has_wide_lanes` chooses when the program starts.
// Thread guarantee: pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>

namespace palpate {

inline constexpr std::size_t kLanes = 4;

// Passed by reference only: by value their ABI depends on the instructions. Kept as V4 too:
// what is copied in halves and read at once waits for both. A struct of them needs
// alignas(sizeof(V4)), which GCC forgets where it compiles for processors without lanes so wide.
using V4 [[gnu::vector_size(kLanes * sizeof(double))]] = double;
#define PALPATE_INLINE [[gnu::always_inline]] inline

PALPATE_INLINE void store(std::array<double, kLanes>& to, const V4& from) noexcept {
  std::memcpy(to.data(), &from, sizeof from);
}
inline bool has_wide_lanes() noexcept {
#ifdef __x86_64__
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

}  // namespace palpate
