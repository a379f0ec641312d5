// Speed against error and its twin, fit time against error.
#include <algorithm>
#include <cmath>
#include <set>

#include "scenes/report/figures/figures.h"
#include "scenes/report/figures/label_placer.h"
#include "scenes/report/page/tables.h"

namespace palpate {
namespace {

constexpr std::size_t kMostPanels = 4;
constexpr double kNearFloor = 0.3;  // of the least error

struct Panel {
  std::string title;
  std::size_t recording = 0;  // of test_names
  bool pooled = false;
  double floor = 0.0;
};

const Evidence& errors_of(const ModelResult& model, const Panel& panel) {
  return panel.pooled ? model.pooled : model.per_recording[panel.recording];
}

// One recording, or all together and then those that are hardest for the last main model.
std::vector<Panel> panels_of(const ReportData& data) {
  std::vector<Panel> panels;
  if (data.test_names.size() == 1) return {{data.test_names[0], 0, false, data.floors.empty() ? 0.0 : data.floors[0].p99_error_over_jnd}};
  panels.push_back({"all " + std::to_string(data.test_names.size()) + " tests", 0, true, data.pooled_floor.p99_error_over_jnd});
  const std::size_t reference = main_models(data) - 1;
  std::vector<std::size_t> order(data.test_names.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto& all = data.models[reference].per_recording;
    return all[a].p99_error_over_jnd > all[b].p99_error_over_jnd;
  });
  for (const std::size_t i : order) {
    if (panels.size() == kMostPanels) break;
    panels.push_back({data.test_names[i], i, false, i < data.floors.size() ? data.floors[i].p99_error_over_jnd : 0.0});
  }
  return panels;
}

using TimeOf = double (*)(const ModelResult&);
double evaluation_ns(const ModelResult& model) { return model.time.measured ? model.time.median_ns : 0.0; }
double fit_seconds(const ModelResult& model) { return model.fit_seconds; }

// A line of the figure: one method of one recipe, by size.
std::vector<const ModelResult*> series(const ReportData& data, Rung rung, const Method& method, TimeOf time) {
  std::vector<const ModelResult*> list;
  std::set<int> sizes;
  for (const ModelResult& model : data.models) {
    const bool few = model.plan.few_candidates();
    if (model.plan.rung != rung || model.plan.request.method != &method || few || !(time(model) > 0.0)) continue;
    if (sizes.insert(model.size).second) list.push_back(&model);
  }
  std::sort(list.begin(), list.end(), [](const ModelResult* a, const ModelResult* b) { return a->size < b->size; });
  return list;
}

std::string size_text(int size) {
  return size >= 1000 && size % 1000 == 0 ? std::to_string(size / 1000) + "k" : std::to_string(size);
}

// Models that no other one beats in both.
std::vector<const ModelResult*> pareto_front(const ReportData& data, const Panel& panel, TimeOf time) {
  std::vector<const ModelResult*> all;
  for (const ModelResult& model : data.models) {
    if (time(model) > 0.0 && errors_of(model, panel).samples > 0) all.push_back(&model);
  }
  std::sort(all.begin(), all.end(), [&](const ModelResult* a, const ModelResult* b) { return time(*a) < time(*b); });
  std::vector<const ModelResult*> front;
  double best = HUGE_VAL;
  for (const ModelResult* model : all) {
    const double error = errors_of(*model, panel).p99_error_over_jnd;
    if (error >= best) continue;
    best = error;
    front.push_back(model);
  }
  return front;
}

// Pixels around the plot area of a panel; the script has the same.
struct Margins {
  double left = 72.0;
  double right = 14.0;
  double top = 28.0;
  double bottom = 62.0;
};

struct Builder {
  Figure figure;
  Table points;
  Table front;
  Table labels;
  Table panels;
  AxisRange x;
  AxisRange y;
  bool small = false;  // several panels
  double width = 0.0;  // of a plot area, pixels
  double height = 0.0;
};

void add_label(Builder& b, std::uint64_t panel, const LabelPlacer::Place& place, double x, double y, double colour,
               const std::string& text) {
  // The end of the line to what is named; the text's own end when it is near.
  const double from_x = place.far ? x : place.x;
  const double from_y = place.far ? y : place.y;
  b.labels.rows.push_back({panel, b.x.value(place.x / b.width), b.y.value(place.y / b.height), colour, text,
                           b.x.value(from_x / b.width), b.y.value(from_y / b.height)});
}

struct End {
  double x = 0.0;  // pixels
  double y = 0.0;
  double colour = 0.0;
  std::string label;
};

// The points of one method and recipe; nothing that is there is written over later.
End add_line(Builder& b, LabelPlacer& placer, const std::vector<const ModelResult*>& line, const Panel& panel,
             std::uint64_t number, TimeOf time) {
  End end;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const ModelResult& model = *line[i];
    const Evidence& errors = errors_of(model, panel);
    // A bar for each would hide the points of a small panel.
    const bool bar = !b.small || number == 0;
    const double low = bar ? errors.p99_interval.low : errors.p99_error_over_jnd;
    const double high = bar ? errors.p99_interval.high : errors.p99_error_over_jnd;
    b.points.rows.push_back({number, model.plan.name, std::string(rung_key(model.plan.rung)), time(model),
                             errors.p99_error_over_jnd, low, high, model_colour(model.plan),
                             static_cast<std::uint64_t>(model.size)});
    const double x = b.width * b.x.fraction(time(model));
    const double y = b.height * b.y.fraction(errors.p99_error_over_jnd);
    placer.keep_point_free(x, y);
    placer.keep_line_free(x, b.height * b.y.fraction(std::max(low, b.y.low)), x, b.height * b.y.fraction(std::min(high, b.y.high)));
    if (i > 0) placer.keep_line_free(end.x, end.y, x, y);
    end.x = x;
    end.y = y;
  }
  b.points.rows.push_back({});
  const PlannedModel& last = line.back()->plan;
  end.colour = model_colour(last);
  end.label = model_label(last);
  if (line.size() > 1 && !b.small) end.label += " " + size_text(line.front()->size) + "–" + size_text(line.back()->size);
  return end;
}

