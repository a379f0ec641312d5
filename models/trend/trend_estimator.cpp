#include "models/trend/trend_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/text.h"
#include "models/linear/lapack.h"

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

// The drive curve that is one of the basis functions.
DriveCurve basis_curve(FeatureKind kind, std::size_t k, double reference_depth_m) {
  std::array<double, kCurveTerms> one{};
  one[k] = 1.0;
  return combined_curve(kind, one.data(), reference_depth_m);
}

// The features whose memory the columns come from: the branches with each basis function as their drive curve, from the
// last to the first, and the bristles, whose deflection does not depend on it.
std::vector<FeatureSpec> memory_features(const FeatureList& list, double reference_depth_m) {
  std::vector<FeatureSpec> features;
  for (std::size_t k = kCurveTerms; k-- > 0;) {
    for (FeatureSpec spec : list.features) {
      if (!is_branch(spec.kind) && (k > 0 || !is_bristle(spec.kind))) continue;
      for (FeaturePart& part : spec.parts) {
        part.drive = basis_curve(spec.kind, k, reference_depth_m);
        if (spec.kind == FeatureKind::creep) part.threshold_m = reference_depth_m;
      }
      features.push_back(spec);
    }
  }
  return features;
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
                                        const FitControl& control, double least_step_s) {
  TrendColumns made;
  made.samples_ = &samples;
  const std::vector<std::size_t> contact = contact_apart(samples, least_step_s);
  made.stride_ = (contact.size() + most_rows - 1) / most_rows;
  for (std::size_t i = 0; i < contact.size(); i += made.stride_) made.rows_.push_back(contact[i]);
  const std::vector<ElasticSpline> elastic = elastic_basis(samples);
  constexpr auto kBasis = static_cast<Eigen::Index>(kCurveTerms);
  Eigen::Index columns = 0, branches = 0;
  for (const FeatureSpec& spec : list.features) {
    const std::size_t count = spec.kind == FeatureKind::depth      ? elastic.size()
                              : spec.kind == FeatureKind::velocity ? 2 * kViscosityCoefficients
                                                                   : kCurveTerms * spec.part_count;
    ColumnList& of_feature = made.feature_columns_.emplace_back(count);
    std::iota(of_feature.begin(), of_feature.end(), columns);
    columns += static_cast<Eigen::Index>(count);
    if (is_branch(spec.kind)) branches += static_cast<Eigen::Index>(spec.part_count);
  }
  const std::vector<FeatureSpec> features = memory_features(list, samples.depth_m);
  const auto memory = memory_at(samples, features, made.rows_, control, least_step_s);
  if (!memory) return memory.error();
  std::vector<double> thresholds_m;  // of the bristles
  for (const FeatureSpec& spec : features)
    for (std::size_t p = 0; is_bristle(spec.kind) && p < spec.part_count; ++p)
      thresholds_m.push_back(spec.parts[p].threshold_m);
  std::vector<DriveCurve> frictions;
  for (std::size_t k = 0; k < kCurveTerms; ++k)
    frictions.push_back(basis_curve(FeatureKind::stops, k, samples.depth_m));
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
    const auto values = memory->col(row);
    for (Eigen::Index branch = 0; branch < branches; ++branch)
      for (Eigen::Index k = kBasis; k-- > 0;) *to++ = values(k * branches + branch);
    auto bend_m = values.begin() + kBasis * branches;
    for (const double threshold_m : thresholds_m) {
      for (const DriveCurve& friction : frictions) *to++ = friction.at(depth_m) * *bend_m * (1.0 / threshold_m);
      ++bend_m;
    }
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

namespace {

// Active set and robust weights converge within these passes.
constexpr int kPasses = 4;
// A robust factor that changes by less stays as it is: the fit takes 0.7 of the time, and the mean share of the
// recorded rigs is within 0.15 points (tests/labs.py).
constexpr double kSameScale = 0.01;
// The candidates for lambda: 1e-6 smooths over a third of the depth, 1e-9 over two pieces.
constexpr std::array kSmoothness{1e-6, 1e-7, 1e-8, 1e-9};

// The trends of some solutions at the rows: rows x solutions.
Eigen::MatrixXd values_of(const TrendColumns& columns, const Eigen::MatrixXd& solutions) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(columns.count()), solutions.cols());
  // The matrix is stored by rows, which is its transpose stored by columns.
  const Eigen::Map<const Eigen::MatrixXd> transposed(columns.terms().data(), columns.columns(), values.rows());
  multiply(transposed, true, solutions, false, 1.0, 0.0, values);
  return values;
}

