#include "scenes/report/measure/coverage_finder.h"

#include <utility>

#include "engine/tick/replay.h"

namespace palpate {
namespace {

constexpr std::size_t kMostCoveragePoints = 20000;  // each kind, before the figure thins them

}  // namespace

CoverageFinder::CoverageFinder(const JndLine& jnd, std::vector<std::string> models, std::size_t reference,
                               double largest_force_N)
    : names_(std::move(models)),
      reference_(reference),
      inside_(names_.size(), ErrorStatistics(jnd)),
      outside_(names_.size(), ErrorStatistics(jnd)),
      bins_(names_.size(), BinnedErrors(jnd, largest_force_N)) {}

void CoverageFinder::add_sites(const TrainingSet& set) {
  if (coverage_.features.empty()) {
    for (const FeatureSpec& spec : set.features) coverage_.features.push_back(spec);
  }
  for (const TrainingSite& site : set.sites) coverage_.sites.push_back({site.features, site.force_N});
}

Status CoverageFinder::search(const Recording& recording, const std::vector<ModelPointer>& models) {
  const auto replayed = replay(
      recording, ForceModels(models.begin(), models.end()),
      [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
        if (!snapshot.in_contact) return;
        const bool away = (snapshot.out_of_domain_mask >> reference_ & 1U) != 0;
        for (std::size_t i = 0; i < models.size(); ++i) {
          (away ? outside_ : inside_)[i].add(snapshot.force_N[i], row.force_N, away);
          bins_[i].add(snapshot.force_N[i], row.force_N);
        }
        auto& points = away ? coverage_.test_outside : coverage_.test_inside;
        points.push_back({tick.features_of(reference_).values, row.force_N});
      });
  if (!replayed) return replayed.error();
  coverage_.test_inside = thinned(coverage_.test_inside, kMostCoveragePoints);
  coverage_.test_outside = thinned(coverage_.test_outside, kMostCoveragePoints);
  return {};
}

Coverage CoverageFinder::result() const {
  Coverage coverage = coverage_;
  coverage.reference = names_[reference_];
  for (std::size_t i = 0; i < names_.size(); ++i) {
    coverage.errors.push_back({names_[i], inside_[i].summary(), outside_[i].summary()});
  }
  return coverage;
}

std::vector<CoveragePoint> thinned(const std::vector<CoveragePoint>& points, std::size_t most) {
  if (points.size() <= most) return points;
  std::vector<CoveragePoint> kept;
  for (std::size_t i = 0; i < most; ++i) kept.push_back(points[i * points.size() / most]);
  return kept;
}

}  // namespace palpate