// The lines at one JND and at the noise of the force sensor, or where that lies.
void add_levels(Builder& b, LabelPlacer& placer, const Panel& panel, std::uint64_t number) {
  const double muted = 0x6e6e6e;
  const double one = b.height * b.y.fraction(1.0);
  const double noise = b.height * b.y.fraction(panel.floor);
  const bool inside = noise > 0.0;
  placer.keep_line_free(0.0, one, b.width, one);
  if (inside) placer.keep_line_free(0.0, noise, b.width, noise);
  const std::string one_text = b.small ? "1 JND" : "1 JND: a hand can just tell";
  add_label(b, number, placer.along(one, one_text), 0.0, 0.0, muted, one_text);
  const std::string noise_text = inside ? std::string(b.small ? "force noise" : "noise of the force sensor")
                                        : "force noise " + three_digits(panel.floor) + " JND ↓";
  add_label(b, number, placer.along(inside ? noise : 2.0, noise_text), 0.0, 0.0, muted, noise_text);
}

void add_panel(Builder& b, const ReportData& data, const Panel& panel, std::uint64_t number, TimeOf time) {
  LabelPlacer placer(b.width, b.height);
  std::vector<End> ends;
  for (const Rung rung : {Rung::trend, Rung::paper, Rung::palpate}) {
    for (const Method* method : methods()) {
      const auto line = series(data, rung, *method, time);
      if (line.empty()) continue;
      const End end = add_line(b, placer, line, panel, number, time);
      // The hollow line's partner carries the name; alone it needs its own.
      if (rung != Rung::paper || series(data, Rung::palpate, *method, time).empty()) ends.push_back(end);
    }
  }
  add_levels(b, placer, panel, number);
  std::stable_sort(ends.begin(), ends.end(), [](const End& one, const End& other) { return one.x > other.x; });
  for (const End& end : ends) add_label(b, number, placer.beside(end.x, end.y, end.label), end.x, end.y, end.colour, end.label);
  for (const ModelResult* model : pareto_front(data, panel, time)) {
    b.front.rows.push_back({number, model->plan.name, time(*model), errors_of(*model, panel).p99_error_over_jnd});
  }
  b.front.rows.push_back({});
  b.panels.rows.push_back({number, panel.title, panel.floor});
}

