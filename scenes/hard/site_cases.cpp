// Tables of samples with any depth, velocity and force: the two features have no memory, so that each sample is a site
// of its own, and the thinning is off. The training is otherwise that of `palpate fit`.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/random_stream.h"
#include "scenes/hard/hard_case.h"

namespace palpate {
namespace {

constexpr Eigen::Index kSites = 160;
constexpr int kFolds = 5;
constexpr double kDepth_m = 6e-3;
constexpr double kVelocity_m_per_s = 0.1;
constexpr double kNoise_N = 0.005;
constexpr int kTicks = 4000;
constexpr double kSample_s = 1e-3;

// Points of the unit square, one a column: the depth over kDepth_m, and half of 1 + the velocity over its largest.
using Points = Eigen::Matrix2Xd;

// Not a sum of an elastic and a viscous part, so that the trend needs its correction. Up to 3 N.
double unit_force_N(double u, double v) {
  const double w = 2.0 * v - 1.0;
  return u * (2.0 + u + 0.3 * w + 0.4 * std::sin(5.0 * u) * std::sin(2.0 * w));
}

Points random_points(Eigen::Index count, std::uint64_t stream) {
  RandomStream random(7, stream);
  Points points(2, count);
  for (double& value : points.reshaped()) value = random.uniform(0.0, 1.0);
  return points;
}

// A closed curve that comes near every point of the square.
Points path() {
  Points points(2, kTicks);
  for (int i = 0; i < kTicks; ++i) {
    const double t = 2.0 * std::numbers::pi * kSample_s * i;
    points.col(i) << 0.5 + 0.46 * std::sin(0.75 * t), 0.5 + 0.46 * std::sin(1.25 * t + 0.3);
  }
  return points;
}

struct SiteSet {
  Points points = random_points(kSites, 1);
  Points tested = path();          // where the true force is compared
  Eigen::Vector2d unit{1.0, 1.0};  // factors of depth and velocity
  double force_unit = 1.0;         // factor of the forces
  std::function<void(Eigen::VectorXd& force_N)> fault{};
};

double depth_m(const SiteSet& set, double u) { return kDepth_m * set.unit.x() * u; }
double velocity_m_per_s(const SiteSet& set, double v) { return kVelocity_m_per_s * set.unit.y() * (2.0 * v - 1.0); }

SamplesPointer samples_of(const SiteSet& set) {
  const Eigen::Index count = set.points.cols();
  Eigen::VectorXd force_N(count);
  RandomStream noise(7, 3);
  for (Eigen::Index i = 0; i < count; ++i)
    force_N(i) = set.force_unit * (unit_force_N(set.points(0, i), set.points(1, i)) + kNoise_N * noise.normal());
  if (set.fault) set.fault(force_N);
  Samples samples;
  double squares = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    Sample row;
    row.tool.time_s = kSample_s * static_cast<double>(i);
    row.motion = {depth_m(set, set.points(0, i)), velocity_m_per_s(set, set.points(1, i))};
    row.tool.position_m = row.motion.position_m;
    row.force_N = force_N(i);
    squares += row.motion.velocity_m_per_s * row.motion.velocity_m_per_s;
    samples.depth_m = std::max(samples.depth_m, row.motion.position_m);
    samples.force_N = std::max(samples.force_N, row.force_N);
    samples.fold.push_back(static_cast<int>(kFolds * i / count));
    samples.stroke.push_back(samples.fold.back() + 1);
    samples.recording.push_back(0);
    samples.contact.push_back(static_cast<std::size_t>(i));
    samples.rows.push_back(row);
  }
  samples.folds = kFolds;
  samples.strokes = kFolds;
  samples.offsets.emplace_back().name = "sites";
  samples.recorded_rows = static_cast<std::size_t>(count);
  samples.force_noise_N = kNoise_N * set.force_unit;
  samples.rms_velocity_m_per_s = std::sqrt(squares / static_cast<double>(count));
  samples.sample_s = kSample_s;
  samples.longest_recording_s = kSample_s * static_cast<double>(count);
  return std::make_shared<const Samples>(std::move(samples));
}

HardFigures measure(const SiteSet& set, const FittedModel& model) {
  const auto force_at = [&](double u, double v) {
    const double features[] = {depth_m(set, u), velocity_m_per_s(set, v)};
    return model.evaluate(features).force_N;
  };
  const auto measure_at = [&](const Points& points) {
    HardMeasure measured;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const double u = points(0, i), v = points(1, i);
      measured.add(force_at(u, v), set.force_unit * unit_force_N(u, v), true);
    }
    return measured.figures();
  };
  HardFigures figures = measure_at(set.tested);
  // Steps count along the whole path, also where no site determines the force.
  figures.worst_step_N = measure_at(path()).worst_step_N;
  return figures;
}

