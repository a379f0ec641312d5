// A fitted force model: its data, and the ForceModel that evaluates them.
//   f(x) = clamp( T(x) + g(u) clamp(h(u), -limit, limit), lowest, largest ),   u = (x - offset) / scale
// T: the trend. h: the correction (models/model/correction.h): eq. 2 of Hoever & Harders (2009),
// a grid of its values, or none. g: the trust. Out of its domain a model is thus the
// trend: continuous, bounded, and attracting the tool at most as much as the material did. A model of the measured
// force has T = 0 and g = 1 everywhere. Thread guarantee: FittedModel is immutable; evaluation as in ForceModel.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "engine/tick/force_model.h"
#include "engine/tick/jnd.h"
#include "engine/tick/tool_sample.h"
#include "models/model/correction.h"
#include "models/model/vector_loops.h"

namespace palpate {

// The trend, a nonlinear viscoelastic solid fitted to the recordings; away from the data it is the model.
//   T(x) = E(d) + eta(d) v + mu(d) v / (1 + |v| / v_0) + sum_b z_b + sum_k y_k
// d: depth, v: velocity, z_b: force of a Maxwell spectrum, y_k: force of stops and creeping bristles; all are features
// (engine/tick/features.h). E increases with depth, and eta, mu and the stiffnesses of branches and bristles are not
// negative, so that the trend is passive. v is clamped to velocity_limit.
// Thread guarantee: value types; `at` is wait-free and allocates nothing.

// Enough for a force that grows thirty-fold in the last tenth of the depth. The penalty determines the smoothness.
inline constexpr std::size_t kElasticPieces = 32;
inline constexpr std::size_t kElasticCoefficients = 4;  // of a piece

inline constexpr std::size_t kViscosityCoefficients = 3;

// The source text that exported models share with the library.
namespace trend_equation {
using real = double;
using motion_filter::larger;
using motion_filter::smaller;
static_assert(kViscosityCoefficients == 3 && kElasticCoefficients == 4);
#define R(x) (x)
#define ELASTIC_PIECES kElasticPieces
#include "models/model/trend.inc"
#undef ELASTIC_PIECES
#undef R
}  // namespace trend_equation

// The elastic response, a cubic spline on equal pieces of the recorded depth,
//   E(u) = sum_j c_ij t^j,  i = floor(n u),  t = n u - i,  n = kElasticPieces,
// with u = depth / reference depth >= 0. Beyond u = 1 it continues along its tangent there. An evaluation takes one
// look-up and one polynomial, independent of the number of pieces.
struct ElasticSpline {
  // The coefficients of t^0 to t^3 of every piece, N.
  std::array<double, kElasticPieces * kElasticCoefficients> pieces_N{};

  double at(double u) const noexcept { return trend_equation::elastic_at(pieces_N.data(), u); }
  bool operator==(const ElasticSpline&) const = default;
};

// The kElasticTerms basis splines are the integrals from 0 to u of the quadratic B-splines on the pieces. E therefore
// increases if all weights, in newtons, are non-negative. With a penalty on the differences of neighbouring weights it
// is a P-spline (Eilers & Marx 1996).
inline constexpr std::size_t kElasticTerms = kElasticPieces + 2;
std::vector<ElasticSpline> spline_basis();
ElasticSpline combined_spline(const std::vector<ElasticSpline>& basis, const double* weights);

// The indices of the trend's inputs among the features, determined once outside the tick.
struct TrendInputs {
  explicit TrendInputs(const std::vector<FeatureSpec>& specs) noexcept;

  static constexpr std::uint8_t kNone = 255;
  std::uint8_t depth = kNone;
  std::uint8_t velocity = kNone;
  std::uint8_t force_count = 0;
  std::array<std::uint8_t, kMaxFeatures> force{};  // indices of features that are forces, ascending
};

struct Trend {
  double reference_depth_m = 1.0;  // greatest recorded depth; u = d / reference_depth_m
  ElasticSpline elastic;           // E
  std::array<double, kViscosityCoefficients> viscosity_Ns_per_m{};  // eta = sum c_k u^k, u <= 1
  std::array<double, kViscosityCoefficients> thinning_Ns_per_m{};   // mu, in the same way
  double thinning_velocity_m_per_s = 1.0;                           // v_0
  double velocity_limit_m_per_s = 0.0;

