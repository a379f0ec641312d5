// Vectors of four doubles (GCC and Clang extensions). The operations and their order are those of four scalars, so the
// results are bit-identical. A function on vectors is compiled twice from one PALPATE_INLINE template, plainly and with
// [[gnu::target("avx2")]]; `has_wide_lanes` selects one at the start of the program.
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>

namespace palpate {

inline constexpr std::size_t kLanes = 4;

// Passed by reference only, because by value the ABI depends on the instruction set. Arrays of it are stored as V4,
// because a load of a vector that was stored in halves stalls. A struct with V4 members needs alignas(sizeof(V4)),
// which GCC omits when it compiles for processors without such vectors.
using V4 [[gnu::vector_size(kLanes * sizeof(double))]] = double;
#define PALPATE_INLINE [[gnu::always_inline]] inline

inline bool has_wide_lanes() noexcept {
#ifdef __x86_64__
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

}  // namespace palpate
