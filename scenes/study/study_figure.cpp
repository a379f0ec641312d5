#include "scenes/study/study_figure.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "engine/base/atomic_file.h"
#include "scenes/plot/draw.h"

namespace palpate {
namespace {

constexpr Hue kLineColour = 0x0072B2;
constexpr Hue kSubjectColour = 0xE69F00;
constexpr Hue kPublishedColour = 0xD55E00;
constexpr int kSteps = 60;
constexpr double kLeastShare = 0.03;  // of the largest force, where the curves begin: the relative JND is infinite at 0

std::string line_name(const char* what, const JndLine& line) {
  char text[96];
  std::snprintf(text, sizeof text, "%s: %.3f N + %.2f %%", what, line.offset_N, 100.0 * line.weber_fraction);
  return text;
}

// Panel (a) shows the JND in N, panel (b) in per cent of the force.
Panel make_panel(const StudyAnalysis& analysis, bool relative, double largest_N) {
  Panel panel;
  panel.title = relative ? "(b)" : "(a)";
  panel.x = {"Reference force [N]", "", false, 0.0, 1.08 * largest_N};
  panel.y.title = relative ? "JND [% of the reference]" : "JND [N]";
  panel.y.low = 0.0;
  if (relative) panel.y.high = 80.0;
  const auto shown = [&](double force_N, double jnd_N) { return relative ? 100.0 * jnd_N / force_N : jnd_N; };
  const auto add_line = [&](const std::string& name, const JndLine& line, Hue colour, Mark mark) {
    Series series{name, colour, mark, {}};
    for (int i = 0; i <= kSteps; ++i) {
      const double force_N = largest_N * (kLeastShare + (1.08 - kLeastShare) * i / kSteps);
      series.rows.push_back({force_N, shown(force_N, line.at(force_N))});
    }
    panel.series.push_back(std::move(series));
  };
  add_line(line_name("Hoever & Harders (2009)", JndLine{}), JndLine{}, kMutedColour, Mark::dashed);
  if (analysis.lines.ok()) {
    add_line(line_name("fitted", analysis.lines->fitted), analysis.lines->fitted, kLineColour, Mark::line);
    add_line(line_name("conservative", analysis.lines->conservative), analysis.lines->conservative, kLineColour,
             Mark::dashed);
  }
  Series subjects{"single subjects", kSubjectColour, Mark::hollow, {}};
  for (const SubjectJnd& subject : analysis.subjects) {
    for (const ReferenceJnd& one : subject.references) {
      if (one.determined) subjects.rows.push_back({one.rendered_N, shown(one.rendered_N, one.jnd_N)});
    }
  }
  Series mean{"mean of subjects, standard error", kInkColour, Mark::bars, {}};
  Series published{"", kPublishedColour, Mark::points, {}};
  for (const JndPoint& point : analysis.points) {
    const double force_N = point.reference_N;
    const double error_N = point.standard_error_N;
    Series& series = point.source == "study" ? mean : published;
    if (point.source != "study") series.name = point.source;
    series.rows.push_back({force_N, shown(force_N, point.jnd_N), shown(force_N, point.jnd_N - error_N),
                           shown(force_N, point.jnd_N + error_N)});
  }
  for (Series* series : {&subjects, &mean, &published}) panel.series.push_back(std::move(*series));
  return panel;
}

}  // namespace

Plot study_plot(const StudyAnalysis& analysis) {
  double largest_N = 0.0;
  for (const JndPoint& point : analysis.points) largest_N = std::max(largest_N, point.reference_N);
  Plot plot;
  plot.name = "figure3";
  plot.columns = 2;
  plot.height = 1.4;
  for (const bool relative : {false, true}) plot.panels.push_back(make_panel(analysis, relative, largest_N));
  return plot;
}

Status write_study_figures(const StudyAnalysis& analysis, const std::string& folder, bool overwrite) {
  const Plot plot = study_plot(analysis);
  const auto script = plot_script(plot);
  if (!script) return script.error();
  if (const Status status = write_file_atomically(folder + "/figure3.gp", *script, overwrite); !status) return status;
  return draw_plot(plot, {folder + "/figure3.svg", folder + "/figure3.png"}, overwrite);
}

}  // namespace palpate