HardCase site_case(const std::string& name, const std::string& why, const HardExpectations& expected,
                   const std::function<void(SiteSet&)>& shape) {
  const auto build = [shape] {
    const auto set = std::make_shared<SiteSet>();
    shape(*set);
    const TrainingScene scene{"hard case", {{FeatureKind::depth, 0.0, {}}, {FeatureKind::velocity, 0.0, {}}}, {}};
    ModelPlan plan;
    plan.thinning = Thinning::none;
    plan.features = FeatureChoice::scene;
    return HardTrial{std::make_shared<HardTraining>(ModelFits(samples_of(*set), scene), plan),
                     [set](const auto& model) { return measure(*set, *model); }};
  };
  return {name, HardKind::sites, why, expected, build};
}

// The sites form 40 clusters of this radius; the force is compared at their middles.
void in_clusters(SiteSet& set, double radius, Eigen::Index count = kSites) {
  constexpr Eigen::Index kClusters = 40;
  const Points middles = set.points.leftCols(kClusters);
  const Points around = random_points(count, 4);
  set.points = around;
  for (Eigen::Index i = 0; i < count; ++i)
    set.points.col(i) = middles.col(i % kClusters) + radius * (around.col(i) - Eigen::Vector2d(0.5, 0.5));
  set.tested = middles;
}

// Sites and path on the image of the square.
void mapped(SiteSet& set, const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& to) {
  for (Points* points : {&set.points, &set.tested}) {
    for (Eigen::Index i = 0; i < points->cols(); ++i) points->col(i) = to(points->col(i)).eval();
  }
}

void first_sites(SiteSet& set, Eigen::Index count) {
  set.points = set.points.leftCols(count).eval();
  set.tested = set.points;
}

}  // namespace

