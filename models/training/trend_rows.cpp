#include "models/training/trend_rows.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "engine/base/text.h"

namespace palpate {
namespace {

// Neighbouring times differ by a factor of 1.8; a sum of two fits any time between them better than the data resolve.
constexpr double kTimesPerDecade = 4.0;
// 1 ms is the tick; no exploration shows what takes longer than 100 s.
constexpr double kShortest_s = 1e-3;
constexpr double kLongest_s = 100.0;
constexpr std::size_t kBands = 3;
// The trend limits velocities to this multiple of the greatest recorded one.
constexpr double kVelocityMargin = 1.5;

std::vector<double> ladder(double shortest_s, double longest_s, double per_decade) {
  std::vector<double> times_s;
  // Rounding must not drop the last time.
  const double end_s = longest_s * (1.0 + 1e-9);
  for (int i = 0;; ++i) {
    const double time_s = shortest_s * std::pow(10.0, i / per_decade);
    if (!(time_s <= end_s)) return times_s;
    times_s.push_back(time_s);
  }
}

double longest_time_s(const TrainingExtent& extent) { return std::min(kLongest_s, extent.longest_recording_s / 3.0); }

// The quadratic Bernstein polynomials (1 - u)^2, 2 u (1 - u) and u^2: coefficients of u^0 .. u^2.
constexpr std::array<std::array<double, kViscosityCoefficients>, kViscosityCoefficients> kViscousBasis{
    {{1.0, -2.0, 1.0}, {0.0, 2.0, -2.0}, {0.0, 0.0, 1.0}}};
// Their integrals, and the friction of a bristle: coefficients of u^1 .. u^4.
using Basis = std::array<std::array<double, kDriveCoefficients>, kCurveTerms>;
constexpr Basis kDrives{{{1.0, -1.0, 1.0 / 3.0, 0.0}, {0.0, 1.0, -2.0 / 3.0, 0.0}, {0.0, 0.0, 1.0 / 3.0, 0.0}}};
constexpr Basis kFrictions{{{4.0, -6.0, 4.0, -1.0}, {1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}}};

// One feature for each term of a bristle.
FeatureFilter bristle(FeatureKind kind, FeaturePart part, double reference_depth_m) {
  if (kind == FeatureKind::creep) part.threshold_m = reference_depth_m;
  std::vector<FeatureSpec> specs;
  for (const DriveCurve& curve : curve_basis(kind, reference_depth_m)) {
    part.drive = curve;
    FeatureSpec& spec = specs.emplace_back(FeatureSpec{kind});
    spec.part_count = 1;
    spec.parts[0] = part;
  }
  return FeatureFilter(specs);
}

Trend trend_from(const TrendRows& rows, const Eigen::VectorXd& x) {
  Trend trend;
  trend.reference_depth_m = rows.problem().reference_depth_m;
  trend.elastic = combined_spline(spline_basis(), x.data());
  if (has_kind(rows.list().features, FeatureKind::velocity)) {
    trend.thinning_velocity_m_per_s = rows.problem().rms_velocity_m_per_s;
    auto column = static_cast<Eigen::Index>(kElasticTerms);
    for (auto* viscosity : {&trend.viscosity_Ns_per_m, &trend.thinning_Ns_per_m}) {
      for (std::size_t k = 0; k < kViscosityCoefficients; ++k, ++column) {
        for (std::size_t j = 0; j < kViscosityCoefficients; ++j) (*viscosity)[j] += x(column) * kViscousBasis[k][j];
      }
    }
  }
  for (std::size_t i = 0; i < rows.count(); ++i) {
    trend.velocity_limit_m_per_s =
        std::max(trend.velocity_limit_m_per_s, kVelocityMargin * std::abs(rows[i].velocity_m_per_s));
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

std::vector<double> dictionary_times_s(const TrainingExtent& extent) {
  return ladder(std::max(kShortest_s, 2.0 * extent.sample_s), longest_time_s(extent), kTimesPerDecade);
}

FeatureList dictionary(const TrainingExtent& extent, double encoder_step_m) {
  FeatureList list;
  list.add(FeatureKind::velocity);
  const std::vector<double> times_s = dictionary_times_s(extent);
  for (std::size_t band = 0; band < kBands; ++band) {
    const auto from = times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() * band / kBands);
    const auto to = times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() * (band + 1) / kBands);
    list.add(FeatureKind::maxwell_spectrum, {from, to});
  }
  std::vector<double> thresholds_m;
  for (double threshold_m = 0.5 * extent.depth_m;
       thresholds_m.size() < kMaxFeatureParts && threshold_m >= encoder_step_m; threshold_m *= 0.5) {
    thresholds_m.insert(thresholds_m.begin(), threshold_m);
  }
  list.add(FeatureKind::stops, thresholds_m);
  list.add(FeatureKind::creep, ladder(kShortest_s, longest_time_s(extent), 1.0));
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
  for (std::size_t k = 0; k < kCurveTerms; ++k) {
    for (std::size_t j = 0; j < kDriveCoefficients; ++j) curve.coefficient_N[j] += weights[k] * basis[k][j];
  }
  return curve;
}

std::vector<DriveCurve> curve_basis(FeatureKind kind, double reference_depth_m) {
  std::vector<DriveCurve> curves;
  for (std::size_t k = 0; k < kCurveTerms; ++k) {
    std::array<double, kCurveTerms> one{};
    one[k] = 1.0;
    curves.push_back(combined_curve(kind, one.data(), reference_depth_m));
  }
  return curves;
}

TrendRows::TrendRows(FeatureList list, const TrendProblem& problem, std::size_t stride)
    : list_(std::move(list)), problem_(problem), stride_(stride), elastic_basis_(spline_basis()) {
  if (!list_.surface.empty()) surface_.emplace_back(list_.surface);
  const double depth_m = problem_.reference_depth_m;
  const std::vector<DriveCurve> drives = curve_basis(FeatureKind::maxwell_spectrum, depth_m);
  for (const FeatureSpec& spec : list_.features) {
    for (std::size_t p = 0; p < spec.part_count; ++p) {
      if (is_bristle(spec.kind)) bristles_.push_back(bristle(spec.kind, spec.parts[p], depth_m));
      if (!is_branch(spec.kind)) continue;
      ++branch_count_;
      for (std::size_t k = 0; k < kCurveTerms; ++k) {
        branches_[k].add(drives[k], spec.parts[p].relaxation_time_s, spec.slowing, depth_m);
      }
    }
    const std::size_t count = spec.kind == FeatureKind::depth      ? kElasticTerms
                              : spec.kind == FeatureKind::velocity ? 2 * kViscosityCoefficients
                                                                   : kCurveTerms * spec.part_count;
    ColumnList& columns = feature_columns_.emplace_back(count);
    std::iota(columns.begin(), columns.end(), static_cast<Eigen::Index>(columns_));
    columns_ += count;
  }
}

// `depth_m`: that of the tool, at most that of the material's surface (engine/tick/features.h).
void TrendRows::update_branches(double time_s, double depth_m, double surface_m) {
  if (!started_) branch_memory_ = {};
  BranchLanes::Step step[kMaxLaneGroups];
  const double step_s = started_ ? time_s - last_time_s_ : 0.0;
  branches_[0].prepare(step_s, surface_halfway(last_surface_m_, last_depth_m_, depth_m), step);
  for (std::size_t k = 0; k < kCurveTerms; ++k) {
    branches_[k].advance(step, surface_m, branch_memory_[k], branch_memory_[k]);
  }
  started_ = true;
  last_time_s_ = time_s;
  last_depth_m_ = depth_m;
  last_surface_m_ = surface_m;
}

void TrendRows::add(const MotionRow& sample) {
  if (sample.first) started_ = false;
  for (auto* filters : {&surface_, &bristles_}) {
    for (FeatureFilter& filter : *filters) {
      if (sample.first) filter.reset();
      filter.update(sample.sample, sample.motion);
    }
  }
  const double depth_m = std::max(0.0, sample.motion.position_m);
  const double surface_m = surface_.empty() ? depth_m : surface_.front().surface_m();
  update_branches(sample.sample.time_s, depth_m, surface_m);
  if (!(sample.sample.position_m > 0.0)) return;
  if (seen_++ % stride_ != 0) return;
  const double velocity_m_per_s = depth_m > 0.0 ? sample.motion.velocity_m_per_s : 0.0;
  const double u = std::min(depth_m / problem_.reference_depth_m, 1.0);
  values_.resize(values_.size() + columns_);
  double* to = values_.data() + (values_.size() - columns_);
  for (const ElasticSpline& curve : elastic_basis_) *to++ = curve.at(u);
  if (has_kind(list_.features, FeatureKind::velocity)) {
    for (const double v : {velocity_m_per_s, thinned_velocity(velocity_m_per_s, problem_.rms_velocity_m_per_s)}) {
      for (const auto& power : kViscousBasis) *to++ = v * polynomial(power, u);
    }
  }
  for (std::size_t i = 0; i < branch_count_; ++i) {
    for (const PartMemory& memory : branch_memory_) *to++ = sum_of_lanes(memory.value, i, 1);
  }
  for (const FeatureFilter& filter : bristles_) to = std::copy_n(filter.vector().values.begin(), kCurveTerms, to);
  rows_.push_back({sample.force_N, velocity_m_per_s, depth_m, surface_m - depth_m, sample.fold});
}

Result<TrendRows> gather_rows(const TrendData& data, const FeatureList& list, std::size_t most_rows,
                              double least_step_s) {
  // Calls `visit` for every sample that is used.
  const auto pass = [&](const auto& visit) {
    double last_s = 0.0;
    return data.source.for_each(
        [&](const MotionRow& row) {
          if (!row.first && row.sample.time_s - last_s < least_step_s) return;
          last_s = row.sample.time_s;
          visit(row);
        },
        data.control);
  };
  std::size_t count = 0;
  Status status = pass([&](const MotionRow& row) {
    if (row.sample.position_m > 0.0) ++count;
  });
  if (!status) return status.error();
  TrendRows rows(list, data.problem, std::bit_ceil((count + most_rows - 1) / most_rows));
  status = pass([&](const MotionRow& row) { rows.add(row); });
  if (!status) return status.error();
  return rows;
}

FeatureSpec surface_lag_of(const ElasticSpline& elastic, double reference_depth_m) {
  constexpr std::size_t kCoarsePieces = kDriveKnots + 1;
  constexpr double kWidth = 1.0 / kCoarsePieces;
  // The Greville abscissae in units of a piece.
  std::array<double, kCoarsePieces + 3> average{};
  for (std::size_t i = 1; i <= kCoarsePieces + 1; ++i) average[i] = static_cast<double>(i) - 1.0;
  average[1] = 1.0 / 3.0;
  average[kCoarsePieces + 1] = kCoarsePieces - 1.0 / 3.0;
  average[kCoarsePieces + 2] = kCoarsePieces;
  // The slope is a quadratic B-spline: its weights, and the second derivative of the curve at each knot.
  std::array<double, kCoarsePieces + 2> weight{};
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = (elastic.at(average[i + 1] * kWidth) - elastic.at(average[i] * kWidth)) /
                ((average[i + 1] - average[i]) * kWidth);
  }
  std::array<double, kCoarsePieces + 1> bend{};
  for (std::size_t k = 0; k <= kCoarsePieces; ++k) {
    bend[k] = (k == 0 || k == kCoarsePieces ? 2.0 : 1.0) * (weight[k + 1] - weight[k]) / kWidth;
  }
  const auto cube = [&](std::size_t piece) { return (bend[piece + 1] - bend[piece]) / (6.0 * kWidth); };
  FeatureSpec lag{FeatureKind::surface_lag};
  DriveCurve& curve = lag.drive;
  curve.reference_depth_m = reference_depth_m;
  curve.has_knots = true;
  curve.coefficient_N = {weight[0], 0.5 * bend[0], cube(0), 0.0};
  for (std::size_t k = 0; k < kDriveKnots; ++k) curve.knot_N[k] = cube(k + 1) - cube(k);
  return lag;
}

FittedTrend fitted_trend(const TrendRows& rows, const Eigen::VectorXd& x, bool all) {
  const double depth_m = rows.problem().reference_depth_m;
  FittedTrend fitted{trend_from(rows, x), {}, {}};
  // Adds a feature with its value at each row.
  const auto add = [&](const FeatureSpec& spec, const auto& value_at) {
    fitted.features.push_back(spec);
    Eigen::MatrixXd& values = fitted.row_features;
    values.conservativeResize(values.rows() + 1, static_cast<Eigen::Index>(rows.count()));
    for (std::size_t i = 0; i < rows.count(); ++i)
      values(values.rows() - 1, static_cast<Eigen::Index>(i)) = value_at(i);
  };
  for (std::size_t f = 0; f < rows.list().features.size(); ++f) {
    const FeatureSpec& candidate = rows.list().features[f];
    const ColumnList& columns = rows.feature_columns()[f];
    const Eigen::VectorXd weights = x(columns);
    if (candidate.kind == FeatureKind::depth) {
      add(candidate, [&](std::size_t i) { return rows[i].depth_m; });
      if (rows.list().surface.empty()) continue;
      add(surface_lag_of(fitted.trend.elastic, depth_m), [&](std::size_t i) { return rows[i].lag_m; });
    } else if (candidate.kind == FeatureKind::velocity) {
      add(candidate, [&](std::size_t i) { return rows[i].velocity_m_per_s; });
    } else if (all || weights.maxCoeff() > 0.0) {
      add(with_drives(candidate, weights.data(), depth_m, all), [&](std::size_t i) {
        const auto terms = rows.terms().row(static_cast<Eigen::Index>(i));
        return std::inner_product(columns.begin(), columns.end(), weights.begin(), 0.0, std::plus<>(),
                                  [&](Eigen::Index column, double weight) { return terms(column) * weight; });
      });
    }
  }
  return fitted;
}

}  // namespace palpate
