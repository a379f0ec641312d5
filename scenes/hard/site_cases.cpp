// Tables of samples with any depth, velocity and force: the two features have no memory, so that each sample is a site
// of its own, and the thinning is off. The training is otherwise that of `palpate fit`.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/random_stream.h"
#include "scenes/hard/hard.h"

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
using Point = Eigen::Vector2d;

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
  Points tested = path();   // where the true force is compared
  Point unit{1.0, 1.0};     // factors of depth and velocity
  double force_unit = 1.0;  // factor of the forces
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
    samples.unit.push_back(samples.fold.back());
    samples.recording.push_back(0);
    samples.contact.push_back(static_cast<std::size_t>(i));
    samples.rows.push_back(row);
  }
  samples.folds = kFolds;
  samples.units = kFolds;
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
    return model.force(features);
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
  const HardFigures along_path = measure_at(path());
  figures.worst_step_N = along_path.worst_step_N;
  figures.step_over_N = along_path.step_over_N;
  return figures;
}

// The sites form 40 clusters of this radius; the force is compared at their middles.
void in_clusters(SiteSet& set, double radius, Eigen::Index count = kSites) {
  constexpr Eigen::Index kClusters = 40;
  const Points middles = set.points.leftCols(kClusters);
  const Points around = random_points(count, 4);
  set.points = around;
  for (Eigen::Index i = 0; i < count; ++i)
    set.points.col(i) = middles.col(i % kClusters) + radius * (around.col(i) - Point(0.5, 0.5));
  set.tested = middles;
}

// Sites and path on the image of the square.
void mapped(SiteSet& set, Point (*to)(double u, double v)) {
  for (Points* points : {&set.points, &set.tested})
    for (auto point : points->colwise()) point = to(point.x(), point.y());
}

void first_sites(SiteSet& set, Eigen::Index count) {
  set.points = set.points.leftCols(count).eval();
  set.tested = set.points;
}

void sites_twice(SiteSet& set) { set.points.rightCols(kSites / 2) = set.points.leftCols(kSites / 2).eval(); }

// Noise of 5 mN, a change of the true force of 10 mN from tick to tick. The trend alone cannot describe these forces.
struct SiteCase {
  const char* name;
  void (*shape)(SiteSet& set);
};
const SiteCase kSiteCases[] = {
    {"sites, nothing wrong", [](SiteSet&) {}},
    {"repeated sites", sites_twice},
    {"repeated sites that disagree",
     [](SiteSet& set) {
       sites_twice(set);
       set.fault = [](Eigen::VectorXd& force_N) {
         force_N.tail(kSites / 2).array() += 0.05;
         force_N.head(kSites / 2).array() -= 0.05;
       };
     }},
    {"clusters of 1e-9", [](SiteSet& set) { in_clusters(set, 1e-9); }},
    {"clusters of 1e-6", [](SiteSet& set) { in_clusters(set, 1e-6); }},
    {"clusters of 1e-3", [](SiteSet& set) { in_clusters(set, 1e-3); }},
    {"one force per cluster",
     [](SiteSet& set) {
       in_clusters(set, 5e-3, 1000);
       set.fault = [](Eigen::VectorXd& force_N) {
         for (Eigen::Index i = 40; i < force_N.size(); ++i) force_N(i) = force_N(i % 40);
       };
     }},
    {"sites on a line", [](SiteSet& set) { mapped(set, [](double u, double) { return Point(u, 0.8 * u + 0.1); }); }},
    {"sites on a curve",
     [](SiteSet& set) { mapped(set, [](double u, double) { return Point(u, 4.0 * u * (1.0 - u)); }); }},
    {"a feature that is constant", [](SiteSet& set) { mapped(set, [](double u, double) { return Point(u, 0.7); }); }},
    {"all sites at one point", [](SiteSet& set) { mapped(set, [](double, double) { return Point(0.6, 0.45); }); }},
    {"a dense and a sparse part",
     [](SiteSet& set) {
       for (Eigen::Index i = 0; i < kSites; ++i)
         if (i % 8 != 0) set.points.col(i) = Point(0.5, 0.5) + 1e-5 * set.points.col(i);
       set.tested = set.points;
     }},
    {"scales of 1e-6 and 1e6",
     [](SiteSet& set) {
       set.unit = {1e-6, 1e6};
     }},
    {"scales of 1e6 and 1e-6",
     [](SiteSet& set) {
       set.unit = {1e6, 1e-6};
     }},
    {"forces of 1e-6", [](SiteSet& set) { set.force_unit = 1e-6; }},
    {"forces of 1e6", [](SiteSet& set) { set.force_unit = 1e6; }},
    {"outliers",
     [](SiteSet& set) {
       set.fault = [](Eigen::VectorXd& force_N) {
         for (Eigen::Index i = 7; i < force_N.size(); i += 20) force_N(i) += 20.0;
       };
     }},
    {"a gap",
     [](SiteSet& set) {
       for (Eigen::Index i = 0; i < kSites; ++i) {
         double& u = set.points(0, i);
         u = u < 0.5 ? 0.7 * u : 1.0 - 0.7 * (1.0 - u);
       }
     }},
    {"1 site", [](SiteSet& set) { first_sites(set, 1); }},
    {"3 sites", [](SiteSet& set) { first_sites(set, 3); }},
    {"sizes above the number of sites", [](SiteSet& set) { first_sites(set, 40); }},
    {"10,000 sites", [](SiteSet& set) { set.points = random_points(10000, 1); }},
    {"all forces zero", [](SiteSet& set) { set.force_unit = 0.0; }},
};

}  // namespace

std::vector<HardCase> site_cases() {
  std::vector<HardCase> cases;
  for (const SiteCase& one : kSiteCases) {
    cases.push_back({one.name, HardKind::sites, [shape = one.shape] {
                       const auto set = std::make_shared<SiteSet>();
                       shape(*set);
                       const TrainingScene scene{
                           "hard case", {{FeatureKind::depth, 0.0, {}}, {FeatureKind::velocity, 0.0, {}}}, {}};
                       ModelPlan plan;
                       plan.thinning = Thinning::none;
                       plan.features = FeatureChoice::scene;
                       return HardTrial{std::make_shared<HardTraining>(ModelFits(samples_of(*set), scene), plan),
                                        [set](const auto& model) { return measure(*set, *model); }};
                     }});
  }
  return cases;
}

}  // namespace palpate
