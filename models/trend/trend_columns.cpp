#include "models/trend/trend_columns.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/base/text.h"

namespace palpate {
namespace {

// Times up to a third of the longest recording and 100 s, because no exploration shows what takes longer.
std::vector<double> ladder(const Samples& samples, double shortest_s, double per_decade) {
  std::vector<double> times_s;
  // Rounding must not drop the last time.
  const double end_s = std::min(100.0, samples.longest_recording_s / 3.0) * (1.0 + 1e-9);
  for (int i = 0;; ++i) {
    const double time_s = shortest_s * std::pow(10.0, i / per_decade);
    if (!(time_s <= end_s)) return times_s;
    times_s.push_back(time_s);
  }
}

// The quadratic Bernstein polynomials (1 - u)^2, 2 u (1 - u) and u^2: coefficients of u^0 .. u^2.
constexpr std::array<std::array<double, kViscosityCoefficients>, kViscosityCoefficients> kViscousBasis{
    {{1.0, -2.0, 1.0}, {0.0, 2.0, -2.0}, {0.0, 0.0, 1.0}}};
// Their integrals, and the friction of a bristle: coefficients of u^1 .. u^4.
using Basis = std::array<std::array<double, kDriveCoefficients>, kCurveTerms>;
constexpr Basis kDrives{{{1.0, -1.0, 1.0 / 3.0, 0.0}, {0.0, 1.0, -2.0 / 3.0, 0.0}, {0.0, 0.0, 1.0 / 3.0, 0.0}}};
constexpr Basis kFrictions{{{4.0, -6.0, 4.0, -1.0}, {1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}}};

// Of the elastic response. A material that is pulled at its outermost position has a force below 0 there, at which E
// begins instead of at 0.
std::vector<ElasticSpline> elastic_basis(const Samples& samples) {
  std::vector<ElasticSpline> basis = spline_basis();
  if (!samples.surface_outside || samples.lowest_force_N == 0.0) return basis;
  ElasticSpline& pull = basis.emplace_back();
  for (std::size_t piece = 0; piece < kElasticPieces; ++piece) pull.pieces_N[piece * kElasticCoefficients] = -1.0;
  return basis;
}

// One feature for each basis function of a part.
void add_columns(std::vector<FeatureSpec>& columns, const FeatureSpec& candidate, std::size_t part,
                 double reference_depth_m) {
  for (std::size_t k = 0; k < kCurveTerms; ++k) {
    std::array<double, kCurveTerms> one{};
    one[k] = 1.0;
    FeatureSpec& column = columns.emplace_back(FeatureSpec{candidate.kind});
    column.slowing = candidate.slowing;
    column.part_count = 1;
    column.parts[0] = candidate.parts[part];
    column.parts[0].drive = combined_curve(candidate.kind, one.data(), reference_depth_m);
    if (candidate.kind == FeatureKind::creep) column.parts[0].threshold_m = reference_depth_m;
  }
}

Trend trend_from(const TrendColumns& columns, const Eigen::VectorXd& x) {
  const Samples& samples = columns.samples();
  Trend trend;
  trend.reference_depth_m = samples.depth_m;
  const std::vector<ElasticSpline> elastic = elastic_basis(samples);
  trend.elastic = combined_spline(elastic, x.data());
  if (has_kind(columns.list().features, FeatureKind::velocity)) {
    trend.thinning_velocity_m_per_s = samples.rms_velocity_m_per_s;
    auto column = static_cast<Eigen::Index>(elastic.size());
    for (auto* viscosity : {&trend.viscosity_Ns_per_m, &trend.thinning_Ns_per_m}) {
      for (std::size_t k = 0; k < kViscosityCoefficients; ++k, ++column)
        for (std::size_t j = 0; j < kViscosityCoefficients; ++j) (*viscosity)[j] += x(column) * kViscousBasis[k][j];
    }
  }
  for (const std::size_t row : columns.rows()) {
    const double velocity_m_per_s = samples.rows[row].motion.velocity_m_per_s;
    trend.velocity_limit_m_per_s = std::max(trend.velocity_limit_m_per_s, 1.5 * std::abs(velocity_m_per_s));
  }
  return trend;
}

// The feature with the drive curves of `weights`, without the parts whose weights are 0, unless `all`.
FeatureSpec with_drives(const FeatureSpec& candidate, const double* weights, double depth_m, bool all) {
  FeatureSpec spec = candidate;
  spec.part_count = 0;
  spec.parts = {};
  for (std::size_t p = 0; p < candidate.part_count; ++p, weights += kCurveTerms) {
    const bool carries = std::any_of(weights, weights + kCurveTerms, [](double weight) { return weight > 0.0; });
    if (!carries && !all) continue;
    FeaturePart& part = spec.parts[spec.part_count++] = candidate.parts[p];
    part.drive = combined_curve(spec.kind, weights, depth_m);
    if (spec.kind == FeatureKind::creep) part.threshold_m = depth_m;
  }
  return spec;
}

}  // namespace

bool has_kind(const std::vector<FeatureSpec>& features, FeatureKind kind) {
  return std::ranges::find(features, kind, &FeatureSpec::kind) != features.end();
}

void FeatureList::add(FeatureKind kind, const std::vector<double>& constants) {
  if (has_parts(kind) && constants.empty()) return;
  FeatureSpec spec{kind};
  for (const double constant : constants) {
    FeaturePart& part = spec.parts[spec.part_count++];
    (kind == FeatureKind::stops ? part.threshold_m : part.relaxation_time_s) = constant;
  }
  features.insert(std::ranges::upper_bound(features, kind, {}, &FeatureSpec::kind), spec);
}

std::vector<double> relaxation_times_s(const std::vector<FeatureSpec>& features) {
  std::vector<double> times_s;
  for (const FeatureSpec& spec : features) {
    if (has_time(spec.kind)) times_s.push_back(spec.relaxation_time_s);
    if (!is_branch(spec.kind)) continue;
    for (const double time_s : constants_of(spec)) times_s.push_back(time_s);
  }
  return times_s;
}

std::vector<double> constants_of(const FeatureSpec& spec) {
  std::vector<double> constants;
  for (std::size_t p = 0; p < spec.part_count; ++p) {
    const FeaturePart& part = spec.parts[p];
    constants.push_back(spec.kind == FeatureKind::stops ? part.threshold_m : part.relaxation_time_s);
  }
  return constants;
}

std::vector<double> dictionary_times_s(const Samples& samples) {
  // Neighbours differ by a factor of 1.8; a sum of two fits any time between them better than the data resolve.
  return ladder(samples, std::max(kHapticTick_s, 2.0 * samples.sample_s), 4.0);
}

FeatureList dictionary(const Samples& samples) {
  FeatureList list;
  list.add(FeatureKind::velocity);
  const std::vector<double> times_s = dictionary_times_s(samples);
  const auto third = [&](std::size_t i) {
    return times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() * i / 3);
  };
  for (const std::size_t band : {0u, 1u, 2u}) list.add(FeatureKind::maxwell_spectrum, {third(band), third(band + 1)});
  std::vector<double> thresholds_m;
  for (double threshold_m = 0.5 * samples.depth_m;
       thresholds_m.size() < kMaxFeatureParts && threshold_m >= samples.sensor.encoder_step_m; threshold_m *= 0.5)
    thresholds_m.insert(thresholds_m.begin(), threshold_m);
  list.add(FeatureKind::stops, thresholds_m);
  list.add(FeatureKind::creep, ladder(samples, kHapticTick_s, 1.0));
  return list;
}