// The filters are exact for steps of any length, and a hand moves little in 4 ms.
constexpr double kSearchStep_s = 3.9e-3;
// At the greatest depth a relaxation time is exp(slowing) times that at the surface: 0.2 to 20. Simplest first.
constexpr std::array kSlowings{0.0, 0.75, -0.75, 1.5, -1.5, 2.25, 3.0};

// At most `most` of the values, evenly spaced by index.
std::vector<double> evenly(const std::vector<double>& values, std::size_t most) {
  if (values.size() <= most) return values;
  std::vector<double> few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(values[i * (values.size() - 1) / (most - 1)]);
  return few;
}

// The list with fewer terms, for comparisons of many regressions.
FeatureList shortened(const FeatureList& list) {
  FeatureList few;
  few.add(FeatureKind::maxwell_spectrum, evenly(relaxation_times_s(list.features), 8));
  for (const FeatureSpec& spec : list.features) {
    if (spec.kind == FeatureKind::velocity) few.add(spec.kind);
    if (is_bristle(spec.kind)) few.add(spec.kind, evenly(constants_of(spec), 2));
  }
  return few;
}

FeatureList with_slowing(FeatureList list, double slowing) {
  for (FeatureSpec& spec : list.features)
    if (is_branch(spec.kind)) spec.slowing = slowing;
  return list;
}

}  // namespace

TrendEstimator::TrendEstimator(const TrendColumns& columns, const JndLine& jnd, double smoothness)
    : columns_(columns),
      jnd_(jnd),
      part_error_(has_kind(columns.list().features, FeatureKind::creep) ? kPartError : kPartErrorOfFew),
      smoothness_(smoothness),
      equations_(static_cast<std::size_t>(columns.folds()) + (smoothness > 0.0 ? 0 : 1)) {
  std::vector<int> fold;
  std::vector<double> depth_m;
  for (std::size_t i = 0; i < columns.count(); ++i) {
    fold.push_back(columns.fold(i));
    depth_m.push_back(columns.depth_m(i));
  }
  const int folds = columns.folds();
  deepest_elsewhere_m_ = deepest_elsewhere_m(fold, depth_m, folds);
  const BlasThreads one_thread(1);
  parallel_for(static_cast<int>(equations_.size()),
               [&](int k) { equations_[static_cast<std::size_t>(k)] = gather(k); });
  if (smoothness > 0.0) return;
  std::vector<FoldErrors> errors(kSmoothness.size());
  parallel_for(static_cast<int>(kSmoothness.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    errors[at] = cross_validate(all_columns(), kSmoothness[at]).errors;
  });
  smoothness_ = kSmoothness[simplest_adequate(errors)];
}

Eigen::VectorXd TrendEstimator::fit(const ColumnList& columns) const {
  const bool known = equations_.size() > static_cast<std::size_t>(columns_.folds());
  return solve(known ? equations_.back() : gather(columns_.folds()), columns, smoothness_);
}

