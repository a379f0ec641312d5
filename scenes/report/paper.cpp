#include "scenes/report/paper.h"

#include "engine/base/text.h"
#include "models/correction/methods.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/report/publish.h"

namespace palpate {
namespace {

using BinFigure = double (*)(const ForceBin&);

// The JND as a curve over the force. `relative`: divided by the force.
Series jnd_curve(const JndLine& jnd, double from_N, double to_N, bool relative) {
  Series curve{"JND", kMutedColour, Mark::dashed, {}};
  for (int i = 0; i <= 60; ++i) {
    const double force_N = from_N + (to_N - from_N) * i / 60.0;
    curve.rows.push_back({force_N, jnd.at(force_N) / (relative ? force_N : 1.0)});
  }
  return curve;
}

Figure bins_figure(const PaperData& data, int number, const std::string& title, bool relative, BinFigure value) {
  Figure figure;
  figure.plot.name = "figure_" + std::to_string(number);
  figure.plot.columns = 2;
  figure.caption = "Figure " + std::to_string(number) + ": " + title + " over the measured force.";
  for (const PaperRun& run : data.runs) {
    Panel panel;
    panel.title = run_name(run);
    panel.x.title = "Force [N]";
    panel.y = {relative ? "Relative error" : "Error", relative ? "" : "N", true};
    panel.names_at_ends = true;
    for (const PaperModel& model : run.models) {
      Series& series = panel.series.emplace_back(Series{model.name, model.colour, Mark::curve, {}});
      for (const ForceBin& bin : model.errors.bins) series.rows.push_back({bin.force_N.mean(), value(bin)});
    }
    const std::vector<PlotRow> rows = panel.series.front().rows;  // at the same forces as all
    panel.series.push_back(jnd_curve(data.jnd, rows.front().x, rows.back().x, relative));
    figure.plot.panels.push_back(std::move(panel));
  }
  return figure;
}

// Computation times over `x`, in one panel. `about`: what follows the number in the caption.
Figure time_figure(int number, const std::string& about, const Axis& x, std::vector<Series> series) {
  Figure figure;
  figure.plot.name = "figure_" + std::to_string(number);
  figure.plot.width = 0.6;
  figure.caption = "Figure " + std::to_string(number) + ": computation time over the " + about;
  Panel& panel = figure.plot.panels.emplace_back();
  panel.x = x;
  panel.y = {"Time", "s", true};
  panel.names_at_ends = true;
  panel.series = std::move(series);
  return figure;
}

Figure dimension_figure(const PaperData& data) {
  Series solve{"solve", kInkColour, Mark::curve, {}};
  Series grid{"grid", kVoxelMethod.colour, Mark::curve, {}};
  Series both{"both", kMutedColour, Mark::curve, {}};
  for (const DimensionTimes& one : data.by_dimension) {
    const auto d = static_cast<double>(one.dimensions);
    solve.rows.push_back({d, one.solve_s});
    grid.rows.push_back({d, one.grid_s});
    both.rows.push_back({d, one.solve_s + one.grid_s});
  }
  return time_figure(2, "dimension of the domain, interpolation of all sites and a grid of 10 nodes a dimension.",
                     {"Dimensions", ""}, {both, solve, grid});
}

Figure jnd_figure(const PaperData& data) {
  Figure figure;
  figure.plot.name = "figure_3";
  figure.plot.columns = 2;
  figure.plot.height = 1.5;
  figure.caption =
      "Figure 3: JND of twelve simulated subjects in the paper's study, with standard errors, and the point of Pang, "
      "Tan & Durlach (1991); the line through them, and the paper's conservative line, 0.065 N + 6.33 %. The paper's "
      "13.3 % at 2.5 N is the only one of its points with a published value.";
  for (const bool relative : {false, true}) {
    Panel panel;
    panel.x.title = "Reference force [N]";
    panel.y.title = relative ? "Relative JND" : "JND [N]";
    Series study{"simulated study", kGreedyMethod.colour, Mark::bars, {}};
    Series other{"Pang et al.", kRandomMethod.colour, Mark::bars, {}};
    Series papers{"the paper", kMeasuredColour, Mark::bars, {{2.5, relative ? 0.133 : 0.133 * 2.5}}};
    for (const JndPoint& point : data.points) {
      const double by = relative ? point.reference_N : 1.0, error_N = point.standard_error_N;
      Series& to = point.source == kPangTanDurlach.source ? other : study;
      to.rows.push_back(
          {point.reference_N, point.jnd_N / by, (point.jnd_N - error_N) / by, (point.jnd_N + error_N) / by});
    }
    Series fitted = jnd_curve(data.lines.fitted, 0.2, 3.0, relative);
    fitted.name = "fitted line";
    fitted.mark = Mark::line;
    Series conservative = jnd_curve(data.jnd, 0.2, 3.0, relative);
    conservative.name = "conservative line";
    panel.series = {std::move(study), std::move(other), std::move(papers), std::move(fitted), std::move(conservative)};
    figure.plot.panels.push_back(std::move(panel));
  }
  return figure;
}

Figure sites_figure(const PaperData& data) {
  std::vector<Series> curves;
  for (std::size_t i = 0; i < data.runs.front().models.size(); ++i) {
    const PaperModel& model = data.runs.front().models[i];
    Series& curve = curves.emplace_back(Series{model.name, model.colour, Mark::curve, {}});
    for (const FitTimes& one : data.by_sites) curve.rows.push_back({static_cast<double>(one.sites), one.seconds[i]});
  }
  return time_figure(8, "number of data points; the interpolation with its 25x11x11x11 grid.",
                     {"Data points", "", true}, std::move(curves));
}

std::vector<Figure> paper_figures(const PaperData& data) {
  return {
      dimension_figure(data),
      jnd_figure(data),
      bins_figure(data, 4, "mean plus standard deviation of the absolute error", false,
                  [](const ForceBin& bin) { return bin.error_N.mean() + bin.error_N.deviation(); }),
      bins_figure(data, 5, "mean plus standard deviation of the relative error", true,
                  [](const ForceBin& bin) { return bin.relative.mean() + bin.relative.deviation(); }),
      bins_figure(data, 6, "maximum absolute error", false, [](const ForceBin& bin) { return bin.error_N.largest(); }),
      bins_figure(data, 7, "maximum relative error", true, [](const ForceBin& bin) { return bin.relative.largest(); }),
      sites_figure(data)};
}

Table claims_table(const PaperData& data, const std::vector<Claim>& claims) {
  Table table{"claims", true};
  for (const Claim& claim : claims) {
    table.begin_row();
    table.add({"claim", "claim of the paper"}, claim.claim);
    table.add({"there", "there"}, claim.there);
    for (std::size_t i = 0; i < data.runs.size(); ++i) {
      const std::string name = run_name(data.runs[i]);
      const std::string key = data.runs[i].material + (data.runs[i].fitted_times ? "_fitted_times" : "");
      const auto& [text, verdict] = claim.here[i];
      table.add({key, name, 1.0, TableColumn::kThreeDigits, 1}, verdict_name(verdict));
      table.add({key + "_measured", ""}, text);
    }
    table.add({"tolerance", "reproduced if"}, claim.tolerance);
    table.add({"remark", "remark"}, claim.why);
  }
  return table;
}

Table models_table(const PaperData& data) {
  Table table{"models", true};
  for (const PaperRun& run : data.runs) {
    for (const PaperModel& model : run.models) {
      table.begin_row();
      table.add({"run", "run"}, run_name(run));
      table.add({"model", "model"}, model.name);
      table.add({"rms_error_N", "RMS [mN]", kInMilli}, model.errors.rms_error_N);
      table.add({"fit_seconds", "fit [s]"}, model.fit_seconds);
      table.add({"evaluation_ns", "evaluation [ns]", 1.0, 0}, model.time.evaluation.median_ns);
      table.add({"tick_ns", "tick [ns]", 1.0, 0}, model.time.tick.median_ns);
    }
  }
  return table;
}

Table bins_table(const PaperData& data) {
  Table table{"bins"};
  for (const PaperRun& run : data.runs) {
    for (const PaperModel& model : run.models) {
      for (const ForceBin& bin : model.errors.bins) {
        table.begin_row();
        table.add({"run", ""}, run_name(run));
        table.add({"model", ""}, model.name);
        table.add({"force_N", ""}, bin.force_N.mean());
        table.add({"count", ""}, bin.force_N.count());
        table.add_moments("error_N", bin.error_N);
        table.add_moments("relative_error", bin.relative);
        table.add({"jnd_N", ""}, data.jnd.at(bin.force_N.mean()));
      }
    }
  }
  return table;
}

std::string runs_words(const PaperData& data) {
  std::string text;
  for (const PaperRun& run : data.runs) {
    text.append(run_name(run)).append(": ").append(with_thousands(std::to_string(run.trained)));
    text.append(" samples to train, ").append(with_thousands(std::to_string(run.tested)));
    text.append(" to test, relaxation times");
    for (const double time_s : run.times_s) text.append(" ").append(three_digits(time_s)).append(" s");
    text.append("; ").append(run.choices).append(". ");
  }
  return text;
}

std::string summary(const PaperData& data, const std::vector<Claim>& claims) {
  std::string text = "Reproduced: ";
  std::size_t undecided = 0, incomparable = 0;
  for (std::size_t i = 0; i < data.runs.size(); ++i) {
    std::size_t compared = 0, reproduced = 0;
    for (const Claim& claim : claims) {
      const ClaimVerdict verdict = claim.here[i].verdict;
      reproduced += verdict == ClaimVerdict::reproduced ? 1 : 0;
      compared += verdict == ClaimVerdict::reproduced || verdict == ClaimVerdict::different ? 1 : 0;
      undecided += verdict == ClaimVerdict::undecided ? 1 : 0;
      incomparable += verdict > ClaimVerdict::undecided ? 1 : 0;
    }
    text += (i == 0 ? "" : "; ") + std::to_string(reproduced) + " of " + std::to_string(compared) + " claims on " +
            run_name(data.runs[i]);
  }
  text += ". Not comparable (machine, recordings, subjects): " + std::to_string(incomparable);
  if (undecided > 0)
    text += "; not decided, because --quick has a fifth of the recordings: " + std::to_string(undecided);
  return text + ".";
}

}  // namespace

Result<std::string> make_paper(const PaperRequest& request, const FitControl& control) {
  if (const Status gnuplot = find_gnuplot(); !gnuplot) return gnuplot.error();
  auto folder = ReportFolder::create(request.out, request.force);
  if (!folder) return folder.error();
  const auto data = measure_paper(request.quick, control);
  if (!data) return data.error();
  const std::vector<Claim> claims = paper_claims(*data);
  const std::vector<Table> tables{claims_table(*data, claims), models_table(*data), bins_table(*data)};
  const std::string answer = summary(*data, claims);
  nlohmann::ordered_json report{{"format", "palpate-paper"}, {"version", 1}, {"answer", answer}};
  for (const Table& table : tables) report["tables"][table.name] = table_json(table);
  const Status written = write_report(*folder, "paper.html", tables, paper_figures(*data),
                                      {{"answer", escape_html(answer)},
                                       {"runs", escape_html(runs_words(*data))},
                                       {"jnd", escape_html(kJndDefinition)},
                                       {"origin", escape_html(request.origin)}},
                                      report, control);
  if (!written) return written.error();
  return answer;
}

}  // namespace palpate
