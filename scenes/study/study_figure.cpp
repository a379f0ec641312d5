#include "scenes/study/study_figure.h"

#include <algorithm>

#include "engine/base/text.h"

namespace palpate {
namespace {

constexpr int kSteps = 60;
constexpr double kLeastShare = 0.03;  // of the largest force, where the curves begin: the relative JND is infinite at 0

// Panel (a) shows the JND in N, panel (b) in per cent of the force.
Panel make_panel(const StudyAnalysis& analysis, bool relative, double largest_N) {
  Panel panel;
  panel.title = relative ? "(b)" : "(a)";
  panel.x = {"Reference force [N]", "", false, 0.0, largest_N};
  panel.y = {relative ? "JND [% of the reference]" : "JND [N]", "", false, 0.0, relative ? 80.0 : kNoValue};
  const auto shown = [&](double force_N, double jnd_N) { return relative ? 100.0 * jnd_N / force_N : jnd_N; };
  const auto add_line = [&](const std::string& name, const JndLine& line, Hue colour, Mark mark) {
    Series series{name + ": " + fixed(line.offset_N, 3) + " N + " + fixed(100.0 * line.weber_fraction, 2) + " %",
                  colour,
                  mark,
                  {}};
    for (int i = 0; i <= kSteps; ++i) {
      const double force_N = largest_N * (kLeastShare + (1.0 - kLeastShare) * i / kSteps);
      series.rows.push_back({force_N, shown(force_N, line.at(force_N))});
    }
    panel.series.push_back(std::move(series));
  };
  add_line("Hoever & Harders (2009)", JndLine{}, kMutedColour, Mark::dashed);
  if (analysis.lines.ok()) {
    add_line("fitted", analysis.lines->fitted, 0x0072B2, Mark::line);
    add_line("conservative", analysis.lines->conservative, 0x0072B2, Mark::dashed);
  }
  Series subjects{"single subjects", 0xE69F00, Mark::hollow, {}};
  for (const SubjectJnd& subject : analysis.subjects) {
    for (const ReferenceJnd& one : subject.references) {
      if (one.determined) subjects.rows.push_back({one.rendered_N, shown(one.rendered_N, one.jnd_N)});
    }
  }
  panel.series.push_back(std::move(subjects));
  Series mean{"mean of subjects, standard error", kInkColour, Mark::bars, {}};
  for (const JndPoint& point : analysis.points) {
    const double force_N = point.reference_N, error_N = point.standard_error_N;
    const PlotRow row{force_N, shown(force_N, point.jnd_N), shown(force_N, point.jnd_N - error_N),
                      shown(force_N, point.jnd_N + error_N)};
    if (point.source == "study") {
      mean.rows.push_back(row);
    } else {
      panel.series.push_back({point.source, 0xD55E00, Mark::points, {row}});
    }
  }
  panel.series.push_back(std::move(mean));
  return panel;
}

}  // namespace

Plot study_plot(const StudyAnalysis& analysis) {
  double largest_N = 0.0;
  for (const JndPoint& point : analysis.points) largest_N = std::max(largest_N, 1.08 * point.reference_N);
  Plot plot;
  plot.name = "figure3";
  plot.columns = 2;
  plot.height = 1.4;
  for (const bool relative : {false, true}) plot.panels.push_back(make_panel(analysis, relative, largest_N));
  return plot;
}

}  // namespace palpate
