#include "scenes/report/report.h"

#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <thread>

#include "engine/base/text.h"
#include "scenes/evaluation/ranking.h"
#include "scenes/plot/inline_svg.h"
#include "scenes/report/figures.h"

namespace palpate {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double kMeasuringShare = 0.93;

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  struct utsname name {};
  return uname(&name) == 0 ? name.machine : "unknown processor";
}

#if defined(__clang__)
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

constexpr double kBudget_ns = 1e6;
// No model is recommended if less than this share of the test samples is within the JND.
constexpr double kGoodShare = 0.9;
// The answer mentions the surface only if moving it changes the share within the JND by more.
constexpr double kShareThatMatters = 0.005;

// A model's name, or a number with its model and figure of merit, so that tests/scenes/report/check_report.py can
// recompute it.
struct SentencePart {
  std::string text;
  std::string model{};
  std::string figure{};  // "within_jnd"; empty: `text` is the name
};

// The answer of a report in words, which page, report.json and terminal show.
class Sentence {
 public:
  Sentence& operator<<(const std::string& text) {
    plain_ += text;
    html_ += escape_html(text);
    return *this;
  }
  Sentence& operator<<(const SentencePart& part) {
    plain_ += part.text;
    const std::string begin = part.figure.empty() ? "<b>"
                                                  : "<span data-model=\"" + escape_html(part.model) +
                                                        "\" data-figure=\"" + part.figure + "\">";
    html_ += begin + escape_html(part.text) + (part.figure.empty() ? "</b>" : "</span>");
    return *this;
  }
  const std::string& html() const { return html_; }
  std::string plain_text() const { return plain_.substr(0, plain_.find_last_not_of(' ') + 1); }

 private:
  std::string html_, plain_;
};

// Two decimals, rounded down: 99.996 % is "99.99 %".
std::string percent(double share) { return share >= 1.0 ? "100 %" : fixed(std::floor(1e4 * share) / 100.0, 2) + " %"; }

SentencePart number(const ModelResult& model, const char* figure, const std::string& text) {
  return {text, model.name, figure};
}

SentencePart name(const ModelResult& model) { return {model.name}; }

SentencePart tick(const ModelResult& model) {
  return number(model, "tick_ns", with_thousands(fixed(model.time.tick.median_ns, 0)) + " ns");
}

std::string unit_words(const UnitErrors& errors) {
  return std::to_string(errors.units()) + " " + unit_name(errors) + (errors.units() == 1 ? "" : "s");
}

void add_errors(Sentence& sentence, const ModelResult& model) {
  const UnitErrors& errors = model.errors;
  const SentencePart beyond = number(
      model, "beyond_units", std::to_string(errors.units_above_jnd) + " of " + unit_words(errors) + " exceed it");
  sentence << number(model, "within_jnd", percent(errors.within_jnd))
           << " of the test has an error of at most one JND, which a hand cannot notice (";
  if (!errors.has_intervals()) {
    sentence << beyond << ", too few for an interval";
  } else if (errors.units_above_jnd == 0) {
    sentence << beyond << "; 95 %: at most " << number(model, "units_at_most", percent(1.0 - errors.within_at_least()))
             << " do";
  } else {
    sentence << "95 %: at least " << number(model, "within_at_least", percent(errors.within_at_least())) << "; "
             << beyond;
  }
  sentence << "), and 99 % of the errors are below "
           << number(model, "p99_error_over_jnd", three_digits(errors.p99_error_over_jnd)) << " JND";
  if (errors.has_intervals())
    sentence << " (95 %: " << number(model, "p99_at_most", three_digits(errors.p99_at_most())) << ")";
  sentence << ". ";
}

std::string changed(double jnd) { return three_digits(std::abs(jnd)) + (jnd < 0.0 ? " smaller" : " larger"); }

// Compares time and error of `other` with the recommended model.
void add_comparison(Sentence& sentence, const ModelResult& other, const ModelResult& recommended) {
  const PairedDifference difference = paired_difference(other.errors, recommended.errors);
  const double time_ratio = other.time.tick.median_ns / recommended.time.tick.median_ns;
  sentence << name(other) << " takes " << number(other, "time_ratio", three_digits(time_ratio)) << " times the time ("
           << tick(other) << "), and its 99 % error is "
           << number(other, "difference", three_digits(std::abs(difference.p99)))
           << (difference.p99 < 0.0 ? " JND smaller" : " JND larger");
  if (difference.interval.known())
    sentence << " (95 %: " + changed(difference.interval.low) + " to " + changed(difference.interval.high) + ")";
  sentence << ". ";
}

