#include "scenes/report/page.h"

#include <algorithm>
#include <cmath>

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
           figure_html(model, "beyond_strokes", strokes_text(errors)) + " go beyond";
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

std::string cell(const std::string& value, const std::string& small = {}) {
  return "<td>" + value + (small.empty() ? "" : "<small>" + small + "</small>") + "</td>";
}

std::string headline_row(const ReportData& data, const ModelResult& one) {
  const ModelResult& chosen = data.models[data.choice.chosen];
  const Evidence& errors = one.errors;
  const Interval interval = errors.p99_interval();
  const PairedDifference difference = paired_difference(errors, chosen.errors);
  std::string row = "<tr><td class=\"text\">" + escape_html(one.plan.name) + "</td>";
  row += one.time.measured ? cell(with_thousands(fixed(one.time.tick.median_ns, 0)),
                                  with_thousands(fixed(one.time.evaluation.median_ns, 0)))
                           : cell("–");
  row += cell(errors.within_jnd >= 1.0 ? "100" : fixed(std::floor(1e4 * errors.within_jnd) / 100.0, 2),
              std::to_string(errors.beyond_strokes) + " of " + std::to_string(errors.strokes));
  row += cell(three_digits(errors.p99_error_over_jnd), three_digits(interval.low) + "–" + three_digits(interval.high));
  row += cell(three_digits(errors.max_error_over_jnd));
  const std::string sign = difference.p99 > 0.0 ? "+" : "−";
  row += &one == &chosen     ? cell("chosen")
         : difference.tied() ? cell("tied")
                             : cell(sign + three_digits(std::abs(difference.p99)));
  return row + "</tr>\n";
}

std::string headline_table(const ReportData& data) {
  std::string html =
      "<table class=\"headline\"><thead><tr><th class=\"text\">model</th><th>tick [ns]<small>evaluation</small></th>"
      "<th>≤ JND [%]<small>strokes beyond</small></th><th>99 % error [JND]<small>95 % by strokes</small></th>"
      "<th>worst [JND]</th><th>99 %: against<br>the choice</th></tr></thead><tbody>\n";
  for (const ModelResult* one : headline_models(data)) html += headline_row(data, *one);
  return html + "</tbody></table>\n";
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
                       ? ", where " + std::to_string(data.choice.tied.size()) + " models are tied: the cheapest."
                       : "."));
  if (data.folds > 0)
    notes.push_back("No test recording: " + std::to_string(data.folds) + "-fold cross-validation over the training.");
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