// Both axes just around what the models have, and one JND.
void crop(Builder& b, const ReportData& data, const std::vector<Panel>& panels, TimeOf time) {
  std::vector<double> errors{1.0};
  std::vector<double> times;
  for (const ModelResult& model : data.models) {
    if (!(time(model) > 0.0)) continue;
    times.push_back(time(model));
    for (const Panel& panel : panels) errors.push_back(errors_of(model, panel).p99_error_over_jnd);
  }
  // A floor far below all models is said in words, not drawn: it would flatten the rest.
  const double least = *std::min_element(errors.begin(), errors.end());
  for (const Panel& panel : panels) {
    if (panel.floor > kNearFloor * least) errors.push_back(panel.floor);
  }
  b.x = cropped_log_range(times, 1.4, 2.2);
  b.y = cropped_log_range(errors, 1.35, 1.35);
}

Figure make_figure(const ReportData& data, const std::string& name, TimeOf time) {
  const std::vector<Panel> panels = panels_of(data);
  Builder b{{}, {name, "", true, {{"panel", ""}, {"model", ""}, {"recipe", ""}, {"time", ""}, {"p99_error_over_jnd", ""},
                                  {"p99_low", ""}, {"p99_high", ""}, {"colour", ""}, {"size", ""}}, {}},
            {name + "_front", "", true, {{"panel", ""}, {"model", ""}, {"time", ""}, {"p99_error_over_jnd", ""}}, {}},
            {name + "_labels", "", true, {{"panel", ""}, {"time", ""}, {"p99_error_over_jnd", ""}, {"colour", ""}, {"label", ""},
                                          {"of_time", ""}, {"of_p99", ""}}, {}},
            {name + "_panels", "", true, {{"panel", ""}, {"title", ""}, {"floor", ""}}, {}}, {}, {}};
  b.small = panels.size() > 1;
  Figure& figure = b.figure;
  figure.name = name;
  figure.script = "speed_error";
  figure.has_times = true;
  figure.width = 760;
  figure.height = !b.small ? 470 : panels.size() > 2 ? 720 : 360;
  const Margins margins;
  b.width = figure.width / (b.small ? 2.0 : 1.0) - margins.left - margins.right;
  b.height = figure.height / (panels.size() > 2 ? 2.0 : 1.0) - margins.top - margins.bottom;
  crop(b, data, panels, time);
  for (std::size_t p = 0; p < panels.size(); ++p) add_panel(b, data, panels[p], p, time);
  figure.data = {b.points, b.front, b.labels, b.panels};
  figure.set_number("panel_count", static_cast<double>(panels.size()));
  figure.set_number("margin_left", margins.left);
  figure.set_number("margin_right", margins.right);
  figure.set_number("margin_top", margins.top);
  figure.set_number("margin_bottom", margins.bottom);
  figure.set_number("x_low", b.x.low);
  figure.set_number("x_high", b.x.high);
  figure.set_number("y_low", b.y.low);
  figure.set_number("y_high", b.y.high);
  figure.settings += b.y.tics("y");
  return std::move(b.figure);
}

}  // namespace

