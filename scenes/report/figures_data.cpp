// What the data look like: the worst seconds, the feature space, the spread over seeds.
#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/report/figures.h"
#include "scenes/report/judge.h"

namespace palpate {
namespace {

constexpr std::size_t kTracePoints = 900;    // more than pixels are of no use
constexpr std::size_t kScatterPoints = 500;  // of each kind

std::string coloured(const std::string& text, std::string_view colour, const std::string& at, int tag) {
  return "set label " + std::to_string(tag) + " " + quoted(text) + " at " + at +
         " left noenhanced textcolor rgb \"" + std::string(colour) + "\"\n";
}

// One row a group: the one with the largest error of any model, so that a single bad
// sample stays in the picture.
std::vector<TraceRow> fewer(const std::vector<TraceRow>& rows, std::size_t models) {
  const std::size_t group = rows.size() / kTracePoints + 1;
  std::vector<TraceRow> kept;
  const auto error = [&](const TraceRow& row) {
    double worst = 0.0;
    for (std::size_t i = 0; i < models && row.in_contact; ++i) {
      worst = std::max(worst, std::abs(static_cast<double>(row.force_N[i]) - row.measured_N));
    }
    return worst;
  };
  for (std::size_t first = 0; first < rows.size(); first += group) {
    std::size_t best = first;
    for (std::size_t i = first; i < std::min(rows.size(), first + group); ++i) {
      if (error(rows[i]) > error(rows[best])) best = i;
    }
    kept.push_back(rows[best]);
  }
  return kept;
}

Figure trace_figure(const ReportData& data) {
  Figure figure;
  figure.name = "worst_trace";
  const double length_s =
      data.trace.rows.empty() ? 0.0 : data.trace.rows.back().time_s - data.trace.rows.front().time_s;
  figure.title = std::string("The worst ") + (length_s > 0.95 * TraceFinder::kTraceSeconds ? std::string("five") : three_digits(length_s)) + " seconds";
  figure.caption = "The stretch of " + data.trace.recording + " with the largest errors over all main models: measured "
                   "force in the JND band, every model's force, and the errors over the JND. Where all models leave "
                   "the band together, the recording asks for more than any of them has seen.";
  figure.height = 560;
  std::vector<std::vector<double>> rows;
  double largest = 1.0;
  std::vector<double> forces;
  for (const TraceRow& row : fewer(data.trace.rows, main_models(data))) {
    const double jnd_N = data.jnd.at(row.measured_N);
    std::vector<double> line{row.time_s, row.measured_N, row.measured_N - jnd_N, row.measured_N + jnd_N};
    forces.push_back(line.back());
    for (const float force_N : row.force_N) {
      line.push_back(static_cast<double>(force_N));
      forces.push_back(static_cast<double>(force_N));
    }
    for (const float force_N : row.force_N) {
      const double ratio = row.in_contact ? std::abs(static_cast<double>(force_N) - row.measured_N) / jnd_N : 0.0;
      line.push_back(ratio);
      largest = std::max(largest, ratio);
    }
    rows.push_back(std::move(line));
  }
  figure.data = data_block("trace", rows);
  std::string force_plots;
  std::string error_plots;
  std::string labels;
  const std::size_t models = main_models(data);
  const double label_step = 0.54 / static_cast<double>(std::max<std::size_t>(models, 7) - 1);
  for (std::size_t i = 0; i < models; ++i) {
    const PlannedModel& plan = data.models[i].plan;
    const std::string colour = method_colour(*plan.request.method);
    const std::string paint = " with lines linewidth 1.2 linecolor rgb \"" + colour + "\"" +
                              (plan.request.candidates < 100 ? " dashtype 2" : "");
    force_plots += ", \\\n  $trace using 1:" + std::to_string(5 + i) + paint;
    error_plots += ", \\\n  $trace using 1:" + std::to_string(5 + models + i) + paint;
    labels += coloured(model_label(plan), colour, "graph 1.02, graph " + std::to_string(0.84 - label_step * static_cast<double>(i)),
                       static_cast<int>(i) + 3);
  }
  const double from = rows.empty() ? 0.0 : rows.front()[0];
  const double to = rows.empty() ? 1.0 : rows.back()[0];
  const std::string band = std::string(kBand);
  figure.commands =
      "set multiplot layout 2,1\nset lmargin 9\nset rmargin 17\nset xrange [" + std::to_string(from) + ":" +
      std::to_string(to) + "]\nset bmargin 1\nset tmargin 1\nset format x \"\"\nset ylabel \"Force [N]\"\nset yrange [0:" +
      std::to_string(zero_range(forces).high) + "]\n" + coloured("measured", kMeasured, "graph 1.02, graph 0.95", 1) +
      coloured("JND band", kMuted, "graph 1.02, graph 0.25", 2) + labels +
      "plot $trace using 1:3:4 with filledcurves fillcolor rgb \"" + band +
      "\" fillstyle solid noborder, \\\n  $trace using 1:2 with lines linewidth 3 linecolor rgb \"" +
      std::string(kMeasured) + "\"" + force_plots +
      "\nunset label\nset bmargin 3.2\nset tmargin 0.3\nset format x \"%g\"\nset xlabel \"Time [s]\"\n"
      "set ylabel \"Error [JND]\"\nset yrange [0:" + std::to_string(zero_range({largest}).high) + "]\n" +
      coloured("within the JND", kMuted, "graph 1.02, first 0.5", 1) +
      "plot '+' using 1:(0):(1) with filledcurves fillcolor rgb \"" + band + "\" fillstyle solid noborder" + error_plots +
      "\nunset multiplot\n";
  return figure;
}

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
    case FeatureKind::maxwell_spectrum: return {"Relaxing force [N]", 1.0};
    case FeatureKind::stops: return {"Friction [N]", 1.0};
    case FeatureKind::fading_peak: return {"Deepest depth, fading in " + time + " [mm]", 1e3};
  }
  return {"", 1.0};
}