FeatureList single_times(bool velocity, const std::vector<double>& times_s) {
  FeatureList list;
  if (velocity) list.add(FeatureKind::velocity);
  for (const double time_s : times_s) list.add(FeatureKind::maxwell_spectrum, {time_s});
  return list;
}

std::string term_name(const FeatureSpec& spec) {
  if (spec.kind == FeatureKind::velocity) return "velocity";
  const bool stops = spec.kind == FeatureKind::stops;
  const char* words = stops ? "stops " : spec.kind == FeatureKind::creep ? "creep " : "relaxation ";
  const double unit = stops ? 1e3 : 1.0;
  const std::vector<double> constants = constants_of(spec);
  std::string text = words + general(unit * constants.front(), 3);
  if (constants.size() > 1) text.append("-").append(general(unit * constants.back(), 3));
  return text + (stops ? " mm" : " s");
}

DriveCurve combined_curve(FeatureKind kind, const double* weights, double reference_depth_m) {
  const Basis& basis = is_bristle(kind) ? kFrictions : kDrives;
  DriveCurve curve;
  curve.reference_depth_m = reference_depth_m;
  for (std::size_t k = 0; k < kCurveTerms; ++k)
    for (std::size_t j = 0; j < kDriveCoefficients; ++j) curve.coefficient_N[j] += weights[k] * basis[k][j];
  return curve;
}