// Names the test recording whose surface is farthest from the models'.
void add_surface(Sentence& sentence, const ReportData& data, const ModelResult& model) {
  if (model.moved.within_jnd - model.errors.within_jnd < kShareThatMatters) return;
  const MovedSurface& surface =
      *std::ranges::max_element(data.tested, {}, [](const MovedSurface& one) { return std::abs(one.offset_m); });
  sentence << "The surface of " + surface.name + " is at " + three_digits(1e3 * surface.offset_m) +
                  " mm for these models; with it moved, which uses the forces of the test, " +
                  percent(model.moved.within_jnd) + " of the test is within the JND. ";
}

Sentence answer(const ReportData& data) {
  const ModelResult& use = data.models[data.choice.recommended];
  const bool good = use.errors.within_jnd >= kGoodShare;
  Sentence sentence;
  sentence << (good ? "Use " : "No model is good enough as recorded. The best choice is ") << name(use)
           << ": a whole tick takes " << tick(use) << ", "
           << number(use, "tick_share", three_digits(100.0 * use.time.tick.median_ns / kBudget_ns)) << " % of 1 ms; ";
  add_errors(sentence, use);
  add_surface(sentence, data, use);
  if (data.choice.correction_off)
    sentence << "The RBF correction is off on this material: all methods equal the trend. ";
  const ModelResult& best = data.models[data.choice.best];
  if (&best != &use) add_comparison(sentence, best, use);
  if (data.choice.dominating) {
    sentence << "Another size was faster and had a smaller 99 % error in this test: ";
    add_comparison(sentence, data.models[*data.choice.dominating], use);
    sentence << "A size that is chosen by a test has to be tested on another recording. ";
  }
  for (const std::size_t i : data.choice.candidates) {
    const ModelResult& one = data.models[i];
    if (one.plan && is_papers_greedy(*one.plan) && &one != &use && &one != &best) add_comparison(sentence, one, use);
  }
  return sentence;
}

// All numbers of the report. Those that differ from run to run are in "timings".
OrderedJson report_json(const ReportData& data, const ReportRequest& request, const Sentence& answer,
                        const std::vector<Table>& tables, const std::vector<Figure>& figures,
                        const std::string& machine, double seconds) {
  OrderedJson numbers = OrderedJson::object();
  OrderedJson times = OrderedJson::object();
  for (const Table& table : tables) (table.has_times ? times : numbers)[table.name] = table_json(table);
  OrderedJson list = OrderedJson::array();
  for (const Figure& figure : figures) list.push_back(figure.plot.name);
  const auto named = [&](const std::vector<std::size_t>& models) {
    OrderedJson names = OrderedJson::array();
    for (const std::size_t index : models) names.push_back(data.models[index].name);
    return names;
  };
  OrderedJson offsets = OrderedJson::array();
  for (const MovedSurface& one : data.tested) offsets.push_back(one.offset_m);
  return {{"format", "palpate-report"},
          {"version", 1},
          {"scene", data.scene.name},
          {"jnd", {{"offset_N", data.scene.jnd.offset_N}, {"weber_fraction", data.scene.jnd.weber_fraction}}},
          {"quick", request.quick},
          {"virtual_recordings", request.train.empty()},
          {"folds", data.recordings.folds.size() > 1 ? data.recordings.folds.size() : 0},
          {"noise_floor",
           {{"force_noise_N", data.floor.force_noise_N},
            {"within_jnd", data.floor.within_jnd},
            {"p99_error_over_jnd", data.floor.p99_error_over_jnd}}},
          {"surface_offset_m", offsets},
          {"correction_off", data.choice.correction_off},
          {"relaxation_papers_times_s", data.papers_times_s},
          {"tables", numbers},
          {"figures", list},
          {"timings",
           {{"machine", machine},
            {"seconds", seconds},
            {"answer", answer.plain_text()},
            {"recommended", data.models[data.choice.recommended].name},
            {"candidates", named(data.choice.candidates)},
            {"qualified", named(data.choice.qualified)},
            {"tables", times}}},
          {"program", {{"version", request.version}, {"compiler", kCompiler}}},
          {"command_line", request.command_line}};
}

