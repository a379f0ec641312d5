#include "models/training/trend_dictionary.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>

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

double longest_time_s(const TrainingExtent& extent) { return std::min(kLongest_s, extent.longest_recording_s / 3.0); }

Trend trend_from(const TrendRows& rows, const Eigen::VectorXd& x) {
  Trend trend;
  trend.reference_depth_m = rows.problem().reference_depth_m;
  trend.elastic = combined_spline(spline_basis(), x.data());
  if (has_kind(rows.list().features, FeatureKind::velocity)) {
    trend.thinning_velocity_m_per_s = rows.problem().rms_velocity_m_per_s;
    auto column = static_cast<Eigen::Index>(kElasticTerms);
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
    if (from != to) list.add(FeatureKind::maxwell_spectrum, {from, to});
  }
  std::vector<double> thresholds_m;
  for (double threshold_m = 0.5 * extent.depth_m;
       thresholds_m.size() < kMaxFeatureParts && threshold_m >= encoder_step_m; threshold_m *= 0.5) {
    thresholds_m.insert(thresholds_m.begin(), threshold_m);
  }
  if (!thresholds_m.empty()) list.add(FeatureKind::stops, thresholds_m);
  const std::vector<double> creep_times_s = ladder(kShortest_s, longest_time_s(extent), 1.0);
  if (!creep_times_s.empty()) list.add(FeatureKind::creep, creep_times_s);
  return list;
}

FeatureList single_times(bool velocity, const std::vector<double>& times_s) {
  FeatureList list;
  if (velocity) list.add(FeatureKind::velocity);
  for (const double time_s : times_s) list.add(FeatureKind::maxwell_spectrum, {time_s});
  return list;
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
    if (row.sample.position_m > 0.0 && !row.run_up) ++count;
  });
  if (!status) return status.error();
  TrendRows rows(list, data.problem, std::bit_ceil((count + most_rows - 1) / most_rows));
  status = pass([&](const MotionRow& row) { rows.add(row); });
  if (!status) return status.error();
  return rows;
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
      FeatureSpec lag{FeatureKind::surface_lag};
      lag.drive = coarse_curve(fitted.trend.elastic, depth_m);
      add(lag, [&](std::size_t i) { return rows[i].lag_m; });
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
