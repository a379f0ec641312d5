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
#include "scenes/report/contents.h"

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

// No model is recommended if less than this share of the test samples is within the JND.
constexpr double kGoodShare = 0.9;
// The answer mentions the surface only if moving it changes the share within the JND by more.
constexpr double kShareThatMatters = 0.005;

constexpr double kStudiedUpTo_N = 2.5;  // Hoever & Harders (2009), section 4.1

// Two decimals, rounded down: 99.996 % is "99.99 %".
std::string percent(double share) { return share >= 1.0 ? "100 %" : fixed(std::floor(1e4 * share) / 100.0, 2) + " %"; }

std::string seeds_text(const ModelResult& model) {
  return model.seeds > 1 ? " (the median of " + std::to_string(model.seeds) + " seeds)" : "";
}

std::string interval_text(const Interval& interval) {
  if (!interval.known()) return {};
  return " (95 %: " + three_digits(interval.low) + " to " + three_digits(interval.high) + ")";
}

// Says by how much the model with the lowest 99 % error is better, and how much longer it takes.
std::string best_text(const ModelResult& best, const ModelResult& use) {
  const PairedDifference difference = paired_difference(use.errors, best.errors);
  return "; the lowest 99 % error, " + three_digits(difference.p99) + " JND less" + interval_text(difference.interval) +
         ", is that of " + best.name + ", which takes " +
         three_digits(best.time.tick.median_ns / use.time.tick.median_ns) + " times as long";
}

// Names the test recording whose surface is farthest from the models'.
std::string surface_text(const ReportData& data, const ModelResult& model) {
  if (model.moved.within_jnd - model.errors.within_jnd < kShareThatMatters) return {};
  const RecordingOffset& surface =
      *std::ranges::max_element(data.tested, {}, [](const RecordingOffset& one) { return std::abs(one.offset_m); });
  return " The surface of " + surface.name + " is at " + three_digits(1e3 * surface.offset_m) +
         " mm for these models; with it moved, which uses the forces of the test, " + percent(model.moved.within_jnd) +
         " of the test is within the JND.";
}

// The answer of a report, which page, report.json and terminal show.
std::string answer(const ReportData& data) {
  const ModelResult& use = data.models[data.choice.recommended];
  const ModelResult& best = data.models[data.choice.best];
  const UnitErrors& errors = use.errors;
  return (errors.within_jnd >= kGoodShare ? "Use " : "No model is good enough as recorded; the best choice is ") +
         use.name + seeds_text(use) + ": a whole tick takes " + with_thousands(fixed(use.time.tick.median_ns, 0)) +
         " ns, the error is below the just noticeable difference in " + percent(errors.within_jnd) +
         " of the test, and 99 % of the errors are below " + three_digits(errors.p99_error_over_jnd) + " JND" +
         interval_text(errors.p99_interval()) + (&best != &use ? best_text(best, use) : "") +
         "; this test chose it among " + std::to_string(data.models.size() - 1) +
         " models, so another recording has to confirm these figures." + surface_text(data, use);
}

// All numbers of the report. Those that differ from run to run are in "timings".
OrderedJson report_json(const ReportData& data, const ReportRequest& request, const std::string& answer,
                        const std::vector<Table>& tables, const std::vector<Figure>& figures,
                        const std::string& machine, double seconds) {
  OrderedJson numbers = OrderedJson::object();
  OrderedJson times = OrderedJson::object();
  for (const Table& table : tables) (table.has_times ? times : numbers)[table.name] = table_json(table);
  OrderedJson list = OrderedJson::array();
  for (const Figure& figure : figures) list.push_back(figure.plot.name);
  OrderedJson candidates = OrderedJson::array(), near_best = OrderedJson::array();
  for (std::size_t i = 1; i < data.models.size(); ++i) {
    candidates.push_back(data.models[i].name);
    if (data.choice.near_best[i]) near_best.push_back(data.models[i].name);
  }
  OrderedJson offsets = OrderedJson::array();
  for (const RecordingOffset& one : data.tested) offsets.push_back(one.offset_m);
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
          {"correction_used", data.corrects},
          {"relaxation_papers_times_s", data.papers_times_s},
          {"tables", numbers},
          {"figures", list},
          {"timings",
           {{"machine", machine},
            {"seconds", seconds},
            {"answer", answer},
            {"recommended", data.models[data.choice.recommended].name},
            {"candidates", candidates},
            {"near_best", near_best},
            {"tables", times}}},
          {"program", {{"version", request.version}, {"compiler", kCompiler}}},
          {"command_line", request.command_line}};
}

// Describes methods whose 99 % error is larger with more centres, by more than the margin of the ranking.
std::vector<std::string> rising_errors(const ReportData& data) {
  std::vector<std::string> notes;
  for (const ModelResult& few : data.models) {
    for (const ModelResult& many : data.models) {
      if (!few.model || !many.model || few.size >= many.size || !few.plan->selects_centres()) continue;
      const double rise = many.errors.p99_error_over_jnd - few.errors.p99_error_over_jnd;
      if (family_name(*few.plan) != family_name(*many.plan) || rise <= kMargin_jnd) continue;
      notes.push_back("More centres are worse here: " + many.name + " has a 99 % error of " +
                      three_digits(many.errors.p99_error_over_jnd) + " JND, " + few.name + " of " +
                      three_digits(few.errors.p99_error_over_jnd) + " JND.");
    }
  }
  return notes;
}

