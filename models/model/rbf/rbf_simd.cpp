#include "models/model/rbf/rbf_simd.h"
#include "models/model/simd_targets.h"  // before the headers of Highway

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/model/rbf/rbf_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <utility>

#include "models/model/rbf/polynomial_tail.h"

HWY_BEFORE_NAMESPACE();
namespace palpate::simd {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, kSimdPad>;
using Vector = hn::Vec<Doubles>;

// Squared distances are lifted to this: keeps 1/sqrt and log finite, every power
// of it that is used well above the denormal range, and itself in that of a
// float. The kernels change by up to 1e-18 (linear), 5e-35 (thin-plate), 1e-54
// (cubic) and 1e-90 (quintic).
constexpr double kSmallestSquared = 1e-36;

// Squared distances of coordinates below this stay in the range of a float.
constexpr double kFloatRange = 1e18;

// r from r^2 by the square root unit.
HWY_INLINE Vector root_by_unit(Vector squared) { return hn::Sqrt(squared); }

// r from r^2 and an estimate y of 1/r, by multiplications:
//   r = r^2 y (1 + e/2 + 3 e^2/8 + 5 e^3/16 + 35 e^4/128) with e = 1 - r^2 y^2.
// An estimate good to 14 bits has |e| <= 2^-13 and needs no fourth term, below
// 2^-53 then; one of 11 bits (1.5 x 2^-12) does, and the fifth is below 2^-53.
template <int kTerms>
HWY_INLINE Vector refine_root(Vector squared, Vector estimate) {
  static_assert(kTerms == 3 || kTerms == 4);
  const Doubles d;
  const Vector root = hn::Mul(squared, estimate);
  const Vector e = hn::NegMulAdd(root, estimate, hn::Set(d, 1.0));
  Vector last = hn::Set(d, 0.3125);
  if constexpr (kTerms == 4) last = hn::MulAdd(e, hn::Set(d, 0.2734375), last);
  const Vector inner = hn::MulAdd(e, last, hn::Set(d, 0.375));
  const Vector series = hn::MulAdd(e, inner, hn::Set(d, 0.5));
  return hn::MulAdd(hn::Mul(root, e), series, root);
}

// r from r^2 without the square root unit, which is the bottleneck: loops take
// turns between the two. AVX-512 has an estimate in double precision, and three of
// four roots go this way in evaluate(), where distances come beforehand (10 % off 100
// centres against every other root, which is what the rest does). AVX2 has one in single precision only, which takes
// conversions and a range check: every fourth root, in evaluate() alone.
// Measured on a Zen 3: 11 % off 6,850 centres, 4 % off 100; every other root
// costs 8 % more instead. (Integer arithmetic for the estimate was slower.)
HWY_INLINE Vector root_by_series(Vector squared) {
#if HWY_TARGET == HWY_AVX3
  return refine_root<3>(squared, Vector{_mm512_rsqrt14_pd(squared.raw)});
#elif HWY_TARGET == HWY_AVX2
  const hn::Rebind<float, Doubles> floats;
  return refine_root<4>(squared,
                        hn::PromoteTo(Doubles(), hn::ApproximateReciprocalSqrt(hn::DemoteTo(floats, squared))));
#else
  return root_by_unit(squared);
#endif
}

// Whether every other root may go by the series, whatever the distance.
constexpr bool kSeriesForAll = HWY_TARGET == HWY_AVX3;
// Whether evaluate() goes by fours, with every fourth root by the series where distances
// are in the range of a float; or with three of four, whatever the distance.
constexpr bool kByFours = HWY_TARGET == HWY_AVX2 || kSeriesForAll;

template <KernelKind kKind, bool kUnit>
HWY_INLINE Vector kernel_of_squared(Vector squared) {
  const Doubles d;
  if constexpr (kKind == KernelKind::thin_plate) {
    // r^2 log r = r^2 log(r^2) / 2
    return hn::Mul(hn::Mul(hn::Set(d, 0.5), squared), hn::Log(d, squared));
  } else {
    const Vector r = kUnit ? root_by_unit(squared) : root_by_series(squared);
    if constexpr (kKind == KernelKind::linear) return r;
    if constexpr (kKind == KernelKind::cubic) return hn::Mul(squared, r);
    if constexpr (kKind == KernelKind::quintic) return hn::Mul(hn::Mul(squared, squared), r);
  }
}

// sum + weight phi(r), where nothing but one operation waits for r.
template <KernelKind kKind, bool kUnit>
HWY_INLINE Vector add_kernel(Vector sum, Vector weight, Vector squared) {
  const Vector r = kUnit ? root_by_unit(squared) : root_by_series(squared);
  if constexpr (kKind == KernelKind::linear) return hn::MulAdd(weight, r, sum);
  if constexpr (kKind == KernelKind::cubic) return hn::MulAdd(hn::Mul(weight, squared), r, sum);
  if constexpr (kKind == KernelKind::quintic) return hn::MulAdd(hn::Mul(weight, hn::Mul(squared, squared)), r, sum);
}

// A point with every coordinate in all lanes.
template <int kDimension>
struct Broadcast {
  // Written out: g++ gives one of its own no instruction set but the machine's least.
  HWY_INLINE Broadcast() {}
  Vector coordinate[kDimension];
};

template <int kDimension>
HWY_INLINE Broadcast<kDimension> broadcast(const double* x, size_t stride) {
  const Doubles d;
  Broadcast<kDimension> point;
  for (int k = 0; k < kDimension; ++k) point.coordinate[k] = hn::Set(d, x[static_cast<size_t>(k) * stride]);
  return point;
}

template <int kDimension>
HWY_INLINE Vector squared_distance(const Points& points, size_t i, const Broadcast<kDimension>& x) {
  const Doubles d;
  Vector difference = hn::Sub(x.coordinate[0], hn::Load(d, points.coordinates + i));
  Vector sum = hn::Mul(difference, difference);
  for (int k = 1; k < kDimension; ++k) {
    const double* row = points.coordinates + static_cast<size_t>(k) * points.stride;
    difference = hn::Sub(x.coordinate[k], hn::Load(d, row + i));
    sum = hn::MulAdd(difference, difference, sum);
  }
  return hn::Max(sum, hn::Set(d, kSmallestSquared));
}

template <KernelKind kKind, int kDimension, bool kUnit>
HWY_INLINE Vector kernel_at(const Points& points, size_t i, const Broadcast<kDimension>& x) {
  return kernel_of_squared<kKind, kUnit>(squared_distance<kDimension>(points, i, x));
}

// Whether all distances from x are in the range of a float.
template <int kDimension>
HWY_INLINE bool in_float_range(const Points& points, const double* x) {
  bool inside = points.largest < kFloatRange;
  for (int k = 0; k < kDimension; ++k) inside &= x[k] < kFloatRange && x[k] > -kFloatRange;
  return inside;
}

// The points that add_by_fours adds.
HWY_INLINE size_t count_by_fours(const Points& points) {
  const size_t step = 4 * hn::Lanes(Doubles());
  return points.padded / step * step;
}

// Adds weight times kernel of the points up to `end` to two sums. The distances of the next
// four vectors come before the products of these, which wait for their roots: the processor
// sees no further ahead than about one such step. 11 % off 6,850 centres and 100 against
// the plain order, on a Zen 3.
template <KernelKind kKind, int kDimension>
HWY_INLINE void add_by_fours(const Points& points, const double* weights, const Broadcast<kDimension>& query,
                             size_t end, Vector& sum, Vector& more) {
  const Doubles d;
  const size_t lanes = hn::Lanes(d);
  if (end == 0) return;
  Vector a = squared_distance<kDimension>(points, 0, query);
  Vector b = squared_distance<kDimension>(points, lanes, query);
  Vector c = squared_distance<kDimension>(points, 2 * lanes, query);
  Vector e = squared_distance<kDimension>(points, 3 * lanes, query);
  for (size_t i = 0; i < end; i += 4 * lanes) {
    const Vector now_a = a;
    const Vector now_b = b;
    const Vector now_c = c;
    const Vector now_e = e;
    if (i + 4 * lanes < end) {
      const size_t next = i + 4 * lanes;
      a = squared_distance<kDimension>(points, next, query);
      b = squared_distance<kDimension>(points, next + lanes, query);
      c = squared_distance<kDimension>(points, next + 2 * lanes, query);
      e = squared_distance<kDimension>(points, next + 3 * lanes, query);
    }
    more = add_kernel<kKind, !kSeriesForAll>(more, hn::Load(d, weights + i + lanes), now_b);
    sum = add_kernel<kKind, !kSeriesForAll>(sum, hn::Load(d, weights + i + 2 * lanes), now_c);
    more = add_kernel<kKind, false>(more, hn::Load(d, weights + i + 3 * lanes), now_e);
    sum = add_kernel<kKind, true>(sum, hn::Load(d, weights + i), now_a);  // the unit is slow
  }
}

template <KernelKind kKind, int kDimension>
double evaluate(const Points& points, const double* weights, const double* tail, const double* query_point) noexcept {
  const Doubles d;
  const size_t lanes = hn::Lanes(d);
  double x[kDimension];
  for (int k = 0; k < kDimension; ++k) x[k] = without_denormals(query_point[k]);
  const Broadcast<kDimension> query = broadcast<kDimension>(x, 1);
  const double tail_part = tail_value(tail, tail_degree(kKind), kDimension, x);
  Vector sum = hn::IfThenElseZero(hn::FirstN(d, 1), hn::Set(d, tail_part));
  Vector more = hn::Zero(d);
  size_t by_fours = 0;
  if constexpr (kByFours && kKind != KernelKind::thin_plate) {
    if (kSeriesForAll || in_float_range<kDimension>(points, x)) by_fours = count_by_fours(points);
  }
  // The last points first: behind the others the result would wait for them alone.
  size_t i = by_fours;
  for (; i + 2 * lanes <= points.padded; i += 2 * lanes) {
    const Vector first = kernel_at<kKind, kDimension, true>(points, i, query);
    const Vector second = kernel_at<kKind, kDimension, !kSeriesForAll>(points, i + lanes, query);
    sum = hn::MulAdd(hn::Load(d, weights + i), first, sum);
    more = hn::MulAdd(hn::Load(d, weights + i + lanes), second, more);
  }
  if (i < points.padded)
    sum = hn::MulAdd(hn::Load(d, weights + i), kernel_at<kKind, kDimension, true>(points, i, query), sum);
  if constexpr (kByFours && kKind != KernelKind::thin_plate)
    add_by_fours<kKind, kDimension>(points, weights, query, by_fours, sum, more);
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(sum, more)));
}

