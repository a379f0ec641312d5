#include "models/model/nearest_simd.h"

// As in rbf_simd.cpp.
#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/model/nearest_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

#include <cstdint>
#include <limits>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace palpate::simd {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kSimdPadFloat>;
using FloatVector = hn::Vec<Floats>;

template <int kDimension>
HWY_INLINE FloatVector float_squares(const float* coordinates, size_t stride, const float* x) {
  const Floats d;
  FloatVector sum = hn::Zero(d);
  for (int k = 0; k < kDimension; ++k) {
    const FloatVector difference = hn::Sub(hn::Set(d, x[k]), hn::Load(d, coordinates + static_cast<size_t>(k) * stride));
    sum = hn::MulAdd(difference, difference, sum);
  }
  return sum;
}

template <int kDimension>
float nearest(const float* coordinates, size_t stride, size_t count, const float* x) noexcept {
  const Floats d;
  FloatVector smallest = hn::Set(d, std::numeric_limits<float>::max());
  for (size_t i = 0; i < count; i += hn::Lanes(d))
    smallest = hn::Min(float_squares<kDimension>(coordinates + i, stride, x), smallest);
  return hn::GetLane(hn::MinOfLanes(d, smallest));
}

// Bit i: on which side of split i.
template <int kDimension>
HWY_INLINE uint32_t sides(const float* splits, const float* x) {
  const Floats d;
  uint32_t bits = 0;
  for (size_t i = 0; i < kNearLeaves; i += hn::Lanes(d)) {
    auto upper = hn::Ge(hn::Set(d, x[0]), hn::Load(d, splits + i));
    for (int k = 1; k < kDimension; ++k)
      upper = hn::Or(upper, hn::Ge(hn::Set(d, x[k]), hn::Load(d, splits + static_cast<size_t>(k) * kNearLeaves + i)));
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, upper, bytes);
    bits |= (uint32_t{bytes[0]} | uint32_t{bytes[1]} << 8) << i;
  }
  return bits;
}

// All splits at once, then from bit to bit: a comparison after the other would take three
// times as long.
template <int kDimension>
bool near_point(const float* splits, const float* leaves, size_t leaf_size, const double* query, float squared) noexcept {
  const Floats d;
  float x[kDimension];
  bool in_range = true;
  for (int k = 0; k < kDimension; ++k) {
    in_range &= in_nearest_range(query[k]);
    x[k] = nearest_float(query[k]);
  }
  const uint32_t bits = sides<kDimension>(splits, x);
  uint32_t node = 0;
  for (size_t level = 0; level < kNearLevels; ++level) node = 2 * node + 1 + (bits >> node & 1U);
  const float* leaf = leaves + (node + 1 - kNearLeaves) * leaf_size * kDimension;
  const FloatVector limit = hn::Set(d, squared);
  auto near = hn::Le(float_squares<kDimension>(leaf, leaf_size, x), limit);
  for (size_t i = hn::Lanes(d); i < leaf_size; i += hn::Lanes(d))
    near = hn::Or(near, hn::Le(float_squares<kDimension>(leaf + i, leaf_size, x), limit));
  return in_range && !hn::AllFalse(d, near);
}

template <int... kIndex>
NearestFunction pick_nearest(int dimension, std::integer_sequence<int, kIndex...>) {
  static constexpr NearestFunction kTable[] = {&nearest<kIndex + 1>...};
  return kTable[dimension - 1];
}

template <int... kIndex>
NearFunction pick_near(int dimension, std::integer_sequence<int, kIndex...>) {
  static constexpr NearFunction kTable[] = {&near_point<kIndex + 1>...};
  return kTable[dimension - 1];
}

using NearestDimensions = std::make_integer_sequence<int, 8>;

NearestFunction get_nearest(int dimension) { return pick_nearest(dimension, NearestDimensions{}); }
NearFunction get_near(int dimension) { return pick_near(dimension, NearestDimensions{}); }

}  // namespace HWY_NAMESPACE
}  // namespace palpate::simd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate::simd {

HWY_EXPORT(get_nearest);
HWY_EXPORT(get_near);

NearestFunction nearest_function(int dimension) { return HWY_DYNAMIC_DISPATCH(get_nearest)(dimension); }
NearFunction near_function(int dimension) { return HWY_DYNAMIC_DISPATCH(get_near)(dimension); }

}  // namespace palpate::simd
#endif