std::string figure_html(const Figure& figure, const std::map<std::string, std::string>& svgs) {
  const auto svg = svgs.find(figure.plot.name);
  if (svg == svgs.end()) return {};
  return "<figure>" + inline_svg(svg->second, figure.plot.name, figure.caption) + "<figcaption>" +
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
  std::string html = "<table>" + row("Features", features);
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

TableCell any(const ErrorSummary& errors, double value) { return errors.samples > 0 ? value : kNoNumber; }

Table models_table(const ReportData& data) {
  Table table{"models", "", false, {}, {}};
  table.columns = {{"model", "model"},
                   {"size", "size"},
                   {"contact_samples", "samples"},
                   {"within_jnd", "≤ JND [%]", kInPercent, 2, true},
                   {"within_jnd_low", ""},
                   {"within_jnd_high", ""},
                   {"within_at_least", "at least [%]", kInPercent, 2},
                   {"p99_error_over_jnd", "99 % error [JND]", 1.0, TableColumn::kThreeDigits, true},
                   {"p99_error_over_jnd_low", ""},
                   {"p99_error_over_jnd_high", ""},
                   {"p99_at_most", ""},
                   {"rms_error_N", "RMS [mN]", kInMilli, TableColumn::kThreeDigits, true},
                   {"rms_error_N_low", ""},
                   {"rms_error_N_high", ""},
                   {"max_error_N", "worst [mN]", kInMilli},
                   {"max_error_over_jnd", "worst [JND]"},
                   {"strokes", "strokes"},
                   {"beyond_strokes", "beyond"},
                   {"out_of_domain_samples", ""},
                   {"moved_within_jnd", "moved: ≤ JND [%]", kInPercent, 2},
                   {"moved_p99_error_over_jnd", "99 % [JND]"},
                   {"moved_rms_error_N", "RMS [mN]", kInMilli},
                   {"left_out_p99_error_over_jnd", "left out: 99 % [JND]"},
                   {"difference_p99", "against the choice [JND]", 1.0, TableColumn::kThreeDigits, true},
                   {"difference_p99_low", ""},
                   {"difference_p99_high", ""}};
  const Evidence& chosen = data.models[data.choice.chosen].errors;
  for (const ModelResult& one : data.models) {
    const Evidence& e = one.errors;
    const Interval within = e.within_interval();
    const Interval p99 = e.p99_interval();
    const Interval rms = e.rms_interval_N();
    const PairedDifference difference = paired_difference(e, chosen);
    table.rows.push_back({one.plan.name,
                          static_cast<std::uint64_t>(one.size),
                          e.samples,
                          e.within_jnd,
                          within.low,
                          within.high,
                          e.within_at_least(),
                          e.p99_error_over_jnd,
                          p99.low,
                          p99.high,
                          e.p99_at_most(),
                          e.rms_error_N,
                          rms.low,
                          rms.high,
                          e.max_error_N,
                          e.max_error_over_jnd,
                          e.strokes,
                          e.beyond_strokes,
                          e.out_of_domain_samples,
                          any(one.moved, one.moved.within_jnd),
                          any(one.moved, one.moved.p99_error_over_jnd),
                          any(one.moved, one.moved.rms_error_N),
                          any(one.left_out, one.left_out.p99_error_over_jnd),
                          difference.p99,
                          difference.interval.low,
                          difference.interval.high});
  }
  return table;
}

Table times_table(const ReportData& data) {
  Table table{"times",
              "",
              true,
              {{"model", "model"},
               {"tick_ns", "tick [ns]", 1.0, 0},
               {"tick_p99_ns", "p99 [ns]", 1.0, 0},
               {"evaluation_ns", "evaluation [ns]", 1.0, 0},
               {"evaluation_p99_ns", "p99 [ns]", 1.0, 0},
               {"fit_seconds", "fit [s]"}},
              {}};
  for (const ModelResult& one : data.models) {
    if (!one.time.measured) continue;
    table.rows.push_back({one.plan.name, one.time.tick.median_ns, one.time.tick.p99_ns, one.time.evaluation.median_ns,
                          one.time.evaluation.p99_ns, one.fit_seconds});
  }
  return table;
}

Table recordings_table(const ReportData& data) {
  Table table{"recordings",
              "",
              false,
              {{"role", ""},
               {"name", "recording"},
               {"samples", "samples"},
               {"contact_samples", "in contact"},
               {"seconds", "[s]"},
               {"rate_Hz", "[Hz]"},
               {"deepest_m", "deepest [mm]", kInMilli},
               {"largest_force_N", "largest [N]"},
               {"force_noise_N", "force noise [mN]", kInMilli},
               {"accelerometer", "accelerometer"},
               {"content_hash", ""}},
              {}};
  table.columns[0].title = "role";
  for (const RecordingFacts& facts : data.recordings) {
    table.rows.push_back({facts.role, facts.name, facts.samples, facts.contact_samples, facts.seconds, facts.rate_Hz,
                          facts.deepest_m, facts.largest_force_N, facts.force_noise_N,
                          std::string(facts.accelerometer ? "yes" : "no"), facts.content_hash});
  }
  return table;
}

Table bins_table(const ReportData& data) {
  Table table{"force_bins",
              "",
              false,
              {{"model", ""},
               {"force_from_N", ""},
               {"force_to_N", ""},
               {"count", ""},
               {"mean_force_N", ""},
               {"mean_abs_error_N", ""},
               {"std_abs_error_N", ""},
               {"max_abs_error_N", ""},
               {"mean_error_over_jnd", ""},
               {"std_error_over_jnd", ""},
               {"max_error_over_jnd", ""}},
              {}};
  for (const ModelResult& one : data.models) {
    for (const ForceBin& bin : one.errors.bins) {
      if (!one.plan.main || bin.count == 0) continue;
      table.rows.push_back({one.plan.name, bin.force_from_N, bin.force_to_N, bin.count, bin.mean_force_N,
                            bin.mean_abs_error_N, bin.std_abs_error_N, bin.max_abs_error_N, bin.mean_error_over_jnd,
                            bin.std_error_over_jnd, bin.max_error_over_jnd});
    }
  }
  return table;
}

Table worth_table(const ReportData& data) {
  Table table{"features",
              "",
              false,
              {{"feature", "feature"},
               {"taken", "taken"},
               {"error_over_jnd_with", "RMS error over the JND with it"},
               {"error_over_jnd_without", "without"}},
              {}};
  for (const FeatureWorth& one : data.worth)
    table.rows.push_back({one.name, std::string(one.taken ? "yes" : "no"), one.error_with, one.error_without});
  return table;
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

std::vector<Table> make_tables(const ReportData& data) {
  return {models_table(data), recordings_table(data), bins_table(data), worth_table(data), times_table(data)};
}

Result<std::string> make_page(const ReportData& data, const ReportOrigin& origin, const std::vector<Figure>& figures,
                              const std::map<std::string, std::string>& svgs) {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  const std::string path = *assets + "/report/page.html";
  const auto text = read_whole_file(path);
  if (!text) return Error{"cannot read " + path + ", the template of the report; check the assets folder"};
  const auto figure = [&](std::size_t index) { return figure_html(figures[index], svgs); };
  std::string tests;
  for (const RecordingFacts& facts : data.recordings) {
    if (facts.role != "train") tests += (tests.empty() ? "" : ", ") + facts.name;
  }
  const std::map<std::string, std::string> values{
      {"title", escape_html(tests)},
      {"answer", answer_html(data)},
      {"speed", figure(0)},
      {"headline", headline_table(data)},
      {"notes", notes_html(data)},
      {"worst", figure(1)},
      {"learnt", learnt_html(data)},
      {"features", data.worth.empty() ? "" : table_html(worth_table(data))},
      {"recordings", table_html(recordings_table(data))},
      {"paper", figure(2)},
      {"models", table_html(models_table(data))},
      {"times", table_html(times_table(data))},
      {"origin", escape_html(origin.command_line + " · " + origin.version + ", " + origin.compiler + " · " +
                             origin.machine + " · " + three_digits(origin.seconds) + " s")}};
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