template <KernelKind kKind, int kDimension>
void column(const Points& points, size_t count, const double* centre, double* out) noexcept {
  const Doubles d;
  const size_t lanes = hn::Lanes(d);
  const Broadcast<kDimension> query = broadcast<kDimension>(centre, 1);
  size_t i = 0;
  for (; i + 2 * lanes <= count; i += 2 * lanes) {
    hn::StoreU(kernel_at<kKind, kDimension, true>(points, i, query), d, out + i);
    hn::StoreU(kernel_at<kKind, kDimension, !kSeriesForAll>(points, i + lanes, query), d, out + i + lanes);
  }
  for (; i < count; i += lanes) {
    HWY_ALIGN double last[kSimdPad];
    hn::Store(kernel_at<kKind, kDimension, true>(points, i, query), d, last);
    for (size_t k = 0; k < lanes && i + k < count; ++k) out[i + k] = last[k];
  }
}

template <KernelKind kKind, int kDimension, bool kBoth>
void product_tile(const Points& points, size_t row_begin, size_t row_end, size_t column_begin, size_t column_end,
                  const double* v, double* y) {
  const Doubles d;
  const size_t lanes = hn::Lanes(d);
  for (size_t j = column_begin; j < column_end; j += 2) {
    const Broadcast<kDimension> a = broadcast<kDimension>(points.coordinates + j, points.stride);
    const Broadcast<kDimension> b = broadcast<kDimension>(points.coordinates + j + 1, points.stride);
    const Vector v_a = hn::Set(d, v[j]);
    const Vector v_b = hn::Set(d, v[j + 1]);
    Vector sum_a = hn::Zero(d);
    Vector sum_b = hn::Zero(d);
    for (size_t i = row_begin; i < row_end; i += lanes) {
      const Vector phi_a = kernel_at<kKind, kDimension, true>(points, i, a);
      const Vector phi_b = kernel_at<kKind, kDimension, !kSeriesForAll>(points, i, b);
      hn::Store(hn::MulAdd(phi_b, v_b, hn::MulAdd(phi_a, v_a, hn::Load(d, y + i))), d, y + i);
      if constexpr (kBoth) {
        const Vector v_i = hn::Load(d, v + i);
        sum_a = hn::MulAdd(phi_a, v_i, sum_a);
        sum_b = hn::MulAdd(phi_b, v_i, sum_b);
      }
    }
    if constexpr (kBoth) {
      y[j] += hn::GetLane(hn::SumOfLanes(d, sum_a));
      y[j + 1] += hn::GetLane(hn::SumOfLanes(d, sum_b));
    }
  }
}