// How far the 95 % bound of the recommended model holds.
std::string bound_note(const ModelResult& use) {
  if (!use.bound.has_bounds()) return {};
  return "The 95 % bound of " + use.name + " holds for " + percent(use.bound.coverage) +
         " of the samples as recorded, " + percent(use.bound_moved.coverage) +
         " with the surface moved; its median is " +
         (std::isfinite(use.bound.median_over_jnd) ? three_digits(use.bound.median_over_jnd) + " JND"
                                                   : "not known: it exceeds the largest force") +
         ".";
}

// Notes on how the numbers of the first screen were obtained.
std::string notes_html(const ReportData& data) {
  std::vector<std::string> notes;
  notes.push_back("Recommended: of the models whose 99 % error is at most " + general(kMargin_jnd, 3) +
                  " JND above the lowest (" + std::to_string(std::ranges::count(data.choice.near_best, true)) + " of " +
                  std::to_string(data.models.size() - 1) +
                  "), the one with the shortest tick, or the simplest that takes at most " +
                  general(100.0 * kEqualTime, 3) + " % longer. In a choice between two forces " +
                  general(kMargin_jnd, 3) + " JND apart 57 % of the answers are correct; guessing gives 50 %.");
  for (const ModelResult& one : data.models) {
    if (!one.same.empty()) notes.push_back("The same forces as " + one.name + ": " + joined(one.same) + ".");
  }
  for (std::string& one : rising_errors(data)) notes.push_back(std::move(one));
  if (std::string bound = bound_note(data.models[data.choice.recommended]); !bound.empty())
    notes.push_back(std::move(bound));
  const std::string& tested_on = data.recordings.folds.front().words;
  if (!tested_on.empty()) notes.push_back("No test recording: " + tested_on + ".");
  double largest_N = 0.0;
  bool accelerometer = false;
  for (const PreparedRecordingPointer& one : data.recordings.all) {
    largest_N = std::max(largest_N, largest_force_N(one->recording));
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
  html += row("Correction by centres", data.corrects ? "used: it lowers the cross-validated error"
                                                     : "not used: it does not lower the cross-validated error");
  if (!times.empty())
    html += row("Relaxation times of the methods on the force",
                joined(times, " and ") + " s, fitted to the training recordings");
  for (const auto& [centres, choices] : data.choices) {
    html += row(("On the force, " + (centres > 0 ? std::to_string(centres) + " centres" : "direct and voxel")).c_str(),
                choices_text(choices));
  }
  for (const auto& [base, errors] : data.by_size) {
    std::vector<std::string> sizes;
    for (const auto& [size, error] : errors)
      sizes.push_back(std::to_string(size) + ": " + three_digits(error) + " JND");
    html += row(base == Base::force ? "Cross-validated by number of centres, on the force"
                                    : "Cross-validated by number of centres, on the trend",
                joined(sizes));
  }
  for (const RecordingOffset& surface : data.surfaces) {
    html += row(("Surface of " + escape_html(surface.name)).c_str(),
                fixed(1e3 * surface.offset_m, 3) + " mm" +
                    (std::isfinite(surface.standard_error_m) ? " ± " + fixed(1e3 * surface.standard_error_m, 3) + " mm"
                                                             : ", not identified") +
                    ", force zero " + fixed(1e3 * surface.force_zero_N, 1) + " mN");
  }
  return html + "</table>\n";
}

}  // namespace

Result<ReportAnswer> make_report(const ReportRequest& request, const FitControl& control) {
  const auto start = std::chrono::steady_clock::now();
  if (const Status gnuplot = find_gnuplot(); !gnuplot) return gnuplot.error();
  // The folder is created before the fits, so that an error of it is reported at once.
  auto folder = ReportFolder::create(request.out, request.force);
  if (!folder) return folder.error();
  const auto recordings = split_recordings(request.train, request.test);
  if (!recordings) return recordings.error();
  const auto data = measure(*recordings, request.scene, request.quick, control.part(0.0, kMeasuringShare));
  if (!data) return data.error();
  const std::string words = answer(*data);
  const std::vector<Table> tables = make_tables(*data);
  const std::vector<Figure> figures = make_figures(*data);
  const std::string machine =
      processor() + ", " + std::to_string(std::max(1U, std::thread::hardware_concurrency())) + " cores";
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string origin = request.command_line + " · " + request.version + ", " + kCompiler + " · " + machine +
                             " · " + three_digits(seconds) + " s";
  const OrderedJson json = report_json(*data, request, words, tables, figures, machine, seconds);
  std::vector<std::string> tests;
  for (const RecordingOffset& one : data->tested) tests.push_back(one.name);
  const Status written = write_report(*folder, "page.html", tables, figures,
                                      {{"title", escape_html(joined(tests))},
                                       {"answer", escape_html(words)},
                                       {"headline", table_html(headline_table(*data))},
                                       {"notes", notes_html(*data)},
                                       {"learnt", learnt_html(*data)},
                                       {"origin", escape_html(origin)}},
                                      json, control);
  if (!written) return written.error();
  return ReportAnswer{table_text(headline_table(*data)), words};
}

}  // namespace palpate
