// Error against force (figures 4 to 7 of the paper) and the JND line (figure 3).
#include <algorithm>
#include <cmath>

#include "scenes/report/figures.h"

namespace palpate {
namespace {

struct Curve {
  const char* name;
  const char* title;
  const char* caption;
  bool largest;   // the maximum instead of mean + standard deviation
  bool relative;  // to the force at the middle of the bin
};

double middle(const ErrorBin& bin) { return 0.5 * (bin.force_from_N + bin.force_to_N); }

double value(const ErrorBin& bin, const Curve& curve) {
  const double error_N = curve.largest ? bin.max_abs_error_N : bin.mean_abs_error_N + bin.std_abs_error_N;
  return curve.relative ? 100.0 * error_N / middle(bin) : 1e3 * error_N;
}

Figure force_figure(const ReportData& data, const Curve& curve) {
  Figure figure;
  figure.name = curve.name;
  figure.title = curve.title;
  figure.caption = curve.caption;
  std::vector<double> heights;
  double highest_N = 0.0;
  for (const ModelResult& model : data.models) {
    for (const ErrorBin& bin : model.bins) {
      heights.push_back(value(bin, curve));
      heights.push_back(curve.relative ? 100.0 * data.jnd.at(middle(bin)) / middle(bin) : 1e3 * data.jnd.at(middle(bin)));
      highest_N = std::max(highest_N, bin.force_to_N);
    }
  }
  const AxisRange axis = log_range(heights);
  std::vector<SideLabel> labels;
  std::string plots;
  for (const ModelResult& model : data.models) {
    if (model.bins.empty()) continue;
    std::vector<std::vector<double>> rows;
    for (const ErrorBin& bin : model.bins) rows.push_back({middle(bin), value(bin, curve)});
    const std::string block = "model" + std::to_string(labels.size());
    const std::string colour = method_colour(*model.plan.request.method);
    figure.data += data_block(block, rows);
    plots += ", \\\n  $" + block + " with linespoints pointtype 7 pointsize 0.4 linewidth 1.5 linecolor rgb \"" + colour +
             "\"" + (model.plan.request.candidates < 100 ? " dashtype 2" : "");
    labels.push_back({axis.fraction(rows.back()[1]), model_label(model.plan), colour});
  }
  const std::string jnd = std::to_string(data.jnd.offset_N) + " + " + std::to_string(data.jnd.weber_fraction) + " * x";
  const std::string line = curve.relative ? "100 * (" + jnd + ") / x" : "1000 * (" + jnd + ")";
  const double last_N = labels.empty() ? 1.0 : highest_N;
  const double end = 1e3 * data.jnd.at(last_N) / (curve.relative ? 10.0 * last_N : 1.0);
  labels.push_back({axis.fraction(end), "JND", std::string(kMuted)});
  figure.commands = "set rmargin 17\nset logscale y\nset xrange [0:" + std::to_string(last_N) + "]\nset yrange " + axis.text() +
                    "\n" + axis.tics("y") + "set xlabel \"Measured force [N]\"\nset ylabel \"" +
                    (curve.largest ? "Largest error [" : "Mean + standard deviation [") +
                    (curve.relative ? "%" : "mN") + "]\"\njnd(x) = " + line + "\n" +
                    side_labels(labels, "graph 1.02", 0.07, 1) +
                    "plot [x=" + std::to_string(last_N / 400.0) + ":" + std::to_string(last_N) + "] '+' using 1:(" +
                    std::to_string(axis.low) + "):(jnd($1)) with filledcurves fillcolor rgb \"" + std::string(kBand) +
                    "\" fillstyle solid noborder, jnd(x) with lines linewidth 1.5 dashtype 2 linecolor rgb \"" +
                    std::string(kMuted) + "\"" + plots + "\n";
  return figure;
}

}  // namespace

std::vector<Figure> force_figures(const ReportData& data) {
  const Curve curves[] = {
      {"error_mean_absolute", "Error against force, mean + standard deviation (figure 4 of the paper)",
       "Inside the grey band a hand cannot tell the model from the material. Bins of measured force over all test "
       "samples in contact.",
       false, false},
      {"error_mean_relative", "The same, relative to the force (figure 5)",
       "Relative errors grow towards small forces, and so does what a hand tolerates there.", false, true},
      {"error_max_absolute", "Largest error against force (figure 6)",
       "The worst single sample of every bin: one outlier is enough to leave the band.", true, false},
      {"error_max_relative", "The same, relative to the force (figure 7)",
       "The worst single sample of every bin over the force at its middle.", true, true}};
  std::vector<Figure> figures;
  for (const Curve& curve : curves) figures.push_back(force_figure(data, curve));
  return figures;
}

// What the paper's text gives of its figure 3: the line, and two points at 2.5 N.
Figure jnd_figure(const ReportData& data) {
  constexpr double kPointForce_N = 2.5;
  constexpr double kOwnPoint = 0.133;      // of the force: Hoever & Harders (2009), section 4.1
  constexpr double kEarlierPoint = 0.09;   // of the force: their reference 17
  Figure figure;
  figure.name = "jnd";
  figure.title = "The just noticeable difference (figure 3)";
  figure.caption = "The conservative line of Hoever & Harders (2009), below all that was measured, is what errors are "
                   "divided by everywhere here. The two points are those that their text gives in numbers.";
  if (data.jnd.offset_N != JndLine{}.offset_N || data.jnd.weber_fraction != JndLine{}.weber_fraction) {
    figure.caption = "The scene's own line, which errors are divided by everywhere here. The two points are those that "
                     "Hoever & Harders (2009) give in numbers.";
  }
  figure.height = 320;
  figure.data = data_block("own", {{kPointForce_N, 1e3 * kOwnPoint * kPointForce_N, 100.0 * kOwnPoint}}) +
                data_block("earlier", {{kPointForce_N, 1e3 * kEarlierPoint * kPointForce_N, 100.0 * kEarlierPoint}});
  const std::string jnd = std::to_string(data.jnd.offset_N) + " + " + std::to_string(data.jnd.weber_fraction) + " * x";
  const std::string line = " with lines linewidth 2 dashtype 2 linecolor rgb \"" + std::string(kInk) + "\", ";
  const std::string points = std::string(" with points pointtype 7 pointsize 0.9 linecolor rgb \"") + std::string(kInk) +
                             "\", $earlier";
  const std::string hollow = " with points pointtype 6 pointsize 0.9 linewidth 1.5 linecolor rgb \"" + std::string(kInk) + "\"\n";
  // Beside their points, away from the line: `earlier` above it or below it.
  const auto labels = [](const std::string& own, const std::string& earlier) {
    const std::string colour = " textcolor rgb \"" + std::string(kInk) + "\"\n";
    return "set label 1 \"12 people, pen\" at " + own + colour + "set label 2 \"earlier, pinch\" at " + earlier +
           colour;
  };
  figure.commands =
      "set multiplot layout 1,2\nset xrange [0.1:5]\nset xtics 1\nset xlabel \"Force [N]\"\n"
      "set ylabel \"JND [mN]\"\nset yrange [0:500]\n" +
      labels("2.35, 375 center", "2.75, 190 left") + "plot 1000 * (" + jnd + ")" + line + "$own using 1:2" + points +
      " using 1:2" + hollow + "set ylabel \"JND [%]\"\nset yrange [0:50]\n" +
      labels("2.5, 17 center", "2.5, 4.5 center") + "plot 100 * (" + jnd + ") / x" + line + "$own using 1:3" + points +
      " using 1:3" + hollow + "unset multiplot\n";
  return figure;
}

std::vector<Figure> make_figures(const ReportData& data) {
  std::vector<Figure> figures = speed_figures(data);
  for (const auto& more : {force_figures(data), data_figures(data), cost_figures(data)}) {
    figures.insert(figures.end(), more.begin(), more.end());
  }
  figures.push_back(jnd_figure(data));
  return figures;
}

}  // namespace palpate