template <KernelKind kKind, int kDimension>
void product(const Points& points, size_t row_begin, size_t row_end, size_t column_begin, size_t column_end,
             const double* v, double* y) noexcept {
  if (row_begin == column_begin)
    product_tile<kKind, kDimension, false>(points, row_begin, row_end, column_begin, column_end, v, y);
  else
    product_tile<kKind, kDimension, true>(points, row_begin, row_end, column_begin, column_end, v, y);
}

template <KernelKind kKind, int... kIndex>
KernelLoops pick_loops(int dimension, std::integer_sequence<int, kIndex...>) {
  static constexpr KernelLoops kTable[] = {
      {&evaluate<kKind, kIndex + 1>, &column<kKind, kIndex + 1>, &product<kKind, kIndex + 1>}...};
  return kTable[dimension - 1];
}

KernelLoops get_loops(KernelKind kind, int dimension) {
  using Dimensions = std::make_integer_sequence<int, 8>;
  switch (kind) {
    case KernelKind::cubic:
      return pick_loops<KernelKind::cubic>(dimension, Dimensions{});
    case KernelKind::linear:
      return pick_loops<KernelKind::linear>(dimension, Dimensions{});
    case KernelKind::thin_plate:
      return pick_loops<KernelKind::thin_plate>(dimension, Dimensions{});
    case KernelKind::quintic:
      return pick_loops<KernelKind::quintic>(dimension, Dimensions{});
  }
  return {};
}

