#include "models/training/training_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "models/training/weighting.h"

namespace palpate {
namespace {

constexpr double kGrowth = 1.25;

using FeatureValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, static_cast<int>(kMaxFeatures), 1>;

// Bounds, running mean and spread of every feature.
struct FeatureMoments {
  explicit FeatureMoments(std::size_t n) : mean(FeatureValues::Zero(static_cast<Eigen::Index>(n))), squares(mean) {}

  void add(const FeatureValues& x) {
    if (count == 0.0) lower = upper = x;
    count += 1.0;
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
    const FeatureValues change = x - mean;
    mean += change / count;
    squares += change.cwiseProduct(x - mean);
  }

  Normalisation normalisation() const {
    Normalisation result{mean, Eigen::VectorXd::Ones(mean.size()), lower, upper};
    for (Eigen::Index i = 0; i < mean.size(); ++i) {
      const double scale = std::sqrt((upper(i) - lower(i)) * 4.0 * std::sqrt(squares(i) / count));
      // A spread at the level of rounding counts as 0; the scale stays 1.
      if (scale > 1e-12 * std::max(std::abs(lower(i)), std::abs(upper(i)))) result.scale(i) = scale;
    }
    return result;
  }

  double count = 0.0;
  FeatureValues mean;
  FeatureValues squares;
  FeatureValues lower;
  FeatureValues upper;
};

using CellKey = std::array<std::int32_t, kMaxFeatures + 1>;
struct CellHash {
  std::size_t operator()(const CellKey& key) const {
    return std::hash<std::string_view>{}({reinterpret_cast<const char*>(key.data()), sizeof key});
  }
};

// Replaces the samples in each visited cube of the feature space by their mean.
class CoverageReduction {
 public:
  CoverageReduction(const Normalisation& normalisation, std::vector<TrainingSite>& sites)
      : normalisation_(normalisation), sites_(sites) {}

  void add(const TrainingSite& site) {
    add_to_cell(site);
    while (sites_.size() > kCoverageSites) {
      step_ *= kGrowth;
      cells_.clear();
      for (const TrainingSite& one : std::exchange(sites_, {})) add_to_cell(one);
    }
  }

 private:
  CellKey key(const TrainingSite& site) const {
    CellKey result{};
    const auto n = static_cast<std::size_t>(normalisation_.scale.size());
    for (std::size_t i = 0; i < n; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double u = (site.features[i] - normalisation_.offset(k)) / normalisation_.scale(k);
      result[i] = static_cast<std::int32_t>(std::clamp(std::floor(u / step_), -1e9, 1e9));
    }
    result[kMaxFeatures] = 2 * site.fold + (site.no_force ? 1 : 0);
    return result;
  }

  void add_to_cell(const TrainingSite& site) {
    const auto [cell, fresh] = cells_.try_emplace(key(site), sites_.size());
    if (fresh) {
      sites_.push_back(site);
      return;
    }
    TrainingSite& mean = sites_[cell->second];
    mean.count += site.count;
    const double share = site.count / mean.count;
    for (std::size_t i = 0; i < kMaxFeatures; ++i) mean.features[i] += share * (site.features[i] - mean.features[i]);
    mean.force_N += share * (site.force_N - mean.force_N);
  }

  const Normalisation& normalisation_;
  std::vector<TrainingSite>& sites_;
  std::unordered_map<CellKey, std::size_t, CellHash> cells_;  // index of the site of each visited cube
  double step_ = kCoverageStep;
};

// The rule of the paper: keeps a sample whose force differs from that of the last kept one by the threshold. The
// threshold grows when too many samples are kept.
class ForceReduction {
 public:
  explicit ForceReduction(std::vector<TrainingSite>& sites) : sites_(sites) {}

  void add(const TrainingSite& site, bool first_of_recording) {
    if (first_of_recording) last_N_ = std::nan("");
    if (std::abs(site.force_N - last_N_) < threshold_N_) return;
    last_N_ = site.force_N;
    sites_.push_back(site);
    while (sites_.size() > kMaximumSites) thin();
  }

  double threshold_N() const { return threshold_N_; }

 private:
  void thin() {
    threshold_N_ *= kGrowth;
    std::vector<TrainingSite> kept;
    for (const TrainingSite& candidate : sites_) {
      if (kept.empty() || std::abs(candidate.force_N - kept.back().force_N) >= threshold_N_) kept.push_back(candidate);
    }
    sites_ = std::move(kept);
  }

  std::vector<TrainingSite>& sites_;
  double threshold_N_ = kReductionForce_N;
  double last_N_ = std::nan("");
};

}  // namespace

Result<TrainingSet> make_training_set(MotionSource& source, const std::vector<FeatureSpec>& features,
                                      Reduction reduction, double force_noise_floor_N, const FitControl& control) {
  TrainingSet set;
  const auto n = static_cast<Eigen::Index>(features.size());
  // Calls `handle` for every sample in contact, with its features.
  const auto pass = [&](const auto& handle) {
    FeatureFilter filter(features);
    return source.for_each(
        [&](const MotionRow& row) {
          if (row.first) filter.reset();
          const FeatureVector& vector = filter.update(row.sample, row.motion);
          if (vector.in_contact && !row.run_up) handle(row, vector);
        },
        control);
  };

  FeatureMoments moments(features.size());
  Status status = pass([&](const MotionRow&, const FeatureVector& vector) {
    moments.add(Eigen::Map<const Eigen::VectorXd>(vector.values.data(), n));
  });
  if (!status) return status.error();
  set.contact_samples = static_cast<std::size_t>(moments.count);
  if (set.contact_samples == 0) return Error{"no sample of the training recordings is in contact (position_m > 0)"};
  set.normalisation = moments.normalisation();

  CoverageReduction coverage(set.normalisation, set.sites);
  ForceReduction force(set.sites);
  const std::size_t stride = set.contact_samples / kMaximumEvaluationSamples + 1;
  const std::size_t none_stride = set.contact_samples / kMostSites + 1;
  std::size_t seen = 0;
  int recording = -1;
  status = pass([&](const MotionRow& row, const FeatureVector& vector) {
    const std::size_t index = seen++;
    if (index % stride == 0) {
      set.evaluation_features.push_back(vector.values);
      set.evaluation_force_N.push_back(row.force_N);
    }
    const TrainingSite site{vector.values, row.force_N, 1.0, row.fold, row.force_N <= force_noise_floor_N};
    switch (reduction) {
      case Reduction::coverage:
        coverage.add(site);
        break;
      case Reduction::force:
        force.add(site, row.recording != recording);
        break;
      case Reduction::none:
        if (index % none_stride == 0) set.sites.push_back(site);
        break;
    }
    recording = row.recording;
  });
  if (!status) return status.error();
  if (reduction == Reduction::force) set.reduction_force_N = force.threshold_N();
  return set;
}

}  // namespace palpate
