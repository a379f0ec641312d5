#include "scenes/report/page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "scenes/evaluation/ranking.h"
#include "scenes/plot/inline_svg.h"

namespace palpate {
namespace {

constexpr double kStudiedUpTo_N = 2.5;  // Hoever & Harders (2009), section 4.1

std::string verdict(const Choice& choice, std::size_t model, const PairedDifference& difference) {
  if (model == choice.recommended) return "recommended";
  const bool qualified = std::find(choice.qualified.begin(), choice.qualified.end(), model) != choice.qualified.end();
  return (difference.p99 >= 0.0 ? "+" : "−") + three_digits(std::abs(difference.p99)) +
         (qualified ? ", qualified" : "");
}

Table headline_table(const ReportData& data) {
  Table table{"headline"};
  for (const std::size_t i : headline_models(data)) {
    const ModelResult& one = data.models[i];
    const UnitErrors& errors = one.errors;
    const Interval interval = errors.p99_interval();
    const auto time = [&](double time_ns) { return one.time.measured ? time_ns : kNoNumber; };
    table.begin_row();
    table.add({"", "model"}, one.plan.name);
    table.add({"", "tick [ns]", 1.0, 0, 2}, time(one.time.tick.median_ns));
    table.add({}, time(one.time.tick.low_ns));
    table.add({}, time(one.time.tick.high_ns));
    table.add({"", std::string("≤ JND [%], ") + unit_name(errors) + "s beyond", kInPercent, 2, 1},
              std::floor(1e4 * errors.within_jnd) / 1e4);
    table.add({}, std::to_string(errors.units_above_jnd) + " of " + std::to_string(errors.units()));
    table.add({"", "99 % error [JND], 95 %", 1.0, TableColumn::kThreeDigits, 2}, errors.p99_error_over_jnd);
    table.add({}, interval.low);
    table.add({}, interval.high);
    table.add({"", "worst [JND]"}, errors.max_error_over_jnd);
    table.add({"", "99 % error minus the smallest [JND]"},
              verdict(data.choice, i, paired_difference(errors, data.models[data.choice.best].errors)));
  }
  return table;
}

double largest_force_N(const ReportData& data) {
  double largest = 0.0;
  for (const RecordingFacts& facts : data.recordings) largest = std::max(largest, facts.largest_force_N);
  return largest;
}

// Notes on how the numbers of the first screen were obtained.
std::string notes_html(const ReportData& data) {
  std::vector<std::string> notes;
  notes.push_back(
      "Recommended: the fastest of the models whose 99 % error is at most " + three_digits(kMargin_jnd) +
      " JND above the smallest, at 95 % and one-sided (qualified: " + std::to_string(data.choice.qualified.size()) +
      " of " + std::to_string(data.choice.candidates.size()) + "). In a choice between two forces " +
      three_digits(kMargin_jnd) + " JND apart 57 % of the answers are correct; guessing gives 50 %.");
  for (const ModelResult& one : data.models) {
    if (one.same.empty()) continue;
    std::string names;
    for (const std::string& name : one.same) names += (names.empty() ? "" : ", ") + name;
    notes.push_back("The same forces as " + one.plan.name + ": " + names + ".");
  }
  if (!data.tested_on.empty()) notes.push_back("No test recording: " + data.tested_on + ".");
  const JndLine paper;
  notes.push_back("JND: " + three_digits(1e3 * data.jnd.offset_N) + " mN + " +
                  three_digits(100.0 * data.jnd.weber_fraction) + " % of the force." +
                  (data.jnd.offset_N == paper.offset_N && data.jnd.weber_fraction == paper.weber_fraction &&
                           largest_force_N(data) > kStudiedUpTo_N
                       ? " It was measured up to 2.5 N; these forces go up to " + three_digits(largest_force_N(data)) +
                             " N, where it is extrapolated."
                       : ""));
  notes.push_back("A perfect model would have " + percent(data.floor.within_jnd) +
                  " within the JND and 99 % of its errors below " + three_digits(data.floor.p99_error_over_jnd) +
                  " JND, because of the noise of the force sensor (" + three_digits(1e3 * data.floor.force_noise_N) +
                  " mN, from second differences in the quietest fifth of each test recording, without drift).");
  const bool any = std::any_of(data.recordings.begin(), data.recordings.end(),
                               [](const RecordingFacts& facts) { return facts.accelerometer; });
  notes.push_back(any ? "With the accelerometer of the recordings."
                      : "From positions alone, without an accelerometer.");
  std::string html = "<ul class=\"notes\">";
  for (const std::string& note : notes) html += "<li>" + escape_html(note) + "</li>";
  return html + "</ul>\n";
}

std::string learnt_html(const ReportData& data) {
  const ModelResult& chosen = data.models[data.choice.recommended];
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
                fixed(100.0 * *data.correction_strength, 0) + " % of the fitted correction, by cross-validation");
  if (!times.empty()) html += row("Relaxation times, recipe of 2009", times + " s, fitted to the training recordings");
  for (const RecordingSurface& surface : data.surfaces) {
    html += row(("Surface of " + escape_html(surface.name)).c_str(),
                fixed(1e3 * surface.offset_m, 3) + " mm" +
                    (std::isfinite(surface.standard_error_m) ? " ± " + fixed(1e3 * surface.standard_error_m, 3) + " mm"
                                                             : ", not identified") +
                    ", force zero " + fixed(1e3 * surface.force_zero_N, 1) + " mN");
  }
  return html + "</table>\n";
}

}  // namespace

Result<std::string> make_page(const ReportData& data, const Sentence& answer, const std::string& origin,
                              const std::vector<Table>& tables, const std::vector<Figure>& figures) {
  std::string tests;
  for (const RecordingFacts& facts : data.recordings) {
    if (facts.role != "train") tests += (tests.empty() ? "" : ", ") + facts.name;
  }
  std::map<std::string, std::string> values{
      {"title", escape_html(tests)}, {"answer", html_of(answer)},   {"headline", table_html(headline_table(data))},
      {"notes", notes_html(data)},   {"learnt", learnt_html(data)}, {"origin", escape_html(origin)}};
  for (const Table& one : tables) values[one.name] = one.rows.empty() ? "" : table_html(one);
  for (const Figure& one : figures) values[one.plot.name] = figure_html(one);
  return fill_page("page.html", std::move(values));
}

}  // namespace palpate
