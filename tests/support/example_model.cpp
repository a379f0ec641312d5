#include "tests/support/example_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/feature_specs.h"
#include "tests/support/random_points.h"

namespace palpate::test {
namespace {

constexpr double kDepth_m = 6e-3;
constexpr double kVelocity_m_per_s = 0.05;

double typical_size(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::depth:
      return kDepth_m;
    case FeatureKind::velocity:
      return kVelocity_m_per_s;
    case FeatureKind::lowpass_velocity:
      return 0.5 * kVelocity_m_per_s;
    case FeatureKind::maxwell_spectrum:
    case FeatureKind::stops:
    case FeatureKind::creep:
      return 1.0;
  }
  return 1.0;
}

VoxelGrid random_grid(std::size_t dimension, std::uint64_t seed) {
  VoxelGrid grid;
  std::size_t count = 1;
  for (std::size_t k = 0; k < dimension; ++k) {
    std::vector<double> axis;
    for (std::size_t i = 0; i < 3 + k; ++i)
      axis.push_back(-1.0 + 2.0 * static_cast<double>(i) / static_cast<double>(2 + k));
    count *= axis.size();
    grid.nodes.push_back(std::move(axis));
  }
  Numbers numbers(seed);
  for (std::size_t i = 0; i < count; ++i) grid.values_N.push_back(0.2 * numbers.next());
  return grid;
}

Provenance example_provenance() {
  Provenance from;
  from.recordings = {"press-1", "press-2"};
  from.scene = "silicone_block";
  from.samples = 41499;
  from.contact_samples = 30000;
  from.samples_after_reduction = 6850;
  from.seed = 18446744073709551615ULL;
  from.weighting = "jnd";
  from.thinning = "coverage";
  from.relaxation = "auto";
  from.training_within_jnd = 0.9991;
  return from;
}

}  // namespace

void change_rbf(ModelData& data, const std::function<void(RbfFunction&)>& change) {
  RbfFunction function = *rbf_of(data.correction);
  change(function);
  data.correction = std::make_shared<const RbfCorrection>(std::move(function));
}

void change_grid(ModelData& data, const std::function<void(VoxelGrid&)>& change) {
  VoxelGrid grid = *grid_of(data.correction);
  change(grid);
  data.correction = std::make_shared<const GridCorrection>(std::move(grid));
}

std::vector<FeatureSpec> position_features() { return {FeatureSpec{}}; }

std::vector<FeatureSpec> paper_features() {
  return {FeatureSpec{}, {FeatureKind::velocity, 0.0, {}}, lowpass(0.17), lowpass(1.27)};
}

std::vector<FeatureSpec> maxwell_features() {
  const DriveCurve drive{kDepth_m, {0.4, 0.3, 0.2, 0.1}};
  return {FeatureSpec{}, {FeatureKind::velocity, 0.0, {}}, spectrum({0.1}, drive), spectrum({1.0 / 0.9}, drive)};
}

std::vector<FeatureSpec> memory_features() {
  FeatureSpec spectrum{FeatureKind::maxwell_spectrum}, stops{FeatureKind::stops}, creep{FeatureKind::creep};
  for (const double size : {1.0, 2.0, 3.0}) {
    const DriveCurve drive{kDepth_m, {0.3, 0.1 * size, 0.0, 0.05}};
    spectrum.parts[spectrum.part_count++] = {0.03 * size * size, 0.0, drive};
  }
  for (const double size : {1.0, 2.0}) {
    stops.parts[stops.part_count++] = {0.0, 2e-4 * size, {kDepth_m, {0.2, 0.0, 0.1 * size, 0.0}}};
    creep.parts[creep.part_count++] = {0.02 * size * size, kDepth_m, {kDepth_m, {0.2 * size, 0.1, 0.0, 0.0}}};
  }
  return {FeatureSpec{}, {FeatureKind::velocity, 0.0, {}}, spectrum, stops, creep};
}

std::vector<FeatureSpec> slowing_features() {
  FeatureSpec slowed = memory_features()[2];
  slowed.slowing = 1.5;
  return {FeatureSpec{}, {FeatureKind::velocity, 0.0, {}}, slowed};
}

ElasticSpline even_spline(double at_surface_N, double at_depth_N) {
  std::vector<double> weights;
  for (std::size_t i = 0; i < kElasticTerms; ++i)
    weights.push_back(std::lerp(at_surface_N, at_depth_N, static_cast<double>(i) / (kElasticTerms - 1)));
  return combined_spline(spline_basis(), weights.data());
}