double get_refined_root(double squared, double estimate, int terms) {
  const Doubles d;
  const Vector s = hn::Set(d, squared);
  const Vector y = hn::Set(d, estimate);
  return hn::GetLane(terms == 3 ? refine_root<3>(s, y) : refine_root<4>(s, y));
}

int64_t get_target() { return HWY_TARGET; }

}  // namespace HWY_NAMESPACE
}  // namespace palpate::simd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate::simd {

HWY_EXPORT(get_loops);
HWY_EXPORT(get_refined_root);
HWY_EXPORT(get_target);

KernelLoops kernel_loops(KernelKind kind, int dimension) { return HWY_DYNAMIC_DISPATCH(get_loops)(kind, dimension); }

double refined_root(double squared, double estimate, int terms) {
  return HWY_DYNAMIC_DISPATCH(get_refined_root)(squared, estimate, terms);
}

std::vector<std::string> target_names() {
  std::vector<std::string> names;
  const std::string chosen = target_name();
  hwy::SetSupportedTargetsForTest(0);
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) names.emplace_back(hwy::TargetName(target));
  choose_target(chosen);
  return names;
}

std::string target_name() { return hwy::TargetName(HWY_DYNAMIC_DISPATCH(get_target)()); }

bool choose_target(const std::string& name) {
  hwy::SetSupportedTargetsForTest(0);
  bool found = name.empty();
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (!found && name == hwy::TargetName(target)) {
      hwy::SetSupportedTargetsForTest(target);
      found = true;
    }
  }
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return found;
}

}  // namespace palpate::simd
#endif
