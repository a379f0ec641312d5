#include "models/model/nearest_simd.h"
#include "models/model/simd_targets.h"  // before the headers of Highway

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/model/nearest_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

#include <algorithm>
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
    const FloatVector difference =
        hn::Sub(hn::Set(d, x[k]), hn::LoadU(d, coordinates + static_cast<size_t>(k) * stride));
    sum = hn::MulAdd(difference, difference, sum);
  }
  return sum;
}

template <int kDimension>
float nearest(const float* coordinates, size_t count, const float* x) noexcept {
  const Floats d;
  FloatVector smallest = hn::Set(d, std::numeric_limits<float>::max());
  for (size_t i = 0; i < count; i += hn::Lanes(d))
    smallest = hn::Min(float_squares<kDimension>(coordinates + i, count, x), smallest);
  return hn::GetLane(hn::MinOfLanes(d, smallest));
}

#if HWY_MAX_BYTES >= 32
using Four = hn::FixedTag<float, 4>;

// x - c of kCount coordinates, rounded like nearest_float.
template <int kCount>
HWY_INLINE hn::Vec<Four> four_about(const double* x, const double* centre) {
  const hn::FixedTag<double, 4> d;
  const Four four;
  // Sets the lanes one at a time: a vector load of values that were stored one by one would wait for the stores.
  const auto at = [&](int k) HWY_ATTR { return k < kCount ? hn::Set(d, x[k]) : hn::Zero(d); };
  const auto theirs = hn::ConcatUpperLower(d, hn::OddEven(at(3), at(2)), hn::OddEven(at(1), at(0)));
  const auto q = hn::DemoteTo(four, hn::Sub(theirs, hn::LoadU(d, centre)));
  return hn::IfThenZeroElse(hn::Lt(hn::Abs(q), hn::Set(four, kSmallestFloat)), q);
}

// Compares all splits at once, then follows the bits: one comparison after the other would take three times as long.
template <int kDimension>
HWY_INLINE size_t leaf_number(const NearTree& tree, const double* x) {
  const hn::FixedTag<float, 8> eight;
  const auto low = four_about<std::min(kDimension, 4)>(x, tree.centre.data());
  auto all = hn::ZeroExtendVector(eight, low);
  if constexpr (kDimension > 4)
    all = hn::Combine(eight, four_about<kDimension - 4>(x + 4, tree.centre.data() + 4), low);
  uint32_t bits = 0;
  for (size_t i = 0; i < kNearLeaves; i += 8) {
    const auto its = hn::TableLookupLanes(all, hn::SetTableIndices(eight, tree.split_coordinate.data() + i));
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(eight, hn::Ge(its, hn::LoadU(eight, tree.split_at.data() + i)), bytes);
    bits |= uint32_t{bytes[0]} << i;
  }
  uint32_t node = 0;
  for (size_t level = 0; level < kNearLevels; ++level) node = 2 * node + 1 + (bits >> node & 1U);
  return node + 1 - kNearLeaves;
}
#else
template <int kDimension>
HWY_INLINE size_t leaf_number(const NearTree& tree, const double* x) {
  float q[kDimension];
  for (int k = 0; k < kDimension; ++k) q[k] = nearest_float(x[k] - tree.centre.data()[k]);
  size_t node = 0;
  for (size_t level = 0; level < kNearLevels; ++level)
    node = 2 * node + 1 + (q[tree.split_coordinate[node]] >= tree.split_at[node] ? 1 : 0);
  return node + 1 - kNearLeaves;
}
#endif

template <int kDimension>
const float* leaf_of(const NearTree& tree, const double* x) noexcept {
  return tree.leaves + leaf_number<kDimension>(tree, x) * tree.leaf_size * (kDimension + 1);
}

template <int kDimension>
bool near_point(const NearTree& tree, const float* leaf_of_x, const double* x) noexcept {
  const Floats d;
  FloatVector coordinate[kDimension];
  FloatVector squared = hn::Zero(d);
  for (int k = 0; k < kDimension; ++k) {
    coordinate[k] = hn::Set(d, nearest_float(x[k] - tree.centre.data()[k]));
    squared = hn::MulAdd(coordinate[k], coordinate[k], squared);
  }
  const FloatVector limit = hn::MulSub(hn::Set(d, tree.half), squared, hn::Set(d, tree.half_squared));
  const auto products = [&](size_t i) HWY_ATTR {
    FloatVector sum = hn::LoadU(d, leaf_of_x + kDimension * tree.leaf_size + i);
    for (int k = 0; k < kDimension; ++k)
      sum = hn::MulAdd(coordinate[k], hn::LoadU(d, leaf_of_x + static_cast<size_t>(k) * tree.leaf_size + i), sum);
    return sum;
  };
  FloatVector largest = limit;
  for (size_t i = 0; i < tree.leaf_size; i += kSimdPadFloat)
    for (size_t k = 0; k < kSimdPadFloat; k += hn::Lanes(d)) largest = hn::Max(products(i + k), largest);
  return !hn::AllFalse(d, hn::Gt(largest, limit));
}

template <int... kIndex>
NearestLoops pick_loops(int dimension, std::integer_sequence<int, kIndex...>) {
  static constexpr NearestLoops kTable[] = {{&nearest<kIndex + 1>, &leaf_of<kIndex + 1>, &near_point<kIndex + 1>}...};
  return kTable[dimension - 1];
}

NearestLoops get_loops(int dimension) { return pick_loops(dimension, std::make_integer_sequence<int, 8>{}); }

}  // namespace HWY_NAMESPACE
}  // namespace palpate::simd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate::simd {

HWY_EXPORT(get_loops);

NearestLoops nearest_loops(int dimension) { return HWY_DYNAMIC_DISPATCH(get_loops)(dimension); }

}  // namespace palpate::simd
#endif
