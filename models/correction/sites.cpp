#include "models/correction/methods.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace palpate {
namespace {

constexpr double kGrowth = 1.25;

// The samples that make a site: their mean and number.
struct Mean {
  std::array<double, kMaxFeatures> u{};  // normalised features
  double force_N = 0.0, count = 1.0;
  int fold = 0, recording = 0;
};

using CellKey = std::array<std::int32_t, kMaxFeatures + 1>;
struct CellHash {
  std::size_t operator()(const CellKey& key) const {
    return std::hash<std::string_view>{}({reinterpret_cast<const char*>(key.data()), sizeof key});
  }
};

// Replaces the samples in each visited cube of the feature space by their mean.
std::vector<Mean> covered(const std::vector<Mean>& samples, double no_force_N) {
  std::vector<Mean> sites;
  std::unordered_map<CellKey, std::size_t, CellHash> cells;  // index of the site of each visited cube
  double step = kCoverageStep;
  const auto add = [&](const Mean& site) {
    CellKey key{};
    for (std::size_t i = 0; i < kMaxFeatures; ++i)
      key[i] = static_cast<std::int32_t>(std::clamp(std::floor(site.u[i] / step), -1e9, 1e9));
    key[kMaxFeatures] = 2 * site.fold + (std::abs(site.force_N) <= no_force_N ? 1 : 0);
    const auto [cell, fresh] = cells.try_emplace(key, sites.size());
    if (fresh) {
      sites.push_back(site);
      return;
    }
    Mean& mean = sites[cell->second];
    mean.count += site.count;
    const double share = site.count / mean.count;
    for (std::size_t i = 0; i < kMaxFeatures; ++i) mean.u[i] += share * (site.u[i] - mean.u[i]);
    mean.force_N += share * (site.force_N - mean.force_N);
  };
  for (const Mean& sample : samples) {
    add(sample);
    while (sites.size() > kCoverageSites) {
      step *= kGrowth;
      cells.clear();
      for (const Mean& one : std::exchange(sites, {})) add(one);
    }
  }
  return sites;
}

// The reduction of the paper. `step_N`: receives the step.
std::vector<Mean> force_reduced(const std::vector<Mean>& samples, double& step_N) {
  for (step_N = kReductionForce_N;; step_N *= kGrowth) {
    std::vector<Mean> kept;
    for (const Mean& one : samples) {
      const bool near = !kept.empty() && one.recording == kept.back().recording &&
                        std::abs(one.force_N - kept.back().force_N) < step_N;
      if (!near) kept.push_back(one);
    }
    if (kept.size() <= kMaximumSites) return kept;
  }
}

}  // namespace

Status validate_sites(const Sites& sites) {
  if (sites.points.allFinite() && sites.target_N.allFinite() && sites.row_scale.allFinite()) return {};
  return Error{"a feature or force of the training is not finite; check the recording for extreme values"};
}

Sites even_subset(const Sites& sites, Eigen::Index most) {
  const Eigen::Index count = std::min(sites.count(), most);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < count; ++k) kept.push_back(k * sites.count() / count);
  Sites subset = sites;
  subset.points = sites.points(Eigen::all, kept);
  subset.target_N = sites.target_N(kept);
  subset.row_scale = sites.row_scale(kept);
  subset.force_N.resize(0);
  subset.samples.resize(0);
  subset.fold.clear();
  return subset;
}

std::vector<Eigen::Index> distinct_sites(const Sites& sites) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(sites.count()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const auto point = [&](Eigen::Index i) { return sites.points.col(i); };
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::lexicographical_compare(point(a).begin(), point(a).end(), point(b).begin(), point(b).end());
  });
  const auto same = [&](Eigen::Index a, Eigen::Index b) { return point(a) == point(b); };
  order.erase(std::unique(order.begin(), order.end(), same), order.end());
  std::sort(order.begin(), order.end());
  return order;
}

std::size_t draw_first(std::vector<Eigen::Index>& indices, Eigen::Index most, SplitMix64& random) {
  const std::size_t count = std::min(static_cast<std::size_t>(most), indices.size());
  for (std::size_t j = 0; j < count; ++j)
    std::swap(indices[j], indices[j + static_cast<std::size_t>(random.below(indices.size() - j))]);
  return count;
}

std::vector<Eigen::Index> random_quarter(Eigen::Index count, Eigen::Index most) {
  std::vector<Eigen::Index> indices(static_cast<std::size_t>(count));
  std::iota(indices.begin(), indices.end(), Eigen::Index{0});
  SplitMix64 random(1);
  indices.resize(draw_first(indices, std::clamp<Eigen::Index>(count / 4, 1, most), random));
  return indices;
}

Normalisation normalisation_of(const Eigen::MatrixXd& features) {
  const Eigen::VectorXd mean = features.rowwise().mean();
  Normalisation result{mean, Eigen::VectorXd::Ones(mean.size()), features.rowwise().minCoeff(),
                       features.rowwise().maxCoeff()};
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    const double variance = (features.row(i).array() - mean(i)).square().mean();
    if (result.range(i) > 0.0) {
      result.scale(i) = std::sqrt(result.range(i) * 4.0 * std::sqrt(variance));
    } else {
      // A constant feature is exactly 0: rounding of the mean would be a direction of the polynomial tail.
      result.offset(i) = result.lower(i);
    }
  }
  return result;
}

Sites thin(const Samples& samples, const Eigen::MatrixXd& features, const Normalisation& normalisation,
           Thinning thinning, double& step_N) {
  std::vector<Mean> means(samples.contact.size());
  const Eigen::Index d = features.rows();
  for (std::size_t k = 0; k < means.size(); ++k) {
    Eigen::Map<Eigen::VectorXd>(means[k].u.data(), d) =
        (features.col(static_cast<Eigen::Index>(k)) - normalisation.offset).cwiseQuotient(normalisation.scale);
    const std::size_t row = samples.contact[k];
    means[k].force_N = samples.rows[row].force_N;
    means[k].fold = samples.fold[row];
    means[k].recording = samples.recording[row];
  }
  if (thinning == Thinning::coverage) means = covered(means, samples.no_force_N());
  if (thinning == Thinning::force) means = force_reduced(means, step_N);
  const auto count = static_cast<Eigen::Index>(means.size());
  Sites sites;
  sites.points.resize(d, count);
  for (Eigen::VectorXd* column : {&sites.target_N, &sites.row_scale, &sites.force_N, &sites.samples})
    column->setZero(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Mean& mean = means[static_cast<std::size_t>(k)];
    sites.points.col(k) = Eigen::Map<const Eigen::VectorXd>(mean.u.data(), d);
    sites.force_N(k) = mean.force_N;
    sites.samples(k) = mean.count;
    sites.fold.push_back(mean.fold);
  }
  return sites;
}

}  // namespace palpate