// Depth, every other feature, and the force last.
std::vector<std::vector<double>> scatter_rows(const Coverage& coverage, const std::vector<CoveragePoint>& points) {
  std::vector<std::vector<double>> rows;
  for (const CoveragePoint& point : thinned(points, kScatterPoints)) {
    std::vector<double> row;
    for (std::size_t k = 0; k < coverage.features.size(); ++k) {
      row.push_back(feature_axis(coverage.features[k]).scale * point.features[k]);
    }
    row.push_back(point.force_N);
    rows.push_back(std::move(row));
  }
  return rows;
}

Figure coverage_figure(const ReportData& data) {
  const Coverage& coverage = data.coverage;
  const std::size_t features = coverage.features.size();
  // Against the depth: every other feature, or the force when there is none.
  std::vector<std::size_t> others;
  for (std::size_t k = 1; k < features && others.size() < 3; ++k) others.push_back(k);
  if (others.empty()) others.push_back(features);
  Figure figure;
  figure.name = "coverage";
  figure.title = "What the training data cover";
  figure.caption = "Blue: what the reduction kept of the training data; grey: test samples near it; vermilion: test "
                   "samples away from it, where models fall back to the trend. At most " +
                   std::to_string(kScatterPoints) +
                   " points of each kind are drawn. Record more of the motion where vermilion points gather.";
  const std::size_t panels = others.size();
  figure.height = static_cast<int>(60 + 240 * panels);
  figure.data = data_block("sites", scatter_rows(coverage, coverage.sites)) +
                data_block("inside", scatter_rows(coverage, coverage.test_inside)) +
                data_block("outside", scatter_rows(coverage, coverage.test_outside));
  figure.commands = "set multiplot layout " + std::to_string(panels) +
                    ",1\nset lmargin 11\nset tmargin 0.6\nset bmargin 3.2\nset rmargin 15\nset xlabel " +
                    quoted(feature_axis(coverage.features[0]).label) + "\n" +
                    coloured("trained on", kBlue, "graph 1.02, graph 0.95", 1) +
                    coloured("test, near", kMuted, "graph 1.02, graph 0.84", 2) +
                    coloured("test, away", kVermilion, "graph 1.02, graph 0.73", 3);
  for (std::size_t p = 0; p < panels; ++p) {
    const std::string y = std::to_string(others[p] + 1);
    const std::string label = others[p] < features ? feature_axis(coverage.features[others[p]]).label : "Force [N]";
    figure.commands += "set ylabel " + quoted(label) + "\nplot $inside using 1:" + y +
                       " with points pointtype 7 pointsize 0.3 linecolor rgb \"" + std::string(kMuted) +
                       "\", $sites using 1:" + y + " with points pointtype 7 pointsize 0.2 linecolor rgb \"" +
                       std::string(kBlue) + "\", $outside using 1:" + y +
                       " with points pointtype 7 pointsize 0.35 linecolor rgb \"" +
                       std::string(kVermilion) + "\"\nunset label\n";
  }
  figure.commands += "unset multiplot\n";
  return figure;
}

