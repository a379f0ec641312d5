#include "models/model/rbf/rbf_simd.h"
#include "models/model/simd_targets.h"  // before the headers of Highway

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/model/rbf/rbf_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <utility>

#include "models/model/rbf/polynomial_tail.h"

HWY_BEFORE_NAMESPACE();
namespace palpate::simd {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, kSimdPad>;
using Vector = hn::Vec<Doubles>;

// The minimum of squared distances. It keeps 1/sqrt and log finite and all powers well above the denormal range. The
// kernels change by up to 1e-18 (linear), 5e-35 (thin-plate), 1e-54 (cubic) and 1e-90 (quintic).
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
    if constexpr (kKind == KernelKind::quintic) return hn::Mul(hn::Mul(squared, squared), r);
  }
}

// A point with every coordinate in all lanes.
template <int kDimension>
struct Broadcast {
  // Not defaulted: g++ compiles a defaulted constructor for the baseline instruction set only.
  HWY_INLINE Broadcast() {}
  Vector coordinate[kDimension];
};

template <int kDimension>
HWY_INLINE Broadcast<kDimension> broadcast(const double* x) {
  const Doubles d;
  Broadcast<kDimension> point;
  for (int k = 0; k < kDimension; ++k) point.coordinate[k] = hn::Set(d, x[k]);
  return point;
}

template <int kDimension>
HWY_INLINE Vector squared_distance(const Points& points, size_t i, const Broadcast<kDimension>& x) {
  const Doubles d;
  Vector difference = hn::Sub(x.coordinate[0], hn::LoadU(d, points.coordinates + i));
  Vector sum = hn::Mul(difference, difference);
  for (int k = 1; k < kDimension; ++k) {
    const double* row = points.coordinates + static_cast<size_t>(k) * points.stride;
    difference = hn::Sub(x.coordinate[k], hn::LoadU(d, row + i));
    sum = hn::MulAdd(difference, difference, sum);
  }
  return hn::Max(sum, hn::Set(d, kSmallestSquared));
}

template <KernelKind kKind, int kDimension, bool kSeries = false>
HWY_INLINE Vector kernel_at(const Points& points, size_t i, const Broadcast<kDimension>& x) {
  return kernel_of_squared<kKind, kSeries>(squared_distance<kDimension>(points, i, x));
}

template <KernelKind kKind, int kDimension>
double evaluate(const Points& points, const double* weights, const double* tail, const double* query_point) noexcept {
  const Doubles d;
  const size_t lanes = hn::Lanes(d);
  double x[kDimension];
  for (int k = 0; k < kDimension; ++k) x[k] = without_denormals(query_point[k]);
  const Broadcast<kDimension> query = broadcast<kDimension>(x);
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
  const Broadcast<kDimension> query = broadcast<kDimension>(centre);
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) hn::StoreU(kernel_at<kKind, kDimension>(points, i, query), d, out + i);
  if (i == count) return;
  HWY_ALIGN double last[kSimdPad];
  hn::Store(kernel_at<kKind, kDimension>(points, i, query), d, last);
  std::copy(last, last + (count - i), out + i);
}

// The loops of kernel k and dimension d + 1 are at index 8 k + d.
template <int... kIndex>
KernelLoops pick_loops(size_t place, std::integer_sequence<int, kIndex...>) {
  static constexpr KernelLoops kTable[] = {{&evaluate<static_cast<KernelKind>(kIndex / 8), kIndex % 8 + 1>,
                                            &column<static_cast<KernelKind>(kIndex / 8), kIndex % 8 + 1>}...};
  return kTable[place];
}

KernelLoops get_loops(KernelKind kind, int dimension) {
  return pick_loops(8 * static_cast<size_t>(kind) + static_cast<size_t>(dimension - 1),
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

KernelLoops kernel_loops(KernelKind kind, int dimension) { return HWY_DYNAMIC_DISPATCH(get_loops)(kind, dimension); }

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