  // T(x) in newtons, of any sign. `inputs`, or `specs`: of the list of features.
  double at(const double* features, const TrendInputs& inputs) const noexcept;
  double at(const double* features, const std::vector<FeatureSpec>& specs) const noexcept {
    return at(features, TrendInputs(specs));
  }
  // The change of the elastic response where the surface is offset, E(d + by) - E(d).
  double moved_N(double depth_m, double by_m) const noexcept {
    return elastic.at(std::max(0.0, depth_m + by_m) / reference_depth_m) - elastic.at(depth_m / reference_depth_m);
  }
};

// The distance of a feature vector from the data of a model, and the trust in the correction there. The domain is the
// neighbourhood of the recorded samples in the normalised feature space, not their bounding box, which is mostly empty.
// The guard stores the cover, a thinned set of the sites that has every site well within inner_radius, and gives the
// trust g(x): 1 for distance <= inner_radius, 0 for distance >= outer_radius, smoothstep between, with slope at most
// 1.5 / (outer - inner). Points are compared in single precision; the error of a distance is at most
// 3e-7 (|x| + largest |point|) + 1e-10.
// Thread guarantee: immutable; queries are wait-free and allocate nothing, any thread.

inline constexpr Eigen::Index kMaximumCoverPoints = 768;

struct DomainCover {
  Eigen::MatrixXd points;  // d x M, normalised
  double inner_radius = 0.0, outer_radius = 0.0;
};

// The trust g at a distance from the cover.
double trust_at_distance(double distance, double inner_radius, double outer_radius) noexcept;

// Thins `sites` (d x N, N >= 1) to a cover of at most kMaximumCoverPoints points.
DomainCover make_cover(const Eigen::MatrixXd& sites);

// The distance of a query to the nearest of a set of points, which are in cells. A query first examines the cell of the
// last one, so that one in a stream of ticks seldom examines another; the result does not depend on that.
class NearestDistance {
 public:
  // `points`: d x N, d from 1 to kMaxFeatures, N >= 1.
  explicit NearestDistance(const Eigen::MatrixXd& points);

  // min_i |x - point_i|^2, or 0 if that is at most `enough`; infinite when x is not finite or has a coordinate beyond
  // 1e19. O(N) at worst.
  double squared(const double* x, float enough = -1.0F) const noexcept;

 private:
  std::size_t dimension_;
  Eigen::MatrixXf points_, low_, high_;  // of simd::Cells
  decltype(simd::Loops::nearest) nearest_ = nullptr;
  mutable std::atomic<std::uint32_t> last_cell_{0};  // a hint
};

// The trust around a cover.
class DomainGuard {
 public:
  explicit DomainGuard(const DomainCover& cover);

  // `x`: d normalised values. Returns g in [0, 1]; 0 when x is not finite.
  double trust(const double* x) const noexcept { return trust_at(squared_distance(x)); }
  // The squared distance to the cover; 0 within the inner radius, where the trust is 1 and the error bound does not
  // grow; infinite when x is not finite.
  double squared_distance(const double* x) const noexcept { return points_.squared(x, near_squared_); }
  double trust_at(double squared_distance) const noexcept;

 private:
  double inner_radius_, outer_radius_;
  float near_squared_;  // at most the square of the inner radius
  NearestDistance points_;
};

// The offset of a training recording: of its positions from the surface of the model, and of its forces. 0: as
// recorded.
struct RecordingOffset {
  std::string name;
  double offset_m = 0.0;
  double standard_error_m = 0.0;  // infinite: not identified
  double force_zero_N = 0.0;
  std::uint64_t content_hash = 0;  // of its rows as recorded; not stored in files
};

// The origin of a model; it has no effect on the forces.
struct Provenance {
  std::vector<std::string> recordings;
  std::vector<RecordingOffset> offsets;
  std::string scene;
  std::uint64_t samples = 0;  // rows of all recordings
  std::uint64_t contact_samples = 0, samples_after_reduction = 0, seed = 0;
  std::string weighting;   // jnd, relative, none
  std::string thinning;    // coverage, force, none
  std::string relaxation;  // scene, auto, given
  double training_within_jnd = 0.0;
};

// The bound on the error of a model's force where no force is measured, at 95 %:
//   bound(x) = floor + per_force |f(x)| + per_distance max(0, distance(x) - inner radius) + E(d + surface error) - E(d)
//   >= |model - material|
// distance: to the nearest training data in the normalised feature space. The first three coefficients are fitted
// to errors of whole recordings or presses that were left out, and scaled by a quantile over these
// (models/fit/fit.h). Sources: Vovk (2015), "Cross-conformal predictors"; Lei, G'Sell, Rinaldo, Tibshirani &
// Wasserman (2018), section 5.2 (locally weighted).
struct ErrorBound {
  double floor_N = 0.0, per_force = 0.0, per_distance_N = 0.0;
  double surface_error_m = 0.0;  // standard error of the surface of the next recording