Result<TrendColumns> TrendColumns::make(const Samples& samples, FeatureList list, std::size_t most_rows,
                                        const FitControl& control) {
  TrendColumns made;
  made.samples_ = &samples;
  made.stride_ = (samples.contact.size() + most_rows - 1) / most_rows;
  for (std::size_t i = 0; i < samples.contact.size(); i += made.stride_) made.rows_.push_back(samples.contact[i]);
  const std::vector<ElasticSpline> elastic = elastic_basis(samples);
  std::vector<FeatureSpec> memory;  // the columns of branches and bristles
  Eigen::Index columns = 0;
  for (const FeatureSpec& spec : list.features) {
    for (std::size_t p = 0; p < spec.part_count; ++p) add_columns(memory, spec, p, samples.depth_m);
    const std::size_t count = spec.kind == FeatureKind::depth      ? elastic.size()
                              : spec.kind == FeatureKind::velocity ? 2 * kViscosityCoefficients
                                                                   : kCurveTerms * spec.part_count;
    ColumnList& of_feature = made.feature_columns_.emplace_back(count);
    std::iota(of_feature.begin(), of_feature.end(), columns);
    columns += static_cast<Eigen::Index>(count);
  }
  const auto of_memory = features_at(samples, memory, made.rows_, control);
  if (!of_memory) return of_memory.error();
  const bool viscous = has_kind(list.features, FeatureKind::velocity);
  made.list_ = std::move(list);
  made.terms_.resize(static_cast<Eigen::Index>(made.count()), columns);
  for (std::size_t i = 0; i < made.count(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double depth_m = std::max(0.0, made.depth_m(i));
    const double velocity_m_per_s = depth_m > 0.0 ? samples.rows[made.rows_[i]].motion.velocity_m_per_s : 0.0;
    const double u = std::min(depth_m / samples.depth_m, 1.0);
    double* to = made.terms_.row(row).data();
    for (const ElasticSpline& curve : elastic) *to++ = curve.at(u);
    if (viscous) {
      for (const double v : {velocity_m_per_s, trend_equation::thinned(velocity_m_per_s, samples.rms_velocity_m_per_s)})
        for (const auto& power : kViscousBasis) *to++ = v * trend_equation::quadratic(power.data(), u);
    }
    std::copy(of_memory->col(row).begin(), of_memory->col(row).end(), to);
  }
  return made;
}

FittedTrend fitted_trend(const TrendColumns& columns, const Eigen::VectorXd& x, bool all) {
  const double depth_m = columns.samples().depth_m;
  FittedTrend fitted{trend_from(columns, x), {}};
  for (std::size_t f = 0; f < columns.list().features.size(); ++f) {
    const FeatureSpec& candidate = columns.list().features[f];
    const Eigen::VectorXd weights = x(columns.feature_columns()[f]);
    if (!has_parts(candidate.kind))
      fitted.features.push_back(candidate);
    else if (all || weights.maxCoeff() > 0.0)
      fitted.features.push_back(with_drives(candidate, weights.data(), depth_m, all));
  }
  return fitted;
}

}  // namespace palpate
