// Four exponentials at once, by arithmetic operations only, so that results are bit-identical on every processor.
//   x = k ln 2 + r, |r| <= ln 2 / 2;  exp(x) = 2^k sum_(n <= 13) r^n / n!
// The error is at most 1 ulp; x is clamped to -700 to 700.
// Thread guarantee: pure, wait-free.
// Source: Cody & Waite (1980), "Software manual for the elementary functions", chapter 6.
#pragma once

#include <cstdint>
#include <cstring>

#include "engine/tick/lanes.h"

namespace palpate {
namespace exponential_parts {

// The sum of this and a number has the number, rounded to an integer, in its lowest bits.
inline constexpr double kRound = 0x1.8p52;
inline constexpr int kExponentBit = 52;
inline constexpr std::int64_t kOne = std::int64_t{1023} << kExponentBit;  // the bits of 1.0

// Computes 2^k from kRound + k.
using Integers [[gnu::vector_size(kLanes * sizeof(std::int64_t))]] = std::int64_t;
PALPATE_INLINE void power_of_two(V4& power, const V4& shifted) noexcept {
  Integers bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (bits << kExponentBit) + kOne;
  std::memcpy(&power, &bits, sizeof bits);
}

}  // namespace exponential_parts

// Replaces x by exp(x).
PALPATE_INLINE void to_exponential(V4& x) noexcept {
  x = x < -700.0 ? V4{} - 700.0 : x;
  x = x > 700.0 ? V4{} + 700.0 : x;
  const V4 shifted = x * 0x1.71547652b82fep0 + exponential_parts::kRound;  // log2(e)
  const V4 k = shifted - exponential_parts::kRound;
  // ln 2 in two parts, the first so short that its product with k is exact.
  const V4 r = (x - k * 0x1.62e42feep-1) - k * 0x1.a39ef35793c76p-33;
  const V4 r2 = r * r;
  const V4 r4 = r2 * r2;
  const V4 low = (1.0 / 2 + r * (1.0 / 6)) + r2 * (1.0 / 24 + r * (1.0 / 120));
  const V4 middle = (1.0 / 720 + r * (1.0 / 5040)) + r2 * (1.0 / 40320 + r * (1.0 / 362880));
  const V4 high = (1.0 / 3628800 + r * (1.0 / 39916800)) + r2 * (1.0 / 479001600 + r * (1.0 / 6227020800));
  const V4 rest = r + r2 * (low + r4 * (middle + r4 * high));
  V4 power;
  exponential_parts::power_of_two(power, shifted);
  x = power + power * rest;
}

}  // namespace palpate
