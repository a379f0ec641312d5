// Error against force (figures 4 to 7 of the paper) and the JND line (figure 3).
#include <algorithm>
#include <cmath>

#include "scenes/report/data/binned_errors.h"
#include "scenes/report/figures/figures.h"

namespace palpate {
namespace {

struct Curve {
  const char* name;
  const char* title;
  bool largest;   // the maximum instead of mean + standard deviation
  bool over_jnd;  // sample by sample
};

double value(const ErrorBin& bin, const Curve& curve) {
  if (curve.over_jnd) return curve.largest ? bin.max_error_over_jnd : bin.mean_error_over_jnd + bin.std_error_over_jnd;
  return 1e3 * (curve.largest ? bin.max_abs_error_N : bin.mean_abs_error_N + bin.std_abs_error_N);
}

// Which bins leave the band, in words from the data.
std::string conclusion(const ReportData& data, const Curve& curve) {
  const ModelResult* model = nullptr;
  for (const ModelResult& one : data.models) {
    if (one.plan.main && !one.bins.empty()) model = &one;
  }
  if (model == nullptr) return {};
  const ErrorBin* worst = nullptr;
  for (const ErrorBin& bin : model->bins) {
    const Curve ratio{"", "", curve.largest, true};
    if (worst == nullptr || value(bin, ratio) > value(*worst, ratio)) worst = &bin;
  }
  const double most = value(*worst, {"", "", curve.largest, true});
  return model->plan.name + " is worst from " + three_digits(worst->force_from_N) + " to " +
         three_digits(worst->force_to_N) + " N, with " + three_digits(most) + " JND over " +
         std::to_string(worst->count) + " samples.";
}

Figure force_figure(const ReportData& data, const Curve& curve) {
  Figure figure;
  figure.name = curve.name;
  figure.script = "error_force";
  figure.title = curve.title;
  figure.caption = std::string(curve.over_jnd
                                   ? "Error over the JND, sample by sample; below the line at 1 a hand cannot tell. "
                                   : "In the grey band a hand cannot tell the model from the material. ") +
                   conclusion(data, curve) + " Hollow: few samples. Dotted, where in view: the force sensor's noise, " +
                   three_digits(1e3 * data.pooled_floor.force_noise_N) + " mN.";
  figure.width = 760;
  figure.height = 390;
  Table table{figure.name, "", false,
              {{"panel", ""}, {"model", ""}, {"force_N", ""}, {"error", ""}, {"count", ""}, {"few", ""}, {"colour", ""}},
              {}};
  Table labels{figure.name + "_labels", "", false, {{"panel", ""}, {"force_N", ""}, {"error", ""}, {"colour", ""}, {"label", ""}}, {}};
  Table counts{figure.name + "_counts", "", false, {{"force_from_N", ""}, {"force_to_N", ""}, {"force_N", ""}, {"count", ""}}, {}};
  std::vector<double> heights;
  double highest_N = 0.0;
  for (const ModelResult& model : data.models) {
    if (model.plan.rung == Rung::no_force) continue;
    for (const ErrorBin& bin : model.bins) {
      heights.push_back(value(bin, curve));
      heights.push_back(curve.over_jnd ? 1.0 : 1e3 * data.jnd.at(bin.mean_force_N));
      highest_N = std::max(highest_N, bin.force_to_N);
    }
  }
  const AxisRange axis = log_range(heights);
  const Rung rungs[] = {Rung::paper, Rung::palpate};
  std::uint64_t panel = 0;
  std::string titles[2];
  for (const Rung rung : rungs) {
    std::vector<double> wanted;
    std::vector<std::pair<double, std::string>> ends;  // colour and label
    for (const ModelResult& model : data.models) {
      if (model.bins.empty() || (model.plan.rung != rung && model.plan.rung != Rung::trend)) continue;
      for (const ErrorBin& bin : model.bins) {
        table.rows.push_back({panel, model.plan.name, std::max(bin.mean_force_N, 0.0), value(bin, curve), bin.count,
                              static_cast<std::uint64_t>(bin.count < kFewSamples ? 1 : 0), model_colour(model.plan)});
      }
      table.rows.push_back({});
      wanted.push_back(axis.fraction(value(model.bins.back(), curve)));
      ends.emplace_back(model_colour(model.plan), model_label(model.plan));
    }
    if (ends.size() < 2) continue;
    const std::vector<double> at = spread_labels(wanted, 0.075);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      labels.rows.push_back({panel, highest_N, axis.value(at[i]), ends[i].first, ends[i].second});
    }
    titles[panel++] = rung_name(rung);
  }
  for (const ModelResult& model : data.models) {
    if (!counts.rows.empty()) break;
    for (const ErrorBin& bin : model.bins) {
      counts.rows.push_back({bin.force_from_N, bin.force_to_N, 0.5 * (bin.force_from_N + bin.force_to_N), bin.count});
    }
  }
  figure.data = {std::move(table), std::move(labels), std::move(counts)};
  figure.set_number("panel_count", static_cast<double>(panel));
  figure.set_text("title_0", titles[0]);
  figure.set_text("title_1", titles[1]);
  figure.set_number("force_high", highest_N > 0.0 ? highest_N : 1.0);
  figure.set_number("y_low", axis.low);
  figure.set_number("y_high", axis.high);
  figure.set_number("over_jnd", curve.over_jnd ? 1.0 : 0.0);
  figure.set_number("jnd_offset_N", data.jnd.offset_N);
  figure.set_number("jnd_fraction", data.jnd.weber_fraction);
  figure.set_number("noise_N", data.pooled_floor.force_noise_N);
  figure.set_number("few", static_cast<double>(kFewSamples));
  figure.set_text("y_label", std::string(curve.largest ? "Largest error [" : "Mean + std of error [") +
                                 (curve.over_jnd ? "JND]" : "mN]"));
  figure.settings += axis.tics("y");
  return figure;
}

}  // namespace

