// What the data look like: the feature space, the spread over seeds.
#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/report/measure/coverage_finder.h"
#include "scenes/report/figures/figures.h"

namespace palpate {
namespace {

constexpr std::size_t kScatterPoints = 500;  // of each kind
constexpr std::size_t kMostAxes = 3;

struct FeatureAxis {
  std::string label;
  double scale;
};

FeatureAxis feature_axis(const FeatureSpec& spec) {
  const std::string time = three_digits(spec.relaxation_time_s) + " s";
  switch (spec.kind) {
    case FeatureKind::depth: return {"Depth [mm]", 1e3};
    case FeatureKind::velocity: return {"Velocity [mm/s]", 1e3};
    case FeatureKind::lowpass_velocity: return {"Low-pass " + time + " [mm/s]", 1e3};
    case FeatureKind::maxwell_branch: return {"Branch " + time + " [N]", 1.0};
    case FeatureKind::maxwell_spectrum:
      return {std::to_string(spec.part_count) + (spec.part_count == 1 ? " branch, " : " branches, ") +
                  three_digits(spec.parts[0].relaxation_time_s) + " s [N]", 1.0};
    case FeatureKind::stops: return {"Stop operators [N]", 1.0};
    case FeatureKind::fading_peak: return {"Fading peak " + time + " [mm]", 1e3};
    case FeatureKind::surface_lag: return {"Surface lag [mm]", 1e3};
  }
  return {"", 1.0};
}

Figure coverage_figure(const ReportData& data) {
  const Coverage& coverage = data.coverage;
  const std::size_t features = coverage.features.size();
  // Against the depth: every other feature, or the force when there is none.
  std::vector<std::size_t> others;
  for (std::size_t k = 1; k < features && others.size() < kMostAxes; ++k) others.push_back(k);
  if (others.empty()) others.push_back(features);
  Figure figure;
  figure.name = "coverage";
  figure.title = "What the training data cover";
  figure.caption = "Blue: what the reduction kept of the training data; grey: test samples near it; vermilion: test "
                   "samples away from it, where models fall back to the trend. At most " +
                   std::to_string(kScatterPoints) +
                   " points of each kind are drawn. Record more of the motion where vermilion points gather.";
  figure.width = 760;
  figure.height = 290;
  Table table{"coverage", "", false, {{"kind", ""}, {"depth", ""}, {"y_0", ""}, {"y_1", ""}, {"y_2", ""}}, {}};
  const auto add = [&](const std::string& kind, const std::vector<CoveragePoint>& points) {
    for (const CoveragePoint& point : thinned(points, kScatterPoints)) {
      std::vector<TableCell> row{kind, feature_axis(coverage.features[0]).scale * point.features[0]};
      for (std::size_t p = 0; p < kMostAxes; ++p) {
        const std::size_t k = others[std::min(p, others.size() - 1)];
        row.emplace_back(k < features ? feature_axis(coverage.features[k]).scale * point.features[k] : point.force_N);
      }
      table.rows.push_back(std::move(row));
    }
  };
  add("near", coverage.test_inside);
  add("trained", coverage.sites);
  add("away", coverage.test_outside);
  figure.data = {std::move(table)};
  figure.set_number("panel_count", static_cast<double>(others.size()));
  figure.set_text("x_label", feature_axis(coverage.features[0]).label);
  for (std::size_t p = 0; p < kMostAxes; ++p) {
    const std::size_t k = others[std::min(p, others.size() - 1)];
    figure.set_text("y_label_" + std::to_string(p), k < features ? feature_axis(coverage.features[k]).label : "Force [N]");
  }
  return figure;
}

Figure seeds_figure(const ReportData& data) {
  Figure figure;
  figure.name = "repeatability";
  figure.title = "Repeatability over seeds";
  figure.width = 760;
  figure.height = 230;
  Table table{"repeatability_points", "", false, {{"method", ""}, {"place", ""}, {"rms_mN", ""}, {"worst_jnd", ""}, {"colour", ""}}, {}};
  Table names{"repeatability_methods", "", false, {{"method", ""}, {"label", ""}}, {}};
  std::map<std::string, std::vector<const SeedResult*>> by_model;
  for (const SeedResult& seed : data.seeds) by_model[seed.model.name].push_back(&seed);
  std::uint64_t count = 0;
  std::vector<double> rms;
  std::vector<double> worst{1.0};  // the line at one JND is always in view
  for (const auto& [name, seeds] : by_model) {
    names.rows.push_back({count, model_label(seeds.front()->model)});
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const double aside = (static_cast<double>(i) + 0.5) / static_cast<double>(seeds.size()) - 0.5;
      rms.push_back(1e3 * seeds[i]->errors.rms_error_N);
      worst.push_back(seeds[i]->errors.max_error_over_jnd);
      table.rows.push_back({count, static_cast<double>(count) + 0.5 * aside, rms.back(), worst.back(),
                            model_colour(seeds[i]->model)});
    }
    ++count;
  }
  figure.caption = "One point a seed, " + std::to_string(data.seeds.size() / std::max<std::size_t>(1, count)) +
                   " seeds each, 100 centres: a single fit may be anywhere in the cloud, so a difference smaller than "
                   "the cloud says nothing about the method.";
  figure.data = {std::move(table), std::move(names)};
  figure.set_number("methods", static_cast<double>(count));
  figure.set_number("rms_high", zero_range(rms).high);
  figure.set_number("worst_high", zero_range(worst).high);
  return figure;
}

}  // namespace