// Quoted; in two lines where one would run into its neighbour.
std::string method_word(const PlannedModel& plan) {
  std::string label = model_label(plan);
  if (const std::size_t comma = label.find(", "); comma != std::string::npos) label.replace(comma, 2, ",\\n");
  return "\"" + label + "\"";
}

Figure seeds_figure(const ReportData& data) {
  Figure figure;
  figure.name = "repeatability";
  figure.title = "Repeatability over seeds";
  figure.height = 320;
  std::map<std::string, std::pair<PlannedModel, std::vector<std::vector<double>>>> by_model;
  std::vector<double> rms;
  std::vector<double> worst;
  for (const SeedResult& seed : data.seeds) {
    by_model.try_emplace(seed.model.name, seed.model, std::vector<std::vector<double>>{})
        .first->second.second.push_back({1e3 * seed.errors.rms_error_N, seed.errors.max_error_over_jnd});
    rms.push_back(1e3 * seed.errors.rms_error_N);
    worst.push_back(seed.errors.max_error_over_jnd);
  }
  std::size_t count = 0;
  std::string tics;
  std::string plots[2];
  for (const auto& [name, seeds] : by_model) {
    const auto& [model, values] = seeds;
    ++count;
    std::vector<std::vector<double>> rows;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double aside = values.size() > 1 ? static_cast<double>(i) / static_cast<double>(values.size() - 1) - 0.5 : 0.0;
      rows.push_back({static_cast<double>(count) + 0.5 * aside, values[i][0], values[i][1]});
    }
    const std::string block = "seeds" + std::to_string(count);
    figure.data += data_block(block, rows);
    const std::string colour = method_colour(*model.request.method);
    for (std::size_t p = 0; p < 2; ++p) {
      plots[p] += (plots[p].empty() ? "plot $" : ", $") + block + " using 1:" + std::to_string(p + 2) +
                  " with points pointtype 7 pointsize 0.7 linecolor rgb \"" + colour + "\"";
    }
    tics += (tics.empty() ? "" : ", ") + method_word(model) + " " + std::to_string(count);
  }
  figure.caption = "One point a seed, " + std::to_string(data.seeds.size() / std::max<std::size_t>(1, count)) +
                   " seeds each, 100 centres: a single fit may be anywhere in the cloud, so a difference smaller than "
                   "the cloud says nothing about the method.";
  figure.commands = "set multiplot layout 1,2\nset bmargin 3\nset xrange [0.4:" +
                    std::to_string(static_cast<double>(count) + 0.6) +
                    "]\nset xtics (" + tics + ")\nset mxtics 1\nset ylabel \"RMS error [mN]\"\nset yrange " +
                    zero_range(rms).text() + "\n" + plots[0] + "\nset ylabel \"Worst error [JND]\"\nset yrange " +
                    zero_range(worst).text() +
                    "\nset arrow 1 from graph 0, first 1 to graph 1, first 1 nohead linewidth 1.5 dashtype 2 linecolor "
                    "rgb \"" + std::string(kMuted) +
                    "\"\nset label 1 \"JND\" at graph 0.03, first 1 left offset 0,0.55 textcolor rgb \"" +
                    std::string(kMuted) + "\"\n" + plots[1] + "\nunset multiplot\n";
  return figure;
}

}  // namespace

std::vector<Figure> data_figures(const ReportData& data) {
  std::vector<Figure> figures{trace_figure(data), coverage_figure(data)};
  if (!data.seeds.empty()) figures.push_back(seeds_figure(data));
  return figures;
}

}  // namespace palpate