std::vector<Figure> speed_figures(const ReportData& data) {
  Figure speed = make_figure(data, "speed_error", evaluation_ns);
  speed.title = "What a microsecond buys: speed against error";
  speed.caption = "99 % of the errors are no larger than this, in what a hand can just notice; down and left is better. "
                  "Filled: Palpate. Hollow: the paper's recipe with the same method. A line goes through the sizes of "
                  "one method (numbers: fewest and most centres or nodes); bars are 95 % intervals from resampled "
                  "strokes; the grey steps are the Pareto front: nothing is both faster and better. Below the dotted "
                  "line no model can come but by luck: that is the noise of the force sensor.";
  double slowest = 0.0;
  for (const ModelResult& model : data.models) slowest = std::max(slowest, evaluation_ns(model));
  const std::string edge = slowest > 0.0 ? "1 ms tick: " + three_digits(kBudget_ns / slowest) + " × the slowest →" : "";
  speed.set_text("x_label", "One evaluation, median");
  speed.set_text("edge", edge);
  speed.set_number("is_fit", 0.0);
  Figure fit = make_figure(data, "fit_error", fit_seconds);
  fit.title = "What a second buys: fit time against error";
  fit.caption = "The same with the time of the fit, after what all methods share; a grid includes the direct fit that "
                "fills it. One after the other, on this machine.";
  fit.set_text("x_label", "Fit");
  fit.set_text("edge", "");
  fit.set_number("is_fit", 1.0);
  return {std::move(speed), std::move(fit)};
}

// Every figure of merit of the main models, with its interval.
Figure evidence_figure(const ReportData& data) {
  Figure figure;
  figure.name = "evidence";
  figure.title = "Figures of merit and their 95 % intervals";
  figure.caption = "Dots: all test samples; bars: 95 % intervals from " + std::to_string(kResamples) +
                   " resamplings of the strokes. Where bars overlap the test does not tell two models apart. Crosses: "
                   "with the surface of the test moved to the models'. Dotted: a perfect model, by the force noise. "
                   "On the left edge: none.";
  Table table{"evidence", "", false,
              {{"row", ""}, {"model", ""}, {"recipe", ""}, {"colour", ""}, {"beyond", ""}, {"beyond_low", ""},
               {"beyond_high", ""}, {"p99", ""}, {"p99_low", ""}, {"p99_high", ""}, {"rms_mN", ""}, {"rms_low", ""},
               {"rms_high", ""}, {"worst", ""}, {"worst_low", ""}, {"worst_high", ""}, {"moved_beyond", ""},
               {"moved_p99", ""}, {"moved_rms_mN", ""}, {"moved_worst", ""}},
              {}};
  std::uint64_t row = 0;
  for (const ModelResult& model : data.models) {
    if (!model.plan.main) continue;
    const Evidence& e = model.pooled;
    const Evidence& m = model.pooled_moved;
    const auto beyond = [](double within) { return 100.0 * (1.0 - within); };
    table.rows.push_back({row++, model.plan.name, std::string(rung_key(model.plan.rung)), model_colour(model.plan),
                          beyond(e.within_jnd), beyond(e.within_interval.high), beyond(e.within_interval.low),
                          e.p99_error_over_jnd, e.p99_interval.low, e.p99_interval.high, 1e3 * e.rms_error_N,
                          1e3 * e.rms_interval_N.low, 1e3 * e.rms_interval_N.high, e.max_error_over_jnd,
                          e.worst_interval.low, e.worst_interval.high, beyond(m.within_jnd), m.p99_error_over_jnd,
                          1e3 * m.rms_error_N, m.max_error_over_jnd});
  }
  figure.width = 760;
  figure.height = 80 + 24 * static_cast<int>(row);
  figure.set_number("rows", static_cast<double>(row));
  figure.set_number("floor_beyond", 100.0 * (1.0 - data.pooled_floor.within_jnd));
  figure.set_number("floor_p99", data.pooled_floor.p99_error_over_jnd);
  figure.set_number("floor_rms_mN", 1e3 * data.pooled_floor.rms_error_N);
  figure.data = {std::move(table)};
  return figure;
}

}  // namespace palpate
