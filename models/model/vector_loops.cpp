#include "models/model/vector_loops.h"

// The instruction sets for which Highway does not compile the loops. AVX3_DL adds nothing that these loops use;
// processors with SSSE3 but without SSE4 are older than ten years. SVE vectors have no size at compile time and cannot
// be stored in arrays; every arm64 machine has NEON.
#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/model/vector_loops.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace palpate::simd {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A point with every coordinate in all lanes; those below `tiny` are 0. Each is loaded by itself, because a load of
// several that were just stored one by one stalls.
template <int kDimension, typename D>
struct Broadcast {
  HWY_INLINE Broadcast(D d, const double* x, hn::TFromD<D> tiny) {
    for (int k = 0; k < kDimension; ++k) {
      const hn::Vec<D> all = hn::Set(d, static_cast<hn::TFromD<D>>(x[k]));
      coordinate[k] = hn::IfThenZeroElse(hn::Lt(hn::Abs(all), hn::Set(d, tiny)), all);
    }
  }
  hn::Vec<D> coordinate[kDimension];
};

// |x - point_i|^2 for the next points from `coordinates` on.
template <int kDimension, typename D>
HWY_INLINE hn::Vec<D> squared_distance(D d, const hn::TFromD<D>* coordinates, size_t stride,
                                       const Broadcast<kDimension, D>& x) {
  hn::Vec<D> difference = hn::Sub(x.coordinate[0], hn::LoadU(d, coordinates));
  hn::Vec<D> sum = hn::Mul(difference, difference);
  for (int k = 1; k < kDimension; ++k) {
    difference = hn::Sub(x.coordinate[k], hn::LoadU(d, coordinates + static_cast<size_t>(k) * stride));
    sum = hn::MulAdd(difference, difference, sum);
  }
  return sum;
}

using Doubles = hn::CappedTag<double, kSimdPad>;
using Vector = hn::Vec<Doubles>;

// The minimum of squared distances. It keeps 1/sqrt and log finite and all powers well above the denormal range. The
// kernels change by up to 1e-18 (linear), 5e-35 (thin-plate) and 1e-54 (cubic).
constexpr double kSmallestSquared = 1e-36;

// r from r^2. The square root unit is the bottleneck. AVX-512 also has an estimate y of 1/r to 14 bits; the loops
// alternate between the unit and
//   r = r^2 y (1 + e/2 + 3 e^2/8 + 5 e^3/16),  e = 1 - r^2 y^2, |e| <= 2^-13.
template <bool kSeries>
HWY_INLINE Vector root(Vector squared) {
#if HWY_TARGET == HWY_AVX3
  if constexpr (kSeries) {
    const Doubles d;
    const Vector y{_mm512_rsqrt14_pd(squared.raw)};
    const Vector r = hn::Mul(squared, y);
    const Vector e = hn::NegMulAdd(r, y, hn::Set(d, 1.0));
    const Vector inner = hn::MulAdd(e, hn::Set(d, 0.3125), hn::Set(d, 0.375));
    return hn::MulAdd(hn::Mul(r, e), hn::MulAdd(e, inner, hn::Set(d, 0.5)), r);
  }
#endif
  return hn::Sqrt(squared);
}

template <KernelKind kKind, bool kSeries = false>
HWY_INLINE Vector kernel_of_squared(Vector squared) {
  const Doubles d;
  if constexpr (kKind == KernelKind::thin_plate) {
    // r^2 log r = r^2 log(r^2) / 2
    return hn::Mul(hn::Mul(hn::Set(d, 0.5), squared), hn::Log(d, squared));
  } else {
    const Vector r = root<kSeries>(squared);
    if constexpr (kKind == KernelKind::linear) return r;
    if constexpr (kKind == KernelKind::cubic) return hn::Mul(squared, r);
  }
}

template <KernelKind kKind, int kDimension, bool kSeries = false>
HWY_INLINE Vector kernel_at(const Points& points, size_t i, const Broadcast<kDimension, Doubles>& x) {
  const Doubles d;
  const Vector squared = squared_distance<kDimension>(d, points.coordinates + i, points.stride, x);
  return kernel_of_squared<kKind, kSeries>(hn::Max(squared, hn::Set(d, kSmallestSquared)));
}

template <KernelKind kKind, int kDimension>
double evaluate(const Points& points, const double* weights, const double* tail, const double* query_point) noexcept {
  const Doubles d;
  const size_t lanes = hn::Lanes(d);
  const Broadcast<kDimension, Doubles> query(d, query_point, kTiny);
  double x[kDimension];
  for (int k = 0; k < kDimension; ++k) x[k] = hn::GetLane(query.coordinate[k]);
  const double tail_part = tail_value(tail, tail_degree(kKind), kDimension, x);
  Vector sum = hn::IfThenElseZero(hn::FirstN(d, 1), hn::Set(d, tail_part));
  Vector more = hn::Zero(d);
  size_t i = 0;
  for (; i + 2 * lanes <= points.padded; i += 2 * lanes) {
    sum = hn::MulAdd(hn::LoadU(d, weights + i), kernel_at<kKind, kDimension>(points, i, query), sum);
    const Vector by_series = kernel_at<kKind, kDimension, true>(points, i + lanes, query);
    more = hn::MulAdd(hn::LoadU(d, weights + i + lanes), by_series, more);
  }
  if (i < points.padded)
    sum = hn::MulAdd(hn::LoadU(d, weights + i), kernel_at<kKind, kDimension>(points, i, query), sum);
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(sum, more)));
}