constexpr double kStudiedUpTo_N = 2.5;  // Hoever & Harders (2009), section 4.1

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
    notes.push_back("The same forces as " + one.name + ": " + joined(one.same) + ".");
  }
  const std::string& tested_on = data.recordings.folds.front().words;
  if (!tested_on.empty()) notes.push_back("No test recording: " + tested_on + ".");
  double largest_N = 0.0;
  bool accelerometer = false;
  for (const PreparedRecordingPointer& one : data.recordings.all) {
    largest_N = std::max(largest_N, presses_of(one->recording).largest_force_N);
    accelerometer = accelerometer || one->recording.columns.acceleration;
  }
  const JndLine paper;
  const JndLine& jnd = data.scene.jnd;
  notes.push_back(
      "JND: " + three_digits(1e3 * jnd.offset_N) + " mN + " + three_digits(100.0 * jnd.weber_fraction) +
      " % of the force." +
      (jnd.offset_N == paper.offset_N && jnd.weber_fraction == paper.weber_fraction && largest_N > kStudiedUpTo_N
           ? " It was measured up to 2.5 N; these forces go up to " + three_digits(largest_N) +
                 " N, where it is extrapolated."
           : ""));
  notes.push_back("A perfect model would have " + percent(data.floor.within_jnd) +
                  " within the JND and 99 % of its errors below " + three_digits(data.floor.p99_error_over_jnd) +
                  " JND, because of the noise of the force sensor (" + three_digits(1e3 * data.floor.force_noise_N) +
                  " mN, from second differences in the quietest fifth of each test recording, without drift).");
  notes.push_back(accelerometer ? "With the accelerometer of the recordings."
                                : "From positions alone, without an accelerometer.");
  std::string html = "<ul class=\"notes\">";
  for (const std::string& note : notes) html += "<li>" + escape_html(note) + "</li>";
  return html + "</ul>\n";
}

std::string learnt_html(const ReportData& data) {
  const ModelResult& chosen = data.models[data.choice.recommended];
  std::vector<std::string> features, times;
  for (const FeatureSpec& spec : chosen.model->features())
    features.push_back(feature_name(spec).substr(std::string("feature_").size()));
  for (const double time_s : data.papers_times_s) times.push_back(three_digits(time_s));
  const auto row = [](const char* name, const std::string& value) {
    return "<tr><td class=\"text\">" + std::string(name) + "</td><td class=\"text\">" + escape_html(value) +
           "</td></tr>\n";
  };
  std::string html = "<table class=\"learnt\">" + row("Features", joined(features));
  if (data.corrects)
    html += row("Correction by centres", *data.corrects ? "used: it lowers the cross-validated error"
                                                        : "not used: it does not lower the cross-validated error");
  if (!times.empty())
    html += row("Relaxation times of the methods on the force",
                joined(times, " and ") + " s, fitted to the training recordings");
  for (const RecordingOffset& surface : data.surfaces) {
    html += row(("Surface of " + escape_html(surface.name)).c_str(),
                fixed(1e3 * surface.offset_m, 3) + " mm" +
                    (std::isfinite(surface.standard_error_m) ? " ± " + fixed(1e3 * surface.standard_error_m, 3) + " mm"
                                                             : ", not identified") +
                    ", force zero " + fixed(1e3 * surface.force_zero_N, 1) + " mN");
  }
  return html + "</table>\n";
}

// The parts of the page beside tables and figures. `origin`: command line, version and machine.
std::map<std::string, std::string> page_parts(const ReportData& data, const Sentence& answer,
                                              const std::string& origin) {
  std::vector<std::string> tests;
  for (std::size_t i = 0; i < data.recordings.all.size(); ++i) {
    if (data.recordings.is_tested(i)) tests.push_back(data.recordings.all[i]->recording.name);
  }
  return {{"title", escape_html(joined(tests))},
          {"answer", answer.html()},
          {"headline", table_html(headline_table(data))},
          {"notes", notes_html(data)},
          {"learnt", learnt_html(data)},
          {"origin", escape_html(origin)}};
}

}  // namespace

Result<std::string> make_report(const ReportRequest& request, const FitControl& control) {
  const auto start = std::chrono::steady_clock::now();
  if (const Status gnuplot = find_gnuplot(); !gnuplot) return gnuplot.error();
  // The folder is created before the fits, so that an error of it is reported at once.
  auto folder = ReportFolder::create(request.out, request.force);
  if (!folder) return folder.error();
  const auto recordings = split_recordings(request.train, request.test);
  if (!recordings) return recordings.error();
  FitControl measuring;
  measuring.progress = [&](double fraction) { return control.may_continue(kMeasuringShare * fraction); };
  const auto data = measure(*recordings, request.scene, request.quick, measuring);
  if (!data) return data.error();
  const Sentence words = answer(*data);
  const std::vector<Table> tables = make_tables(*data);
  const std::vector<Figure> figures{speed_figure(*data), worst_figure(*data), force_figure(*data)};
  const std::string machine =
      processor() + ", " + std::to_string(std::max(1U, std::thread::hardware_concurrency())) + " cores";
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string origin = request.command_line + " · " + request.version + ", " + kCompiler + " · " + machine +
                             " · " + three_digits(seconds) + " s";
  const OrderedJson json = report_json(*data, request, words, tables, figures, machine, seconds);
  const Status written =
      write_report(*folder, "page.html", tables, figures, page_parts(*data, words, origin), json, control);
  if (!written) return written.error();
  return words.plain_text();
}

}  // namespace palpate