std::vector<HardCase> site_cases() {
  // Noise of 5 mN, a change of the true force of 10 mN from tick to tick. The trend alone cannot describe these forces.
  const HardExpectation good{0.99, 0.1, 0.03}, uncorrected{0.9, 0.4, 0.03};
  const HardExpectations all{good, uncorrected, good};
  // Few sites, or forces that the trend can describe.
  const HardExpectations same{good, good, good};
  // Known limitation: the cross-validation of the truncation sees the clusters only, and centres that the kD-tree moves
  // within them get weights so large that the force jumps between its limits elsewhere.
  const HardExpectations clusters{good, uncorrected, {0.99, 0.1, 0.05}, {{"kdtree-100", {0.99, 0.1, 4.0}}}};
  std::vector<HardCase> cases;
  const auto add = [&](const char* name, const char* why, const HardExpectations& expected,
                       const std::function<void(SiteSet&)>& shape) {
    cases.push_back(site_case(name, why, expected, shape));
  };
  add("sites, nothing wrong", "160 sites", all, [](SiteSet&) {});
  add("repeated sites", "each site twice", {good, {0.75, 0.45, 0.03}, {0.85, 0.25, 0.03}},
      [](SiteSet& set) { set.points.rightCols(kSites / 2) = set.points.leftCols(kSites / 2).eval(); });
  add("repeated sites that disagree", "each site twice, 0.1 N apart",
      {{0.95, 0.15, 0.03}, {0.85, 0.4, 0.03}, {0.9, 0.25, 0.03}}, [](SiteSet& set) {
        set.points.rightCols(kSites / 2) = set.points.leftCols(kSites / 2).eval();
        set.fault = [](Eigen::VectorXd& force_N) {
          force_N.tail(kSites / 2).array() += 0.05;
          force_N.head(kSites / 2).array() -= 0.05;
        };
      });
  add("clusters of 1e-9", "40 clusters, 1e-9 of the range wide", clusters,
      [](SiteSet& set) { in_clusters(set, 1e-9); });
  add("clusters of 1e-6", "40 clusters, 1e-6 of the range wide", clusters,
      [](SiteSet& set) { in_clusters(set, 1e-6); });
  add("clusters of 1e-3", "40 clusters, 1e-3 of the range wide", {{0.99, 0.1, 0.1}, uncorrected, {0.99, 0.1, 0.1}},
      [](SiteSet& set) { in_clusters(set, 1e-3); });
  add("one force per cluster", "40 rests of 25 samples, the force of a rest is constant",
      {good, uncorrected, {0.99, 0.1, 0.05}, {{"kdtree-100", {0.99, 0.1, 0.4}}}}, [](SiteSet& set) {
        in_clusters(set, 5e-3, 1000);
        set.fault = [](Eigen::VectorXd& force_N) {
          for (Eigen::Index i = 40; i < force_N.size(); ++i) force_N(i) = force_N(i % 40);
        };
      });
  add("sites on a line", "depth and velocity in proportion", same, [](SiteSet& set) {
    mapped(set, [](const Eigen::Vector2d& p) { return Eigen::Vector2d(p.x(), 0.8 * p.x() + 0.1); });
  });
  add("sites on a curve", "one parabola", same, [](SiteSet& set) {
    mapped(set, [](const Eigen::Vector2d& p) { return Eigen::Vector2d(p.x(), 4.0 * p.x() * (1.0 - p.x())); });
  });
  add("a feature that is constant", "the velocity", same,
      [](SiteSet& set) { mapped(set, [](const Eigen::Vector2d& p) { return Eigen::Vector2d(p.x(), 0.7); }); });
  add("all sites at one point", "160 samples of one rest", same,
      [](SiteSet& set) { mapped(set, [](const Eigen::Vector2d&) { return Eigen::Vector2d(0.6, 0.45); }); });
  add("a dense and a sparse part", "seven of eight sites within 1e-5 of the range",
      {{0.99, 0.25, 0.1}, uncorrected, good}, [](SiteSet& set) {
        for (Eigen::Index i = 0; i < kSites; ++i)
          if (i % 8 != 0) set.points.col(i) = Eigen::Vector2d(0.5, 0.5) + 1e-5 * set.points.col(i);
        set.tested = set.points;
      });
  add("scales of 1e-6 and 1e6", "depths of nanometres, velocities of 1e5 m/s", all, [](SiteSet& set) {
    set.unit = {1e-6, 1e6};
  });
  add("scales of 1e6 and 1e-6", "depths of kilometres, velocities of 100 nm/s", all, [](SiteSet& set) {
    set.unit = {1e6, 1e-6};
  });
  add("forces of 1e-6", "3 uN", {{0.99, 1e-6, 1e-7}, {0.99, 1e-6, 1e-7}, {0.99, 1e-6, 1e-7}},
      [](SiteSet& set) { set.force_unit = 1e-6; });
  add("forces of 1e6", "3 MN", {{0.85, 1.5e5, 3e4}, {0.5, 5e5, 3e4}, {0.85, 1.5e5, 3e4}},
      [](SiteSet& set) { set.force_unit = 1e6; });
  add("outliers", "one force in 20 is 20 N too large", {{0.99, 0.15, 0.03}, uncorrected, {0.99, 0.2, 0.03}},
      [](SiteSet& set) {
        set.fault = [](Eigen::VectorXd& force_N) {
          for (Eigen::Index i = 7; i < force_N.size(); i += 20) force_N(i) += 20.0;
        };
      });
  add("a gap", "no site between 0.35 and 0.65 of the depth", all, [](SiteSet& set) {
    for (Eigen::Index i = 0; i < kSites; ++i) {
      double& u = set.points(0, i);
      u = u < 0.5 ? 0.7 * u : 1.0 - 0.7 * (1.0 - u);
    }
  });
  add("1 site", "one sample", same, [](SiteSet& set) { first_sites(set, 1); });
  add("3 sites", "as many as the tail has coefficients", same, [](SiteSet& set) { first_sites(set, 3); });
  add("sizes above the number of sites", "100 centres on 40 sites",
      {{0.99, 0.2, 0.03}, uncorrected, {0.99, 0.15, 0.03}}, [](SiteSet& set) { first_sites(set, 40); });
  add("10,000 sites", "the most that a fit keeps", all, [](SiteSet& set) { set.points = random_points(10000, 1); });
  add("all forces zero", "forces of exactly 0", {{1.0, 1e-9, 1e-9}, {1.0, 1e-9, 1e-9}, {1.0, 1e-9, 1e-9}},
      [](SiteSet& set) { set.force_unit = 0.0; });
  return cases;
}

}  // namespace palpate