std::vector<Figure> data_figures(const ReportData& data) {
  std::vector<Figure> figures;
  if (!data.coverage.features.empty()) figures.push_back(coverage_figure(data));
  if (!data.seeds.empty()) figures.push_back(seeds_figure(data));
  return figures;
}

// The recommended model's own curves, and its relaxation spectrum.
Figure facts_figure(const ReportData& data) {
  Figure figure;
  figure.name = "model_depth";
  figure.title = "What the model says of the material";
  figure.caption = "Of " + data.facts.model + ", its trend: force of a slow press, stiffness (slow: elastic; fast: with "
                   "all branches that have had no time to relax), viscosity (slow, and at the recording's RMS speed), "
                   "and how much stiffness relaxes with which time at half the greatest depth. SI figures in "
                   "tables/model_depth.csv and tables/model_relaxation.csv.";
  figure.width = 760;
  figure.height = 440;
  Table curve{"model_depth", "", false,
              {{"depth_mm", ""}, {"elastic_N", ""}, {"elastic_stiffness_N_per_mm", ""},
               {"instantaneous_stiffness_N_per_mm", ""}, {"viscosity_slow_Ns_per_m", ""}, {"viscosity_fast_Ns_per_m", ""}},
              {}};
  for (const auto& row : data.facts.depth) {
    curve.rows.push_back({1e3 * row[0], row[1], 1e-3 * row[2], 1e-3 * row[3], row[4], row[5]});
  }
  Table spectrum{"model_depth_spectrum", "", false, {{"relaxation_time_s", ""}, {"stiffness_N_per_mm", ""}}, {}};
  for (const auto& row : data.facts.spectrum) spectrum.rows.push_back({row[0], 1e-3 * row[1]});
  // The branches are sorted by time.
  figure.set_number("spectrum_low", data.facts.spectrum.empty() ? 0.01 : 0.3 * data.facts.spectrum.front()[0]);
  figure.set_number("spectrum_high", data.facts.spectrum.empty() ? 10.0 : 3.0 * data.facts.spectrum.back()[0]);
  figure.set_number("branches", static_cast<double>(data.facts.spectrum.size()));
  figure.data = {std::move(curve), std::move(spectrum)};
  return figure;
}

}  // namespace palpate
