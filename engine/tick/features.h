// The dynamic feature vector: what a force model is given, from one scene's
// choice of one to eight features. Recording, fitting, replay and the live
// loop run this code and no other.
//
//   depth             d = max(0, estimated position)                        [m]
//   velocity          v = estimated velocity while d > 0, else 0            [m/s]
//   lowpass_velocity  y with dy/dt = (dd/dt - y) / tau                      [m/s]
//   maxwell_branch    z with dz/dt = g'(d) dd/dt - z / tau                  [N]
//
// The low-pass is eq. (1) of Hoever & Harders (2009). The Maxwell branch is the
// same filter behind a spring whose stiffness g'(d) depends on depth; g is
// identified from the recording (models/training/fit_trend.h), and with g = d / tau it is the
// low-pass. Both are driven by the depth, not by the velocity estimate: free
// air relaxes the material and does not load it.
//
// Discretisation is exact for a depth that is linear between samples, with the
// measured time step h and e = exp(-h / tau):
//   y' = e y + (1 - e) (d' - d) / h
//   z' = e z + tau (1 - e) (g(d') - g(d)) / h
// so recordings of one motion at different rates give the same features.
//
// Thread guarantee: value types; `update` is wait-free, allocates nothing and
// never throws; one thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/tick/motion_estimator.h"

namespace palpate {

inline constexpr std::size_t kMaxFeatures = 8;
inline constexpr std::size_t kDriveCoefficients = 4;

enum class FeatureKind { depth, velocity, lowpass_velocity, maxwell_branch };

// g(d) = sum_k coefficient_N[k] u^(k+1) with u = d / reference_depth_m, for
// u <= 1; beyond, g continues along its tangent at u = 1.
struct DriveCurve {
  double reference_depth_m = 1.0;
  std::array<double, kDriveCoefficients> coefficient_N{};

  double at(double depth_m) const noexcept;
  bool operator==(const DriveCurve&) const = default;
};

struct FeatureSpec {
  FeatureKind kind = FeatureKind::depth;
  double relaxation_time_s = 0.0;  // filters only
  DriveCurve drive;                // maxwell_branch only

  bool operator==(const FeatureSpec&) const = default;
};

std::string_view feature_kind_name(FeatureKind kind);
// Column name with unit, e.g. "depth_m", "lowpass_velocity_0.17s_m_per_s".
std::string feature_name(const FeatureSpec& spec);

struct FeatureVector {
  std::array<double, kMaxFeatures> values{};
  double depth_m = 0.0;  // from the raw position: max(0, position)
  bool in_contact = false;
};

// The filters behind one scene's features; one instance per stream of samples.
class FeatureFilter {
 public:
  // `specs`: 1 to 8 features; relaxation times > 0.
  explicit FeatureFilter(const std::vector<FeatureSpec>& specs);

  std::size_t count() const noexcept { return count_; }
  const FeatureSpec& spec(std::size_t index) const noexcept { return specs_[index]; }
  void reset() noexcept { started_ = false; }

  // `sample` and its motion estimate; times increase. The contact state is
  // that of the raw position.
  const FeatureVector& update(const ToolSample& sample, const MotionEstimate& motion) noexcept;
  // What `update` gave last.
  const FeatureVector& vector() const noexcept { return vector_; }

 private:
  std::array<FeatureSpec, kMaxFeatures> specs_{};
  std::array<double, kMaxFeatures> drive_{};  // d or g(d) at the last sample
  std::size_t count_ = 0;
  FeatureVector vector_;
  double time_s_ = 0.0;
  bool started_ = false;
};

}  // namespace palpate
