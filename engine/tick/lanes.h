// Vectors of four doubles (GCC and Clang extensions) and their exponential. Only arithmetic operations are used, in the
// order of four scalars, so that results are bit-identical on every processor.
// Thread guarantee: pure functions, wait-free.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate {

inline constexpr std::size_t kLanes = 4;

// Passed by reference only, because by value the ABI depends on the instruction set. Arrays of it are stored as V4,
// because a load of a vector that was stored in halves stalls. A struct with V4 members needs alignas(sizeof(V4)),
// which GCC omits when it compiles for processors without such vectors.
using V4 [[gnu::vector_size(kLanes * sizeof(double))]] = double;
#define PALPATE_INLINE [[gnu::always_inline]] inline

// Replaces x, clamped to -700 to 700, by exp(x); the error is at most 1 ulp.
//   x = k ln 2 + r, |r| <= ln 2 / 2;  exp(x) = 2^k sum_(n <= 13) r^n / n!
// Source: Cody & Waite (1980), "Software manual for the elementary functions", chapter 6.
PALPATE_INLINE void to_exponential(V4& x) noexcept {
  using Integers [[gnu::vector_size(kLanes * sizeof(std::int64_t))]] = std::int64_t;
  // The sum of this and a number has the number, rounded to an integer, in its lowest bits.
  constexpr double kRound = 0x1.8p52;
  constexpr int kExponentBit = 52;
  constexpr std::int64_t kOne = std::int64_t{1023} << kExponentBit;  // the bits of 1.0
  x = x < -700.0 ? V4{} - 700.0 : x;
  x = x > 700.0 ? V4{} + 700.0 : x;
  const V4 shifted = x * 0x1.71547652b82fep0 + kRound;  // log2(e)
  const V4 k = shifted - kRound;
  // ln 2 in two parts, the first so short that its product with k is exact.
  const V4 r = (x - k * 0x1.62e42feep-1) - k * 0x1.a39ef35793c76p-33;
  const V4 r2 = r * r;
  const V4 r4 = r2 * r2;
  const V4 low = (1.0 / 2 + r * (1.0 / 6)) + r2 * (1.0 / 24 + r * (1.0 / 120));
  const V4 middle = (1.0 / 720 + r * (1.0 / 5040)) + r2 * (1.0 / 40320 + r * (1.0 / 362880));
  const V4 high = (1.0 / 3628800 + r * (1.0 / 39916800)) + r2 * (1.0 / 479001600 + r * (1.0 / 6227020800));
  const V4 rest = r + r2 * (low + r4 * (middle + r4 * high));
  const V4 power = reinterpret_cast<V4>((reinterpret_cast<Integers>(shifted) << kExponentBit) + kOne);  // 2^k
  x = power + power * rest;
}

}  // namespace palpate