  // Without the last term. `beyond`: distance - inner radius. An infinite distance gives an infinite bound.
  double at(double force_N, double beyond) const noexcept {
    return floor_N + per_force * std::abs(force_N) + per_distance_N * std::max(0.0, beyond);
  }
};

// Of the features.
struct Normalisation {
  Eigen::VectorXd offset;  // SI
  Eigen::VectorXd scale;   // SI, > 0; 1 for a feature that never changes
  Eigen::VectorXd lower;   // bounds in contact, SI
  Eigen::VectorXd upper;

  // Upper minus lower bound; 0 at the level of rounding.
  double range(Eigen::Index feature) const;
  // The scale range^a (4 sigma)^(1 - a) of each feature; a = 1/2 gives `scale`.
  Eigen::VectorXd scale_of(double range_exponent) const;
};

struct ModelData : Normalisation {
  std::string name;    // of its plan (models/fit/fit.h), e.g. "trend+greedy-100"
  std::string method;  // the name without the number of centres, e.g. "trend+greedy"
  std::vector<FeatureSpec> features;
  Trend trend;
  double correction_limit_N = 0.0;
  double largest_force_N = 0.0;  // of the training data; the output is at most 1.2 times this
  double lowest_force_N = 0.0;   // of the training data if the material pulls, else 0; <= 0
  // The force at the outer end of recordings that never leave the material; else 0. In air the model's force is 0, so
  // that it steps there, and the model is out of its domain above the recorded depths.
  double surface_step_N = 0.0;
  // Of each recording of the provenance, in its order; empty: not known, and every stream begins at rest.
  std::vector<RecordingEnds> ends;
  DomainCover cover;
  std::optional<ErrorBound> error_bound;  // none of a fit to the measured force, or to a single press
  // The position sensor of the training recordings, the coarsest of them: the default sensor of streams and exported
  // files; no effect on the force of a feature vector. None: not known.
  std::optional<SensorSpec> sensor;
  JndLine jnd;
  CorrectionPtr correction;  // h; shared by copies; null: none
  Provenance provenance;

  // Of the correction: its centres, or the nodes of its grid.
  int centre_count() const noexcept { return correction ? correction->size() : 0; }
};

inline constexpr double kForceMargin = 1.2;
// The inner radius of a trust that is 1 everywhere: normalised features are about 1.
inline constexpr double kEverywhere = 1e6;

// Checks the forces at the points of the cover. Errors: a part of the force is not finite or far above the limits of
// the model.
Status check_forces(const ModelData& data);
// The sensor of a tool with this encoder step: the sensor of the training recordings if the step is theirs or 0 (not
// known), else one with this step and no noise.
SensorSpec sensor_with_step(const ModelData& data, double encoder_step_m);

// How a stream of this model began (HapticsTick::began): "at rest", "as the end of NAME", or "as the end of the
// recording before".
std::string began_words(const ModelData& data, int began);

class FittedModel final : public ForceModel {
 public:
  // `data`: from a fit or a file, with sizes that match.
  explicit FittedModel(ModelData data);

  double force(const double* features) const noexcept override;
  void assess(const double* features, ForceEstimate& estimate) const noexcept override;
  const std::vector<FeatureSpec>& features() const noexcept override { return data_.features; }
  // The greatest depth in the domain; a greater one is out of it at any distance from the data. Infinite without a
  // depth feature.
  double deepest_m() const noexcept override { return deepest_m_; }
  double shallowest_m() const noexcept override { return shallowest_m_; }
  const std::vector<RecordingEnds>& ends() const noexcept override { return data_.ends; }
  const std::string& name() const noexcept override { return data_.name; }
  const std::string& method() const noexcept override { return data_.method; }
  int centre_count() const noexcept override { return data_.centre_count(); }

  const ModelData& data() const noexcept { return data_; }
  // The index of the depth feature; 0 without one.
  std::size_t depth_feature() const noexcept { return depth_; }

 private:
  std::array<double, kMaxFeatures> normalised(const double* features) const noexcept {
    std::array<double, kMaxFeatures> u;
    for (std::size_t i = 0; i < dimension_; ++i) u[i] = (features[i] - offset_[i]) * inverse_scale_[i];
    return u;
  }

  ModelData data_;
  TrendInputs trend_inputs_;
  DomainGuard guard_;
  std::size_t dimension_ = 0;
  std::size_t depth_ = 0;
  double deepest_m_ = std::numeric_limits<double>::infinity(), shallowest_m_ = 0.0;
  bool trusts_everywhere_ = false;
  std::array<double, kMaxFeatures> offset_{};
  std::array<double, kMaxFeatures> inverse_scale_{};
};

}  // namespace palpate
