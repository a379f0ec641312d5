// The parts of features, each with a drive curve g of the depth d, four at a time in SIMD lanes, with arithmetic
// operations only, so that results are bit-identical on every processor:
//   Maxwell branch     dz/dt = g'(d) dd/dt - z / tau: a spring g and a dashpot in series. g = d / tau: a low-pass.
//   stop operator      s' = clamp(s + d' - d, -r, r), 0 out of contact: a bristle that bends by at most r, then slips.
//   creeping bristle   dq/dt = dd/dt - (q / tau) (q / r)^2: slips at every deflection; a hold: t^-1/2.
// A `slowing` b multiplies every tau by exp(b d / reference depth): where a fluid is squeezed through closing pores.
//
// Every part is passive if g rises (branch) or is not negative (bristles). With q = g(d) - z, dq/dt = z / tau, a branch
// dissipates (d - g^-1(q)) (g(d) - q) / tau >= 0 for any tau; the rest of its power changes the stored energy
// integral_0^d g ds - q d + integral_0^q g^-1 ds. Bristles dissipate sum_p closed integral G_p(d) dp_p / r_p >= 0 in a
// cycle, with G_p' = g_p and p_p = d - s_p, which increases only at d > p_p and decreases only at d < p_p.
// Thread guarantee: immutable after the last `add`, which allocates; all else is wait-free.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace palpate {

inline constexpr std::size_t kDriveCoefficients = 4;

// Sets `value` to g(d), a force at depth d: a Maxwell branch before it relaxes, or the friction of a bristle.
//   g(d) = sum_k coefficient_N[k] u^(k+1),  u = d / reference_depth_m
// Beyond u = 1, g continues along its tangent. `curve`: a DriveCurve for one Number, or CurveLanes for four at once;
// the results are bit-identical.
template <typename Number, typename Curve>
[[gnu::always_inline]] inline void evaluate_curve(Number& value, const Curve& curve, double depth_m) noexcept {
  const Number u = depth_m * curve.per_reference_m();
  const Number inside = u > 1.0 ? Number{} + 1.0 : u;
  Number sum{};
  for (std::size_t k = kDriveCoefficients; k-- > 0;) sum = (sum + curve.coefficient_N[k]) * inside;
  value = sum;
  if (depth_m > curve.least_reference_m()) [[unlikely]] {
    Number slope{};  // dg/du at u = 1
    for (std::size_t k = kDriveCoefficients; k-- > 0;) slope += static_cast<double>(k + 1) * curve.coefficient_N[k];
    value = u > 1.0 ? value + slope * (u - 1.0) : value;
  }
}

struct DriveCurve {
  double reference_depth_m = 1.0;
  std::array<double, kDriveCoefficients> coefficient_N{};

  double at(double depth_m) const noexcept {
    double value = 0.0;
    evaluate_curve(value, *this, depth_m);
    return value;
  }
  double per_reference_m() const noexcept { return 1.0 / reference_depth_m; }
  // Beyond this depth g is linear.
  double least_reference_m() const noexcept { return reference_depth_m; }
  bool operator==(const DriveCurve&) const = default;
};

inline constexpr std::size_t kLanes = 4;

// Four doubles (extension of GCC and Clang). Passed by reference only, because by value the ABI depends on the
// instruction set. Arrays of it are stored as V4, because a load of a vector that was stored in halves stalls. A struct
// with V4 members needs alignas(sizeof(V4)), which GCC omits when it compiles for processors without such vectors.
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

// Four drive curves. An unused lane has g = 0.
struct alignas(sizeof(V4)) CurveLanes {
  V4 coefficient_N[kDriveCoefficients]{};
  V4 per_reference{1.0, 1.0, 1.0, 1.0};
  double least_m = std::numeric_limits<double>::infinity();  // the smallest of the four reference depths

  void set(std::size_t lane, const DriveCurve& drive) noexcept;
  const V4& per_reference_m() const noexcept { return per_reference; }
  double least_reference_m() const noexcept { return least_m; }
};

// The exponential of a multiple of 1/128 for each lane, kept from step to step: the argument seldom moves to another
// multiple, and a short series leads from one to it. Results do not depend on what was kept.
struct alignas(sizeof(V4)) KeptExponential {
  V4 at{};
  V4 value{1.0, 1.0, 1.0, 1.0};
};

// The largest number of groups of four for the branches or bristles of a filter: 8 features of 8 parts.
inline constexpr std::size_t kMaxLaneGroups = 16;

// The state of the parts of a filter: the groups of branches, then those of bristles.
struct alignas(sizeof(V4)) PartMemory {
  V4 value[kMaxLaneGroups];    // the force z of a branch, N; the deflection s or q of a bristle, m
  V4 drive_N[kMaxLaneGroups];  // g(d) of a branch at the same time
  KeptExponential slowed[kMaxLaneGroups], kept[kMaxLaneGroups];  // of a step of the branches
};

// The sum of `count` lanes from index `first`.
inline double sum_of_lanes(const V4* value, std::size_t first, std::size_t count) noexcept {
  double sum = 0.0;
  for (std::size_t i = first; i < first + count; ++i) sum += reinterpret_cast<const double*>(value)[i];
  return sum;
}

class BranchLanes {
 public:
  struct alignas(sizeof(V4)) Group {
    CurveLanes drive;
    V4 relaxation_time_s{1.0, 1.0, 1.0, 1.0};
    V4 slowing{};  // exponents of the growth of these times with depth
    V4 per_slowing_m{1.0, 1.0, 1.0, 1.0};
  };
  // Returns the index of the branch among the lanes.
  std::size_t add(const DriveCurve& drive, double relaxation_time_s, double slowing = 0.0,
                  double slowing_depth_m = 1.0);
  std::size_t groups() const noexcept { return groups_.size(); }

  // Advances all branches from the last depth by `step_s`; with 0 no force changes.
  void advance(double last_depth_m, double depth_m, double step_s, PartMemory& memory) const noexcept;

 private:
  std::vector<Group> groups_;
  std::size_t count_ = 0;
  bool slows_ = false;  // whether one branch has a slowing
};

class BristleLanes {
 public:
  struct alignas(sizeof(V4)) Group {
    CurveLanes drive;
    V4 per_threshold_m{1.0, 1.0, 1.0, 1.0};
    // The largest deflection: the threshold of a stop, infinite for a creeping bristle.
    V4 limit_m{1.0, 1.0, 1.0, 1.0};
    V4 air_limit_m{};     // the same out of contact: 0 for a stop
    V4 creep_per_m2_s{};  // 1 / (tau r^2); 0 for a stop
    bool creeps = false;  // whether one lane creeps
  };
  // `creep_time_s`: tau, or 0 for a stop. Returns the index of the bristle among the lanes.
  std::size_t add(const DriveCurve& drive, double threshold_m, double creep_time_s);
  std::size_t groups() const noexcept { return groups_.size(); }

  // Advances all bristles from the last depth by `step_s`; with 0 only the forces are computed. Out of contact the
  // deflection of a stop becomes 0. `force_N`: receives the forces.
  void advance(double last_depth_m, double depth_m, double step_s, V4* bend_m, V4* force_N) const noexcept;

 private:
  std::vector<Group> groups_;
  std::size_t count_ = 0;
};

}  // namespace palpate
