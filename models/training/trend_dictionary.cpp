#include "models/training/trend_dictionary.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/text.h"
#include "models/model/bernstein.h"

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

std::string range_text(const char* words, const std::vector<double>& values, double unit, const char* unit_name) {
  std::string text = std::string(words) + " " + general(unit * values.front(), 3);
  if (values.size() > 1) text.append("-").append(general(unit * values.back(), 3));
  return text + " " + unit_name;
}

Trend trend_from(const TrendRows& rows, const Eigen::VectorXd& x) {
  Trend trend;
  trend.reference_depth_m = rows.problem().reference_depth_m;
  trend.elastic = combined_spline(spline_basis(), x.data());
  auto column = static_cast<Eigen::Index>(kElasticTerms);
  if (rows.viscous_columns() > 0) {
    trend.thinning_velocity_m_per_s = rows.problem().rms_velocity_m_per_s;
    for (auto* viscosity : {&trend.viscosity_Ns_per_m, &trend.thinning_Ns_per_m}) {
      for (std::size_t k = 0; k < kViscosityCoefficients; ++k, ++column) {
        const auto power = bernstein<kViscosityCoefficients - 1>(k);
        for (std::size_t j = 0; j < power.size(); ++j) (*viscosity)[j] += x(column) * power[j];
      }
    }
  }
  for (std::size_t i = 0; i < rows.count(); ++i) {
    trend.velocity_limit_m_per_s =
        std::max(trend.velocity_limit_m_per_s, kVelocityMargin * std::abs(rows[i].velocity_m_per_s));
  }
  return trend;
}

// Makes one feature of the parts with a weight above 0, or of all parts if `all`.
FeatureSpec parts_feature(const FeatureColumns& group, const Eigen::VectorXd& x, const TrendRows& rows, bool all) {
  const double depth_m = rows.problem().reference_depth_m;
  FeatureSpec spec;
  spec.kind = group.kind;
  for (std::size_t p = 0; p < group.constants.size(); ++p) {
    const double* weights = x.data() + group.columns[p * kCurveTerms];
    const bool carries = std::any_of(weights, weights + kCurveTerms, [](double weight) { return weight > 0.0; });
    if (!carries && !all) continue;
    FeaturePart& part = spec.parts[spec.part_count++];
    part.drive = combined_curve(group.kind, weights, depth_m);
    (group.kind == FeatureKind::stops ? part.threshold_m : part.relaxation_time_s) = group.constants[p];
    if (group.kind == FeatureKind::creep) part.threshold_m = depth_m;
  }
  if (group.kind == FeatureKind::maxwell_spectrum) spec.slowing = rows.list().slowing;
  return spec;
}

}  // namespace

FeatureList dictionary(double sample_s, double longest_s, double depth_m, double encoder_step_m) {
  FeatureList list;
  list.velocity = true;
  const double longest_time_s = std::min(kLongest_s, longest_s / 3.0);
  const std::vector<double> times_s = ladder(std::max(kShortest_s, 2.0 * sample_s), longest_time_s, kTimesPerDecade);
  for (std::size_t band = 0; band < kBands; ++band) {
    const auto from = times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() * band / kBands);
    const auto to = times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() * (band + 1) / kBands);
    if (from != to) list.relaxation_times_s.emplace_back(from, to);
  }
  for (double threshold_m = 0.5 * depth_m;
       list.stop_thresholds_m.size() < kMaxFeatureParts && threshold_m >= encoder_step_m; threshold_m *= 0.5) {
    list.stop_thresholds_m.insert(list.stop_thresholds_m.begin(), threshold_m);
  }
  list.creep_times_s = ladder(kShortest_s, longest_time_s, 1.0);
  return list;
}

Result<TrendRows> gather_rows(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                              std::size_t most_rows, double least_step_s, const FitControl& control, double fraction) {
  TrendRows rows(list, problem, most_rows);
  double last_s = 0.0;
  const Status status = source.for_each(
      [&](const MotionRow& row) {
        if (row.first) rows.begin_recording();
        if (!row.first && row.sample.time_s - last_s < least_step_s) return true;
        last_s = row.sample.time_s;
        if (row.run_up)
          rows.advance(row.sample, row.motion);
        else
          rows.add(row.sample, row.motion, row.force_N, row.fold);
        return true;
      },
      control, fraction);
  if (!status) return status.error();
  return rows;
}

std::vector<FeatureColumns> feature_columns(const TrendRows& rows) {
  const FeatureList& list = rows.list();
  std::vector<FeatureColumns> groups;
  if (list.velocity) {
    groups.push_back({FeatureKind::velocity, "velocity", {}, columns_from(kElasticTerms, rows.viscous_columns())});
  }
  std::size_t first = rows.first_branch();
  const auto add = [&](FeatureKind kind, const char* words, const std::vector<double>& constants, double unit,
                       const char* unit_name) {
    if (constants.empty()) return;
    const std::size_t count = kCurveTerms * constants.size();
    groups.push_back({kind, range_text(words, constants, unit, unit_name), constants, columns_from(first, count)});
    first += count;
  };
  for (const auto& times_s : list.relaxation_times_s) {
    add(FeatureKind::maxwell_spectrum, "relaxation", times_s, 1.0, "s");
  }
  add(FeatureKind::stops, "stops", list.stop_thresholds_m, 1e3, "mm");
  add(FeatureKind::creep, "creep", list.creep_times_s, 1.0, "s");
  return groups;
}

FittedTrend fitted_trend(const TrendRows& rows, const Eigen::VectorXd& x, bool all) {
  FittedTrend fitted{trend_from(rows, x), {FeatureSpec{}}, {}};
  if (!rows.list().surface.empty()) {
    FeatureSpec lag{FeatureKind::surface_lag};
    lag.drive = coarse_curve(fitted.trend.elastic, rows.problem().reference_depth_m);
    fitted.features.push_back(lag);
  }
  std::vector<ColumnList> sums;  // the columns of each feature that is a sum of columns
  for (const FeatureColumns& group : feature_columns(rows)) {
    if (group.kind == FeatureKind::velocity) {
      fitted.features.push_back({FeatureKind::velocity});
    } else if (all || (x(group.columns).array() > 0.0).any()) {
      fitted.features.push_back(parts_feature(group, x, rows, all));
      sums.push_back(group.columns);
    }
  }
  fitted.row_features.resize(static_cast<Eigen::Index>(fitted.features.size()),
                             static_cast<Eigen::Index>(rows.count()));
  for (std::size_t i = 0; i < rows.count(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd row = rows.terms().row(at).transpose();
    std::size_t sum = 0;
    for (std::size_t f = 0; f < fitted.features.size(); ++f) {
      double& value = fitted.row_features(static_cast<Eigen::Index>(f), at);
      switch (fitted.features[f].kind) {
        case FeatureKind::depth:
          value = rows[i].depth_m;
          break;
        case FeatureKind::velocity:
          value = rows[i].velocity_m_per_s;
          break;
        case FeatureKind::surface_lag:
          value = rows[i].lag_m;
          break;
        default:
          value = row(sums[sum]).dot(x(sums[sum]));
          ++sum;
      }
    }
  }
  return fitted;
}

}  // namespace palpate