std::vector<Figure> force_figures(const ReportData& data) {
  const Curve curves[] = {
      {"error_mean_absolute", "Error against force, mean + standard deviation (figure 4 of the paper)", false, false},
      {"error_mean_jnd", "The same over the JND (figure 5)", false, true},
      {"error_max_absolute", "Largest error against force (figure 6)", true, false},
      {"error_max_jnd", "The same over the JND (figure 7)", true, true}};
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
  const bool papers = data.jnd.offset_N == JndLine{}.offset_N && data.jnd.weber_fraction == JndLine{}.weber_fraction;
  figure.caption = papers ? "The conservative line of Hoever & Harders (2009), below all that was measured, is what "
                            "errors are divided by everywhere here. The two points are those that their text gives in "
                            "numbers."
                          : "The scene's own line, which errors are divided by everywhere here. The two points are "
                            "those that Hoever & Harders (2009) give in numbers.";
  figure.width = 760;
  figure.height = 270;
  Table points{"jnd", "", false, {{"own", ""}, {"force_N", ""}, {"jnd_N", ""}}, {}};
  points.rows.push_back({std::uint64_t{1}, kPointForce_N, kOwnPoint * kPointForce_N});
  points.rows.push_back({std::uint64_t{0}, kPointForce_N, kEarlierPoint * kPointForce_N});
  figure.data = {std::move(points)};
  figure.set_number("jnd_offset_N", data.jnd.offset_N);
  figure.set_number("jnd_fraction", data.jnd.weber_fraction);
  return figure;
}

std::vector<Figure> make_figures(const ReportData& data) {
  std::vector<Figure> figures = speed_figures(data);
  figures.push_back(evidence_figure(data));
  for (auto& more : {force_figures(data), std::vector<Figure>{trace_figure(data)}, data_figures(data), cost_figures(data)}) {
    figures.insert(figures.end(), more.begin(), more.end());
  }
  if (!data.facts.depth.empty()) figures.push_back(facts_figure(data));
  figures.push_back(jnd_figure(data));
  return figures;
}

}  // namespace palpate
