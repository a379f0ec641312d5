#include "scenes/report/measure/model_facts.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr int kDepths = 41;
constexpr double kSlow_m_per_s = 1e-6;

class TrendCurves {
 public:
  explicit TrendCurves(const ModelData& data) : data_(data) {}

  // With every branch relaxed.
  double force_N(double depth_m, double velocity_m_per_s) const {
    std::array<double, kMaxFeatures> values{};
    for (std::size_t k = 0; k < data_.features.size(); ++k) {
      if (data_.features[k].kind == FeatureKind::depth) values[k] = depth_m;
      if (data_.features[k].kind == FeatureKind::velocity) values[k] = velocity_m_per_s;
    }
    return data_.trend.at(values.data(), data_.features);
  }
  // Central difference; near the surface, one-sided.
  double stiffness(double depth_m) const {
    const double step_m = 1e-4 * reference_m();
    const double low_m = std::max(0.0, depth_m - step_m);
    return (force_N(depth_m + step_m, 0.0) - force_N(low_m, 0.0)) / (depth_m + step_m - low_m);
  }
  double slope(const DriveCurve& drive, double depth_m) const {
    const double step_m = 1e-4 * reference_m();
    const double low_m = std::max(0.0, depth_m - step_m);
    return (drive.at(depth_m + step_m) - drive.at(low_m)) / (depth_m + step_m - low_m);
  }
  // Relaxation time and stiffness of every branch.
  std::vector<std::array<double, 2>> spectrum(double depth_m) const {
    std::vector<std::array<double, 2>> branches;
    for (const FeatureSpec& spec : data_.features) {
      if (spec.kind == FeatureKind::maxwell_branch) branches.push_back({spec.relaxation_time_s, slope(spec.drive, depth_m)});
      if (spec.kind != FeatureKind::maxwell_spectrum) continue;
      for (std::size_t p = 0; p < spec.part_count; ++p) {
        branches.push_back({spec.parts[p].relaxation_time_s, slope(spec.parts[p].drive, depth_m)});
      }
    }
    std::sort(branches.begin(), branches.end());
    return branches;
  }
  // What the stop operators can hold: half the gap between going in and coming out.
  double friction_N(double depth_m) const {
    double sum = 0.0;
    for (const FeatureSpec& spec : data_.features) {
      if (spec.kind != FeatureKind::stops) continue;
      for (std::size_t p = 0; p < spec.part_count; ++p) sum += spec.parts[p].drive.at(depth_m);
    }
    return sum;
  }
  double instantaneous_stiffness(double depth_m) const {
    double sum = stiffness(depth_m);
    for (const auto& branch : spectrum(depth_m)) sum += branch[1];
    return sum;
  }
  double viscosity(double depth_m, double velocity_m_per_s) const {
    return (force_N(depth_m, velocity_m_per_s) - force_N(depth_m, 0.0)) / velocity_m_per_s;
  }
  double reference_m() const { return data_.trend.reference_depth_m; }

 private:
  const ModelData& data_;
};

void add_values(ModelFacts& facts, const ModelData& data, const TrendCurves& curves, int centres) {
  const double deepest_m = curves.reference_m();
  const double half_m = 0.5 * deepest_m;
  const double speed_m_per_s = data.trend.thinning_velocity_m_per_s;
  const auto add = [&](const char* quantity, double value, const char* unit, const std::string& meaning) {
    facts.values.push_back({std::string(quantity), value, std::string(unit), meaning});
  };
  add("greatest depth", deepest_m, "m", "of the training data");
  add("elastic force there", curves.force_N(deepest_m, 0.0), "N", "of an endlessly slow press");
  add("stiffness at the surface", curves.stiffness(0.0), "N/m", "slow");
  add("stiffness at half depth", curves.stiffness(half_m), "N/m", "slow");
  add("stiffness at full depth", curves.stiffness(deepest_m * 0.999), "N/m", "slow");
  const double instant = curves.instantaneous_stiffness(half_m);
  add("instantaneous stiffness at half depth", instant, "N/m", "before anything relaxes");
  add("share that relaxes", instant > 0.0 ? 1.0 - curves.stiffness(half_m) / instant : kNoNumber, "1", "of it, at half depth");
  if (curves.viscosity(half_m, kSlow_m_per_s) > 0.0) {
    add("viscosity at half depth", curves.viscosity(half_m, kSlow_m_per_s), "Ns/m", "slow");
    add("viscosity at half depth", curves.viscosity(half_m, speed_m_per_s), "Ns/m", "at the RMS speed");
    add("RMS speed", speed_m_per_s, "m/s", "of the training data in contact");
  } else {
    add("viscosity at half depth", 0.0, "Ns/m", "what resists the speed is in the branches below");
  }
  if (curves.friction_N(half_m) > 0.0) {
    add("dry friction at half depth", curves.friction_N(half_m), "N", "half the gap between in and out");
  }
  for (const auto& [time_s, stiffness_N_per_m] : curves.spectrum(half_m)) {
    add("relaxation time", time_s, "s", "relaxes " + three_digits(stiffness_N_per_m) + " N/m at half depth");
  }
  for (const RelaxationTime& time : data.provenance.relaxation_times) {
    if (time.standard_error_s > 0.0) {
      add("its standard error", time.standard_error_s, "s", "of " + three_digits(time.time_s) + " s, jackknife over strokes");
    }
  }
  if (centres > 0) add("largest correction", data.correction_limit_N, "N", "that the radial basis functions may add");
}

}  // namespace

ModelFacts model_facts(const std::string& name, const FittedModel& model) {
  const ModelData& data = model.data();
  const TrendCurves curves(data);
  ModelFacts facts;
  facts.model = name;
  add_values(facts, data, curves, model.centre_count());
  for (std::size_t k = 0; k < data.features.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    facts.features.push_back({feature_name(data.features[k]), data.lower(at), data.upper(at)});
  }
  for (int i = 0; i < kDepths; ++i) {
    const double depth_m = curves.reference_m() * i / (kDepths - 1);
    facts.depth.push_back({depth_m, curves.force_N(depth_m, 0.0), curves.stiffness(depth_m),
                           curves.instantaneous_stiffness(depth_m), curves.viscosity(depth_m, kSlow_m_per_s),
                           curves.viscosity(depth_m, data.trend.thinning_velocity_m_per_s)});
  }
  facts.spectrum = curves.spectrum(0.5 * curves.reference_m());
  return facts;
}

void add_model_facts(ReportData& data) {
  std::string name = data.recommendation.recommended;
  if (data.fitted.find(name) == data.fitted.end() && !data.models.empty()) name = data.models[main_models(data) - 1].plan.name;
  const auto model = data.fitted.find(name);
  if (model != data.fitted.end()) data.facts = model_facts(name, *model->second);
}

}  // namespace palpate
