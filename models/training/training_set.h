// From recordings to sites: features, normalisation and reduction.
//
// Normalisation: u = (x - mean) / sqrt(range x 4 sigma) per feature, over the
// samples in contact. The range alone lets one fast poke squeeze all slow motion
// together, the deviation alone stretches it; their geometric mean measured
// best on held-out recordings.
//
// Reduction, one of
//   coverage  the feature space is divided into cubes of side `step`; all
//             samples of a cube become one site with their mean feature vector
//             and mean force (default). Dwell is thinned, nothing that was
//             visited is lost, and noise averages out. The step starts fine and
//             grows until kCoverageSites are enough, so a short recording keeps
//             its detail.
//   force     the paper's rule (section 2.1): a sample is kept when the force
//             moved 50 mN since the last one kept.
//   none      every sample in contact.
// When more than kMaximumSites sites come together, the step (or the 50 mN)
// grows by a quarter and what is there is reduced again, so a long or noisy
// recording streams through in bounded memory. (none: every other sample is
// dropped instead.)
//
// Samples of different folds (fold_dealer.h), when they are dealt, never share a
// site: what is decided by leaving folds out must not have seen them.
// Contact is one-sided: samples without measured force never share a site with
// others and are marked.
// Thread guarantee: slow side.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "models/training/motion_source.h"

namespace palpate {

enum class Reduction { coverage, force, none };
// In commands and model files, in the order of the values.
inline constexpr std::array<const char*, 3> kReductionNames{"coverage", "force", "none"};
inline const char* reduction_name(Reduction reduction) { return kReductionNames[static_cast<std::size_t>(reduction)]; }

inline constexpr std::size_t kMaximumSites = 10000;
inline constexpr double kReductionForce_N = 0.05;    // the paper's 50 mN
inline constexpr std::size_t kCoverageSites = 7500;  // the paper worked with 6,850
inline constexpr double kCoverageStep = 0.005;       // of normalised feature space, to begin with

struct Normalisation {
  Eigen::VectorXd offset;  // SI
  Eigen::VectorXd scale;   // SI, > 0; 1 for a feature that never changes
  Eigen::VectorXd lower;   // bounds in contact, SI
  Eigen::VectorXd upper;
};

struct TrainingSite {
  std::array<double, kMaxFeatures> features{};  // SI
  double force_N = 0.0;
  double count = 1.0;  // samples behind it
  int stroke = 0;
  int fold = 0;
  bool no_force = false;  // one-sided: the force is not positive, no more is known
};

struct TrainingSet {
  std::vector<FeatureSpec> features;
  Normalisation normalisation;
  std::vector<TrainingSite> sites;
  std::uint64_t contact_samples = 0;
  double coverage_step = 0.0;      // in the end
  double reduction_force_N = 0.0;  // in the end
};

struct TrainingSetOptions {
  double fraction = 0.0;  // of the progress
  // Called with every sample in contact and its features, once.
  std::function<void(const MotionRow&, const FeatureVector&)> also{};
};

// `force_noise_floor_N`: at or below it a sample counts as "no measured force". Errors:
// those of the source; no sample in contact; interrupted.
Result<TrainingSet> make_training_set(MotionSource& source, const std::vector<FeatureSpec>& features,
                                      Reduction reduction, double force_noise_floor_N, const FitControl& control = {},
                                      const TrainingSetOptions& options = {});

}  // namespace palpate