// Iterates weights and active set on the rows outside the fold `left_out`. After the first pass few weights change.
TrendEstimator::Equations TrendEstimator::gather(int left_out) const {
  const double no_force_N = columns_.samples().no_force_N();
  const Eigen::Index n = columns_.columns();
  Equations equations{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0, Eigen::VectorXd::Zero(n)};
  std::vector<double> plain(columns_.count()), squares(plain.size()), scale(plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    plain[i] = scale[i] = columns_.fold(i) == left_out ? 0.0 : 1.0 / jnd_.at(columns_.force_N(i));
    squares[i] = plain[i] * plain[i];
  }
  add(equations, squares);
  for (int pass = 0; pass < kPasses; ++pass) {
    equations.start = solve(equations, all_columns(), kFirstSmoothness);
    const Eigen::VectorXd trend_N = values_of(columns_, equations.start);
    bool changed = false;
    for (std::size_t i = 0; i < scale.size(); ++i) {
      const double force_N = trend_N(static_cast<Eigen::Index>(i));
      const bool idle = std::abs(columns_.force_N(i)) <= no_force_N && force_N <= 0.0;
      const double robust = robust_scale(jnd_.error_over_jnd(force_N, columns_.force_N(i)));
      const double now = idle ? 0.0 : plain[i] * robust;
      changed = changed || std::abs(now - scale[i]) > 0.1 * plain[i];
      squares[i] = 0.0;
      if (std::abs(now - scale[i]) <= kSameScale * plain[i]) continue;
      squares[i] = now * now - scale[i] * scale[i];
      scale[i] = now;
    }
    if (!changed) break;
    add(equations, squares);
  }
  return equations;
}

void TrendEstimator::add(Equations& equations, const std::vector<double>& squares) const {
  const Eigen::Index n = columns_.columns();
  Eigen::MatrixXd block(n, kBlockRows);  // one column a row of the regression
  Eigen::VectorXd force_N(kBlockRows);
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(n, n);
  for (const double sign : {1.0, -1.0}) {
    Eigen::Index filled = 0;
    const auto flush = [&] {
      gram_of_transpose(block.leftCols(filled), product);
      equations.gram += sign * product;
      multiply(block.leftCols(filled), false, force_N.head(filled), false, sign, 1.0, equations.right_side);
      filled = 0;
    };
    for (std::size_t i = 0; i < columns_.count(); ++i) {
      if (!(sign * squares[i] > 0.0)) continue;
      const double scale = std::sqrt(sign * squares[i]);
      block.col(filled) = scale * columns_.terms().row(static_cast<Eigen::Index>(i)).transpose();
      force_N(filled) = scale * columns_.force_N(i);
      equations.scale_squares += squares[i];
      if (++filled == kBlockRows) flush();
    }
    if (filled > 0) flush();
  }
  equations.gram.triangularView<Eigen::StrictlyUpper>() = equations.gram.transpose();
}

// The penalised solution on these columns, 0 in all others. The columns of the elastic response come first, its splines
// before its force at the surface.
Eigen::VectorXd TrendEstimator::solve(const Equations& equations, const ColumnList& columns, double smoothness) const {
  constexpr auto kElastic = static_cast<Eigen::Index>(kElasticTerms);
  Eigen::MatrixXd gram = equations.gram;
  const double smooth = smoothness * equations.scale_squares * static_cast<double>(kElasticPieces);
  const auto elastic = static_cast<Eigen::Index>(columns_.feature_columns().front().size());
  gram.diagonal().tail(gram.cols() - elastic) *= 1.0 + part_error_ * part_error_;
  for (Eigen::Index k = 0; k + 1 < kElastic; ++k) {
    gram(k, k) += smooth;
    gram(k + 1, k + 1) += smooth;
    gram(k, k + 1) -= smooth;
    gram(k + 1, k) -= smooth;
  }
  Eigen::VectorXd x = Eigen::VectorXd::Zero(gram.cols());
  x(columns) = solve_non_negative(gram(columns, columns), equations.right_side(columns), equations.start(columns));
  return x;
}