ModelData example_model(const std::string& method, KernelKind kernel, std::vector<FeatureSpec> features,
                        std::uint64_t seed) {
  ModelData data;
  data.name = method + "-" + std::string(kernel_name(kernel)) + "-" + std::to_string(seed);
  data.method = method;
  data.features = std::move(features);
  const auto n = static_cast<Eigen::Index>(data.features.size());
  data.offset.resize(n);
  data.scale.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FeatureSpec& spec = data.features[static_cast<std::size_t>(i)];
    const double size = typical_size(spec.kind);
    data.offset(i) = spec.kind == FeatureKind::depth ? 0.5 * size : 0.0;
    data.scale(i) = spec.kind == FeatureKind::depth ? 0.5 * size : size;
  }
  data.lower = data.offset - data.scale;
  data.upper = data.offset + data.scale;
  data.trend.reference_depth_m = kDepth_m;
  data.trend.elastic = even_spline(1.2, 2.4);
  data.trend.viscosity_Ns_per_m = {1.0, 0.5, -0.0};
  data.trend.thinning_Ns_per_m = {0.5, 0.0, 0.25};
  data.trend.thinning_velocity_m_per_s = 0.05;
  data.trend.velocity_limit_m_per_s = 2.0 * kVelocity_m_per_s;
  data.correction_limit_N = 0.5;
  data.largest_force_N = 2.5;
  data.cover = make_cover(random_points(static_cast<int>(n), 200, seed + 11));
  // Wide enough that trust is above 0 in most of the box.
  data.cover.inner_radius = 0.3;
  data.cover.outer_radius = 1.0 / 1.1;
  if (method == "voxel") {
    data.correction = std::make_shared<const GridCorrection>(random_grid(data.features.size(), seed));
  } else if (method != "trend") {
    RbfFunction function = random_function(kernel, static_cast<int>(n), 40, seed);
    function.weights *= 0.02;
    function.tail *= 0.1;
    data.correction = std::make_shared<const RbfCorrection>(std::move(function));
  }
  data.provenance = example_provenance();
  return data;
}

std::vector<ModelData> example_models() {
  std::vector<ModelData> models = {
      example_model("direct", KernelKind::cubic, paper_features(), 1),
      example_model("voxel", KernelKind::cubic, paper_features(), 2),
      example_model("random", KernelKind::linear, paper_features(), 3),
      example_model("kdtree", KernelKind::thin_plate, maxwell_features(), 4),
      example_model("greedy", KernelKind::linear, maxwell_features(), 5),
      example_model("greedy", KernelKind::cubic, position_features(), 6),
      example_model("voxel", KernelKind::cubic, position_features(), 7),
      example_model("trend", KernelKind::cubic, maxwell_features(), 9),
      example_model("greedy", KernelKind::cubic, paper_features(), 8),
  };
  models.back().trend = Trend{};
  models.back().trend.reference_depth_m = kDepth_m;
  models.back().name = "on-the-force";
  // All of the force is the correction: it reaches as far as the largest force, and most of it is positive.
  models.back().correction_limit_N = models.back().largest_force_N;
  change_rbf(models.back(), [](RbfFunction& function) { function.tail(0) += 1.0; });
  models.push_back(example_model("greedy", KernelKind::cubic, memory_features(), 21));
  models.push_back(example_model("greedy", KernelKind::cubic, slowing_features(), 22));
  models.back().features[0].surface_position_m = 0.4e-3;
  return models;
}

ForceModels example_force_models() {
  ForceModels models;
  for (const ModelData& data : example_models()) models.push_back(std::make_shared<const FittedModel>(data));
  return models;
}

Recording example_recording(std::size_t rows, double rate_Hz, double encoder_step_m) {
  Recording recording;
  recording.name = "example";
  for (std::size_t i = 0; i < rows; ++i) {
    RecordingRow row;
    row.time_s = static_cast<double>(i) / rate_Hz;
    const double angle = 2.0 * std::numbers::pi * 0.8 * row.time_s;
    const double position_m = -1e-3 + 3.5e-3 * (1.0 - std::cos(angle)) * (0.7 + 0.3 * std::sin(0.37 * angle));
    row.position_m = encoder_step_m > 0.0 ? std::round(position_m / encoder_step_m) * encoder_step_m : position_m;
    const double velocity_m_per_s = 3.5e-3 * std::sin(angle) * 2.0 * std::numbers::pi * 0.8;
    if (row.position_m > 0.0) row.force_N = std::max(0.0, 300.0 * row.position_m + 2.0 * velocity_m_per_s);
    recording.rows.push_back(row);
  }
  return recording;
}

}  // namespace palpate::test
