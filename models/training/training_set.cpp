#include "models/training/training_set.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "models/training/sites.h"

namespace palpate {
namespace {

constexpr double kGrowth = 1.25;

using FeatureValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, static_cast<int>(kMaxFeatures), 1>;

// Bounds, running mean and spread of every feature.
Normalisation normalisation_of(const std::vector<TrainingSite>& samples, std::size_t features) {
  const auto n = static_cast<Eigen::Index>(features);
  FeatureValues mean = FeatureValues::Zero(n);
  FeatureValues squares = mean;
  FeatureValues lower = Eigen::Map<const Eigen::VectorXd>(samples.front().features.data(), n);
  FeatureValues upper = lower;
  double count = 0.0;
  for (const TrainingSite& sample : samples) {
    const FeatureValues x = Eigen::Map<const Eigen::VectorXd>(sample.features.data(), n);
    const FeatureValues change = x - mean;
    count += 1.0;
    mean += change / count;
    squares += change.cwiseProduct(x - mean);
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  Normalisation result{mean, Eigen::VectorXd::Ones(n), lower, upper};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double scale = std::sqrt((upper(i) - lower(i)) * 4.0 * std::sqrt(squares(i) / count));
    // A spread at the level of rounding counts as 0; the scale stays 1.
    if (scale > 1e-12 * std::max(std::abs(lower(i)), std::abs(upper(i)))) result.scale(i) = scale;
  }
  return result;
}

using CellKey = std::array<std::int32_t, kMaxFeatures + 1>;
struct CellHash {
  std::size_t operator()(const CellKey& key) const {
    return std::hash<std::string_view>{}({reinterpret_cast<const char*>(key.data()), sizeof key});
  }
};

// Replaces the samples in each visited cube of the feature space by their mean.
std::vector<TrainingSite> coverage_reduced(const std::vector<TrainingSite>& samples,
                                           const Normalisation& normalisation) {
  std::vector<TrainingSite> sites;
  std::unordered_map<CellKey, std::size_t, CellHash> cells;  // index of the site of each visited cube
  double step = kCoverageStep;
  const auto add = [&](const TrainingSite& site) {
    CellKey key{};
    for (Eigen::Index k = 0; k < normalisation.scale.size(); ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double u = (site.features[i] - normalisation.offset(k)) / normalisation.scale(k);
      key[i] = static_cast<std::int32_t>(std::clamp(std::floor(u / step), -1e9, 1e9));
    }
    key[kMaxFeatures] = 2 * site.fold + (site.no_force ? 1 : 0);
    const auto [cell, fresh] = cells.try_emplace(key, sites.size());
    if (fresh) {
      sites.push_back(site);
      return;
    }
    TrainingSite& mean = sites[cell->second];
    mean.count += site.count;
    const double share = site.count / mean.count;
    for (std::size_t i = 0; i < kMaxFeatures; ++i) mean.features[i] += share * (site.features[i] - mean.features[i]);
    mean.force_N += share * (site.force_N - mean.force_N);
  };
  for (const TrainingSite& sample : samples) {
    add(sample);
    while (sites.size() > kCoverageSites) {
      step *= kGrowth;
      cells.clear();
      for (const TrainingSite& one : std::exchange(sites, {})) add(one);
    }
  }
  return sites;
}

// The rule of the paper. `step_N`: receives the step.
std::vector<TrainingSite> force_reduced(const std::vector<TrainingSite>& samples, double& step_N) {
  for (step_N = kReductionForce_N;; step_N *= kGrowth) {
    std::vector<TrainingSite> kept;
    for (const TrainingSite& one : samples) {
      const bool near = !kept.empty() && one.recording == kept.back().recording &&
                        std::abs(one.force_N - kept.back().force_N) < step_N;
      if (!near) kept.push_back(one);
    }
    if (kept.size() <= kMaximumSites) return kept;
  }
}

}  // namespace

Result<TrainingSet> make_training_set(MotionSource& source, const std::vector<FeatureSpec>& features, Thinning thinning,
                                      double force_noise_floor_N, const FitControl& control) {
  std::vector<TrainingSite> samples;
  FeatureFilter filter(features);
  const Status status = source.for_each(
      [&](const MotionRow& row) {
        if (row.first) filter.reset();
        const FeatureVector& vector = filter.update(row.sample, row.motion);
        if (!vector.in_contact) return;
        const bool no_force = std::abs(row.force_N) <= force_noise_floor_N;
        samples.push_back({vector.values, row.force_N, 1.0, row.recording, row.fold, no_force});
      },
      control);
  if (!status) return status.error();
  if (samples.empty()) return Error{"no sample of the training recordings is in contact (position_m > 0)"};
  TrainingSet set;
  set.contact_samples = samples.size();
  set.normalisation = normalisation_of(samples, features.size());
  for (std::size_t i = 0; i < samples.size(); i += samples.size() / kMaximumEvaluationSamples + 1) {
    set.evaluation_features.push_back(samples[i].features);
    set.evaluation_force_N.push_back(samples[i].force_N);
    set.evaluation_fold.push_back(samples[i].fold);
  }
  set.sites = thinning == Thinning::coverage ? coverage_reduced(samples, set.normalisation)
              : thinning == Thinning::force  ? force_reduced(samples, set.thinning_force_N)
                                             : std::move(samples);
  return set;
}

}  // namespace palpate