template <KernelKind kKind, int kDimension>
void column(const Points& points, size_t count, const double* centre, double* out) noexcept {
  const Doubles d;
  const size_t lanes = hn::Lanes(d);
  const Broadcast<kDimension, Doubles> query(d, centre, kTiny);
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) hn::StoreU(kernel_at<kKind, kDimension>(points, i, query), d, out + i);
  if (i == count) return;
  HWY_ALIGN double last[kSimdPad];
  hn::Store(kernel_at<kKind, kDimension>(points, i, query), d, last);
  std::copy(last, last + (count - i), out + i);
}

using Floats = hn::CappedTag<float, kSimdPadFloat>;

template <int kDimension>
HWY_INLINE float nearest_of_cell(const float* points, const Broadcast<kDimension, Floats>& x) {
  const Floats d;
  hn::Vec<Floats> smallest = squared_distance<kDimension>(d, points, kCellPoints, x);
  for (size_t i = hn::Lanes(d); i < kCellPoints; i += hn::Lanes(d))
    smallest = hn::Min(squared_distance<kDimension>(d, points + i, kCellPoints, x), smallest);
  return hn::GetLane(hn::MinOfLanes(d, smallest));
}

// |x - box|^2 of the next boxes from `first` on. Each step rounds monotonically, so that it does not exceed the
// squared_distance of a point in the box.
template <int kDimension>
HWY_INLINE hn::Vec<Floats> squared_to_boxes(const Cells& cells, size_t first, const Broadcast<kDimension, Floats>& x) {
  const Floats d;
  hn::Vec<Floats> sum = hn::Zero(d);
  for (size_t k = 0; k < kDimension; ++k) {
    const auto below = hn::Sub(hn::LoadU(d, cells.low + k * cells.padded + first), x.coordinate[k]);
    const auto above = hn::Sub(x.coordinate[k], hn::LoadU(d, cells.high + k * cells.padded + first));
    const auto outside = hn::Max(hn::Max(below, above), hn::Zero(d));
    sum = k == 0 ? hn::Mul(outside, outside) : hn::MulAdd(outside, outside, sum);
  }
  return sum;
}

template <int kDimension>
float nearest(const Cells& cells, const double* query_point, float enough, uint32_t& cell) noexcept {
  const Floats d;
  const Broadcast<kDimension, Floats> x(d, query_point, kSmallestFloat);
  float smallest = nearest_of_cell<kDimension>(cells.points + cell * kDimension * kCellPoints, x);
  const uint32_t last = cell;
  for (size_t first = 0; first < cells.padded && !(smallest <= enough); first += hn::Lanes(d)) {
    const auto squared = squared_to_boxes<kDimension>(cells, first, x);
    if (hn::AllFalse(d, hn::Lt(squared, hn::Set(d, smallest)))) continue;
    HWY_ALIGN float box[kSimdPadFloat];
    hn::Store(squared, d, box);
    for (size_t i = 0; i < hn::Lanes(d); ++i) {
      const auto other = static_cast<uint32_t>(first + i);
      if (!(box[i] < smallest) || other == last) continue;
      const float here = nearest_of_cell<kDimension>(cells.points + other * kDimension * kCellPoints, x);
      if (!(here < smallest)) continue;
      smallest = here;
      cell = other;
    }
  }
  return smallest;
}

// The loops of kernel k and dimension d + 1 are at index 8 k + d.
template <int... kIndex>
Loops pick(size_t index, std::integer_sequence<int, kIndex...>) {
  static constexpr Loops kTable[] = {{&evaluate<static_cast<KernelKind>(kIndex / 8), kIndex % 8 + 1>,
                                      &column<static_cast<KernelKind>(kIndex / 8), kIndex % 8 + 1>,
                                      &nearest<kIndex % 8 + 1>}...};
  return kTable[index];
}

Loops get_loops(int dimension, KernelKind kernel) {
  return pick(8 * static_cast<size_t>(kernel) + static_cast<size_t>(dimension - 1),
              std::make_integer_sequence<int, 8 * static_cast<int>(kKernelKinds.size())>{});
}

int64_t get_target() { return HWY_TARGET; }

}  // namespace HWY_NAMESPACE
}  // namespace palpate::simd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate::simd {

HWY_EXPORT(get_loops);
HWY_EXPORT(get_target);

Loops loops(int dimension, KernelKind kernel) { return HWY_DYNAMIC_DISPATCH(get_loops)(dimension, kernel); }

std::string target_name() { return hwy::TargetName(HWY_DYNAMIC_DISPATCH(get_target)()); }

std::vector<std::int64_t> all_targets() { return hwy::SupportedAndGeneratedTargets(); }

void use_target(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace palpate::simd
#endif