CrossValidated TrendEstimator::cross_validate(const ColumnList& columns, double smoothness) const {
  const int folds = columns_.folds();
  CrossValidated result{static_cast<std::size_t>(folds), Eigen::MatrixXd(columns_.terms().cols(), folds)};
  for (int k = 0; k < folds; ++k)
    result.solutions.col(k) = solve(equations_[static_cast<std::size_t>(k)], columns, smoothness);
  const bool one_sided = std::isfinite(columns_.samples().no_force_N());
  const Eigen::MatrixXd trend_N = values_of(columns_, result.solutions);
  for (std::size_t i = 0; i < columns_.count(); ++i) {
    const auto fold = static_cast<std::size_t>(columns_.fold(i));
    if (columns_.depth_m(i) > deepest_elsewhere_m_[fold]) continue;
    const double force_N = trend_N(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(fold));
    result.errors.add(fold, jnd_.error_over_jnd(one_sided ? std::max(0.0, force_N) : force_N, columns_.force_N(i)));
  }
  return result;
}

Result<FeatureList> select_slowing(const Samples& samples, const JndLine& jnd, const FeatureList& list,
                                   std::vector<PartGain>& gains, const FitControl& control) {
  if (!has_kind(list.features, FeatureKind::maxwell_spectrum)) return list;
  std::vector<FoldErrors> errors;
  for (const double slowing : kSlowings) {
    const auto columns =
        TrendColumns::make(samples, with_slowing(shortened(list), slowing), kSearchRows, control, kSearchStep_s);
    if (!columns) return columns.error();
    const TrendEstimator estimator(*columns, jnd, TrendEstimator::kFirstSmoothness);
    errors.push_back(estimator.cross_validate(estimator.all_columns()).errors);
  }
  const std::size_t chosen = simplest_adequate(errors);
  const FoldErrors& slower =
      chosen != 0 ? errors[chosen]
                  : *std::ranges::min_element(errors.begin() + 1, errors.end(), {}, &FoldErrors::rms_at_mean_score);
  gains.push_back(
      {"depth-dependent relaxation", chosen != 0, slower.rms_at_mean_score(), errors[0].rms_at_mean_score()});
  return with_slowing(list, kSlowings[chosen]);
}

Result<std::vector<double>> identify_relaxation(const Samples& samples, const JndLine& jnd, bool velocity,
                                                std::size_t count, const FitControl& control) {
  const std::vector<double> candidates_s = dictionary_times_s(samples);
  if (candidates_s.empty()) {
    return Error{
        "the recordings are too short to identify a relaxation time; record for longer, or pass --features scene"};
  }
  const auto rows = TrendColumns::make(samples, single_times(velocity, candidates_s), kSearchRows, control);
  if (!rows) return rows.error();
  const TrendEstimator estimator(*rows, jnd, TrendEstimator::kFirstSmoothness);
  const auto candidates = static_cast<int>(candidates_s.size());
  const int first = static_cast<int>(rows->list().features.size()) - candidates;
  std::vector<int> best;  // indices of the candidates, ascending
  double least = 0.0;     // the RMS error with these
  const auto attempt = [&](std::vector<int> times) {
    std::ranges::sort(times);
    if (std::ranges::adjacent_find(times) != times.end() || times.front() < 0 || times.back() >= candidates) return;
    // Elastic response, viscosity and the branches with these times.
    const auto columns = rows->columns_of([&](std::size_t f) {
      const int time = static_cast<int>(f) - first;
      return time < 0 || std::ranges::binary_search(times, time);
    });
    const double error = estimator.cross_validate(columns).errors.rms();
    if (times.size() == best.size() && error >= least) return;
    best = std::move(times);
    least = error;
  };
  while (best.size() < std::min(count, candidates_s.size())) {
    if (!control.may_continue()) return interrupted();
    const std::vector<int> last = best;
    for (int added = 0; added < candidates; ++added) {
      std::vector<int> times = last;
      times.push_back(added);
      attempt(std::move(times));
    }
    for (bool moved = !last.empty(); moved;) {
      const std::vector<int> from = best;
      for (std::size_t i = 0; i < from.size(); ++i) {
        for (const int step : {-1, 1}) {
          std::vector<int> times = from;
          times[i] += step;
          attempt(std::move(times));
        }
      }
      moved = best != from;
    }
  }
  std::vector<double> times_s;
  for (const int time : best) times_s.push_back(candidates_s[static_cast<std::size_t>(time)]);
  return times_s;
}

}  // namespace palpate
