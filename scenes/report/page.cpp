#include "scenes/report/page.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/base/whole_file.h"
#include "scenes/evaluation/ranking.h"
#include "scenes/plot/inline_svg.h"
#include "scenes/scene/assets.h"

namespace palpate {
namespace {

constexpr double kBudget_ns = 1e6;
constexpr double kGoodShare = 0.9;      // within the JND; with less no model is worth a recommendation
constexpr double kStudiedUpTo_N = 2.5;  // Hoever & Harders (2009), section 4.1

// Never more than it is: 99.996 % is 99.99 %.
std::string percent(double share) { return share >= 1.0 ? "100 %" : fixed(std::floor(1e4 * share) / 100.0, 2) + " %"; }

std::string nanoseconds(double value) { return with_thousands(fixed(value, 0)) + " ns"; }

std::string figure_html(const ModelResult& model, const char* figure, const std::string& text) {
  return "<span data-model=\"" + escape_html(model.plan.name) + "\" data-figure=\"" + figure + "\">" + text + "</span>";
}

std::string strokes_text(const Evidence& errors) {
  return std::to_string(errors.beyond_strokes) + " of " + std::to_string(errors.strokes) +
         (errors.strokes == 1 ? " stroke" : " strokes");
}

// Of a model that no stroke speaks against.
std::string bound_html(const ModelResult& model) {
  const Evidence& errors = model.errors;
  if (errors.beyond_samples > 0) {
    return "at 95 % at least " + figure_html(model, "within_at_least", percent(errors.within_at_least())) + "; " +
           figure_html(model, "beyond_strokes", strokes_text(errors)) + (errors.strokes == 1 ? " goes" : " go") +
           " beyond";
  }
  const std::string none = figure_html(model, "beyond_strokes", strokes_text(errors)) + " beyond, ";
  if (errors.strokes <= 3) return none + "too few for a bound";
  return none + "so at 95 % up to " + figure_html(model, "strokes_at_most", percent(1.0 - errors.within_at_least())) +
         " of strokes may be";
}

// The best model on the test beside the chosen one.
const ModelResult* next_best(const ReportData& data) {
  const ModelResult* next = nullptr;
  for (const ModelResult& one : data.models) {
    if (!one.model || !one.plan.main || &one == &data.models[data.choice.chosen]) continue;
    if (next == nullptr || one.errors.p99_error_over_jnd < next->errors.p99_error_over_jnd) next = &one;
  }
  return next;
}

std::string next_html(const ReportData& data, const ModelResult& chosen) {
  const ModelResult* next = next_best(data);
  if (next == nullptr) return {};
  const PairedDifference difference = paired_difference(next->errors, chosen.errors);
  const double slower = next->time.tick.median_ns / chosen.time.tick.median_ns;
  const std::string name = "<b>" + escape_html(next->plan.name) + "</b>";
  const std::string time = figure_html(*next, "time_ratio", three_digits(slower)) + " times the time (" +
                           nanoseconds(next->time.tick.median_ns) + ")";
  if (difference.tied()) return "The next best, " + name + ", is tied with it on this test, at " + time + ".";
  const std::string by =
      figure_html(*next, "difference", three_digits(std::abs(difference.p99))) +
      " JND (95 %: " + three_digits(std::min(std::abs(difference.interval.low), std::abs(difference.interval.high))) +
      " to " + three_digits(std::max(std::abs(difference.interval.low), std::abs(difference.interval.high))) + ")";
  if (difference.p99 < 0.0)
    return "On this test " + name + " errs less, its 99 % error by " + by + ", at " + time + ".";
  return "The next best, " + name + ", would lose " + by + ", at " + time + ".";
}

// Every method at its best, eight rows at most with those that are no method.
std::vector<const ModelResult*> headline_models(const ReportData& data) {
  std::vector<const ModelResult*> rows{&data.models[0]};
  for (const Recipe recipe : {Recipe::trend, Recipe::paper, Recipe::palpate}) {
    for (const Method* method : methods()) {
      std::vector<Candidate> candidates;
      std::vector<const ModelResult*> which;
      for (const ModelResult& one : data.models) {
        if (!one.model || one.plan.recipe != recipe || one.plan.request.method != method) continue;
        candidates.push_back({&one.errors, one.size});
        which.push_back(&one);
      }
      // Of the recipe of 2009 the method that the paper recommends.
      if (candidates.empty() || (recipe == Recipe::paper && method != &kGreedyMethod)) continue;
      // What is recommended stands in the table; of the recipe of 2009 the paper's own size; else the smallest
      // of the tied.
      const ModelResult* shown = which[rank(candidates).chosen];
      for (const ModelResult* one : which) {
        const bool papers = recipe == Recipe::paper && one->plan.main;
        if (papers || one == &data.models[data.choice.chosen]) shown = one;
      }
      rows.push_back(shown);
    }
  }
  return rows;
}

Table headline_table(const ReportData& data) {
  const ModelResult& chosen = data.models[data.choice.chosen];
  Table table{"headline"};
  for (const ModelResult* one : headline_models(data)) {
    const Evidence& errors = one->errors;
    const Interval interval = errors.p99_interval();
    const PairedDifference difference = paired_difference(errors, chosen.errors);
    const std::string by = (difference.p99 > 0.0 ? "+" : "−") + three_digits(std::abs(difference.p99));
    const auto time = [&](double time_ns) { return one->time.measured ? time_ns : kNoNumber; };
    table.begin_row();
    table.add({"", "model"}, one->plan.name);
    table.add({"", "tick, evaluation [ns]", 1.0, 0, 1}, time(one->time.tick.median_ns));
    table.add({}, time(one->time.evaluation.median_ns));
    table.add({"", "≤ JND [%], strokes beyond", kInPercent, 2, 1}, std::floor(1e4 * errors.within_jnd) / 1e4);
    table.add({}, std::to_string(errors.beyond_strokes) + " of " + std::to_string(errors.strokes));
    table.add({"", "99 % error [JND], 95 % by strokes", 1.0, TableColumn::kThreeDigits, 2}, errors.p99_error_over_jnd);
    table.add({}, interval.low);
    table.add({}, interval.high);
    table.add({"", "worst [JND]"}, errors.max_error_over_jnd);
    table.add({"", "99 %: against the choice"}, one == &chosen ? "chosen" : difference.tied() ? "tied" : by);
  }
  return table;
}

double largest_force_N(const ReportData& data) {
  double largest = 0.0;
  for (const RecordingFacts& facts : data.recordings) largest = std::max(largest, facts.largest_force_N);
  return largest;
}

// What a reader must know to believe the first screen.
std::string notes_html(const ReportData& data) {
  std::vector<std::string> notes;
  const Evidence& errors = data.models[data.choice.chosen].errors;
  notes.push_back("Chosen on " + data.choice.chosen_on +
                  (data.choice.tied.size() > 1
                       ? ", where " + std::to_string(data.choice.tied.size()) +
                             " models are tied or differ by less than a hand notices: the cheapest."
                       : "."));
  if (!data.tested_on.empty()) notes.push_back("No test recording: " + data.tested_on + ".");
  const JndLine paper;
  notes.push_back("JND: " + three_digits(1e3 * data.jnd.offset_N) + " mN + " +
                  three_digits(100.0 * data.jnd.weber_fraction) + " % of the force." +
                  (data.jnd.offset_N == paper.offset_N && data.jnd.weber_fraction == paper.weber_fraction &&
                           largest_force_N(data) > kStudiedUpTo_N
                       ? " It was measured up to 2.5 N; these forces go up to " + three_digits(largest_force_N(data)) +
                             " N, where it is a continuation."
                       : ""));
  notes.push_back("A perfect model would have " + percent(data.floor.within_jnd) +
                  " within the JND and 99 % of its errors below " + three_digits(data.floor.p99_error_over_jnd) +
                  " JND, by the force sensor's noise alone (" + three_digits(1e3 * data.floor.force_noise_N) +
                  " mN, from second differences in the quietest fifth of each test recording; drift is not in it).");
  if (errors.strokes > 0 && errors.blocks > errors.strokes)
    notes.push_back(std::to_string(errors.strokes) + (errors.strokes == 1 ? " stroke" : " strokes") + " in " +
                    std::to_string(errors.blocks) +
                    " blocks of at most 2 s or a tenth of a recording; these are resampled.");
  const bool any = std::any_of(data.recordings.begin(), data.recordings.end(),
                               [](const RecordingFacts& facts) { return facts.accelerometer; });
  notes.push_back(any ? "With the accelerometer of the recordings."
                      : "From positions alone, without an accelerometer.");
  for (const double offset_m : data.surface_offset_m) {
    if (std::abs(offset_m) < 5e-5) continue;
    notes.push_back("The surface of a test recording lies at " + three_digits(1e3 * offset_m) +
                    " mm for these models; with it moved, the chosen model has " +
                    percent(data.models[data.choice.chosen].moved.within_jnd) +
                    " within the JND (table of all models).");
    break;
  }
  std::string html = "<ul class=\"notes\">";
  for (const std::string& note : notes) html += "<li>" + escape_html(note) + "</li>";
  return html + "</ul>\n";
}

std::string figure_html(const Figure& figure) {
  return "<figure>" + inline_svg(figure.svg, figure.plot.name, figure.caption) + "<figcaption>" +
         escape_html(figure.caption) + " <a class=\"data\" href=\"figures/" + figure.plot.name +
         ".gp\">data and script</a></figcaption></figure>\n";
}

std::string learnt_html(const ReportData& data) {
  const ModelResult& chosen = data.models[data.choice.chosen];
  std::string features;
  for (const FeatureSpec& spec : chosen.model->features())
    features += (features.empty() ? "" : ", ") + feature_name(spec).substr(std::string("feature_").size());
  std::string times;
  for (const double time_s : data.times_2009_s) times += (times.empty() ? "" : " and ") + three_digits(time_s);
  const auto row = [](const char* name, const std::string& value) {
    return "<tr><td class=\"text\">" + std::string(name) + "</td><td class=\"text\">" + escape_html(value) +
           "</td></tr>\n";
  };
  std::string html = "<table class=\"learnt\">" + row("Features", features);
  if (data.correction_strength)
    html += row("Strength of the correction by centres",
                fixed(100.0 * *data.correction_strength, 0) + " % of what it could be, by strokes left out");
  if (!times.empty()) html += row("Relaxation times, recipe of 2009", times + " s, fitted to the training");
  for (const RecordingSurface& surface : data.surfaces) {
    html += row(("Surface of " + escape_html(surface.name)).c_str(),
                fixed(1e3 * surface.offset_m, 3) + " mm" +
                    (std::isfinite(surface.standard_error_m) ? " ± " + fixed(1e3 * surface.standard_error_m, 3) + " mm"
                                                             : ", not told") +
                    ", force zero " + fixed(1e3 * surface.force_zero_N, 1) + " mN");
  }
  return html + "</table>\n";
}

}  // namespace

std::string answer_html(const ReportData& data) {
  const ModelResult& chosen = data.models[data.choice.chosen];
  const Evidence& errors = chosen.errors;
  const std::string name = "<b>" + escape_html(chosen.plan.name) + "</b>";
  std::string html = errors.within_jnd >= kGoodShare
                         ? "Use " + name + ": "
                         : "No model of this report is good enough. The choice is " + name + ": ";
  html += "a whole tick takes " + figure_html(chosen, "tick_ns", nanoseconds(chosen.time.tick.median_ns)) + ", " +
          figure_html(chosen, "tick_share", three_digits(100.0 * chosen.time.tick.median_ns / kBudget_ns)) +
          " % of its budget; ";
  html += figure_html(chosen, "within_jnd", percent(errors.within_jnd)) +
          " of the test is within what a hand can notice (" + bound_html(chosen) +
          "), and 99 % of the errors are below " +
          figure_html(chosen, "p99_error_over_jnd", three_digits(errors.p99_error_over_jnd)) + " JND (at 95 % below " +
          figure_html(chosen, "p99_at_most", three_digits(errors.p99_at_most())) + "). ";
  return html + next_html(data, chosen);
}

Result<std::string> make_page(const ReportData& data, const std::string& origin, const std::vector<Table>& tables,
                              const std::vector<Figure>& figures) {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  const std::string path = *assets + "/report/page.html";
  const auto text = read_whole_file(path);
  if (!text) return Error{"cannot read " + path + ", the template of the report; check the assets folder"};
  const auto table = [&](const std::string& name) {
    const auto at = std::find_if(tables.begin(), tables.end(), [&](const Table& one) { return one.name == name; });
    return at->rows.empty() ? std::string() : table_html(*at);
  };
  std::string tests;
  for (const RecordingFacts& facts : data.recordings) {
    if (facts.role != "train") tests += (tests.empty() ? "" : ", ") + facts.name;
  }
  const std::map<std::string, std::string> values{
      {"title", escape_html(tests)},       {"answer", answer_html(data)},
      {"speed", figure_html(figures[0])},  {"headline", table_html(headline_table(data))},
      {"notes", notes_html(data)},         {"worst", figure_html(figures[1])},
      {"learnt", learnt_html(data)},       {"features", table("features")},
      {"recordings", table("recordings")}, {"paper", figure_html(figures[2])},
      {"models", table("models")},         {"times", table("times")},
      {"origin", escape_html(origin)}};
  std::string page;
  std::size_t at = 0;
  for (std::size_t open; (open = text->find("{{", at)) != std::string::npos;) {
    const std::size_t close = text->find("}}", open);
    const auto value =
        close == std::string::npos ? values.end() : values.find(text->substr(open + 2, close - open - 2));
    if (value == values.end()) return Error{path + ": found {{ without the name of a part of the report behind it"};
    page.append(*text, at, open - at).append(value->second);
    at = close + 2;
  }
  return page.append(*text, at);
}

}  // namespace palpate
