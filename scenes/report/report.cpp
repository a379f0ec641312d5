#include "scenes/report/report.h"

#include <sys/utsname.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "engine/live/pacer.h"
#include "models/model/file/model_io.h"

namespace palpate {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double kMeasuringShare = 0.93;
constexpr double kAsFast = 0.9;  // times that differ by less are as fast

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

// Another zero is named where moving the surface raises the share within the JND by more than this.
constexpr double kOtherZeroShare = 0.05;
constexpr double kStudiedUpTo_N = 2.5;  // Hoever & Harders (2009), section 4.1

// Two decimals, rounded down: 99.996 % is "99.99 %".
std::string percent(double share) { return share >= 1.0 ? "100 %" : fixed(std::floor(1e4 * share) / 100.0, 2) + " %"; }

// The force zero of a test recording, from its free air, that is farthest from 0, if it is above half a JND.
std::optional<double> large_force_zero_N(const ReportData& data) {
  double largest_N = 0.0;
  for (const TestedRecording& one : data.tested)
    if (std::abs(one.recording->surface.force_zero_N) > std::abs(largest_N))
      largest_N = one.recording->surface.force_zero_N;
  return std::abs(largest_N) > 0.5 * data.scene.jnd.at(0.0) ? std::optional(largest_N) : std::nullopt;
}

// By how much a test recording differs from the zeros of the training, as far as the data identify it; 0: not at all.
struct OtherZero {
  std::string recording;
  double force_N = 0.0, surface_m = 0.0;  // to be subtracted
};

// The test recording whose surface is farthest from the models', where that decides the figures. The force is the
// offset that explains the recording as well as the surface does.
std::optional<OtherZero> other_zero(const ReportData& data) {
  const ModelResult& use = data.models[data.choice.recommended];
  const auto farthest = std::ranges::max_element(
      data.tested, {}, [](const TestedRecording& one) { return std::abs(one.surface.minimum_at); });
  const OffsetEstimate& surface = farthest->surface;
  const bool ambiguous = std::abs(surface.force_offset_N) > data.scene.jnd.at(0.0);
  if (use.moved.within_jnd - use.errors.within_jnd < kOtherZeroShare &&
      !(ambiguous && use.errors.within_jnd < kGoodShare))
    return {};
  OtherZero found{farthest->recording->recording.name};
  // The zero of the force in free air is subtracted already.
  if (ambiguous && !farthest->recording->surface.air.found) found.force_N = surface.force_offset_N;
  if (surface.at != 0.0 || (ambiguous && (found.force_N == 0.0 || !surface.force_offset_better)))
    found.surface_m = surface.minimum_at;
  return found;
}

// "The force of TEST reads 0.18 N too high, or the surface lies 0.32 mm off; tare and test again."
std::string zero_text(const OtherZero& zero) {
  const std::string force = "force of " + zero.recording + " reads " + general(std::abs(zero.force_N), 2) + " N too " +
                            (zero.force_N > 0.0 ? "high" : "low");
  const std::string surface = "lies " + general(std::abs(1e3 * zero.surface_m), 2) + " mm off";
  if (zero.force_N == 0.0) return "The surface of " + zero.recording + " " + surface + "; set its zero and test again.";
  return "The " + force + (zero.surface_m != 0.0 ? ", or the surface " + surface : "") + "; tare and test again.";
}

// The command that corrects the zero of a test recording.
std::string zero_command(const OtherZero& zero, const ReportRequest& request) {
  std::string path = zero.recording + ".csv";
  for (const std::string& one : request.test_files)
    if (std::filesystem::path(one).stem() == zero.recording) path = one;
  return "palpate import " + shell_word(path) +
         (zero.force_N != 0.0 ? " --tare " + general(zero.force_N, 3) : " --zero " + general(zero.surface_m, 3)) +
         " --out " + shell_word(zero.recording + "_zeroed.csv");
}

// The answer of a report, which page, report.json and terminal show: one line.
std::string answer(const ReportData& data) {
  if (const auto zero = other_zero(data)) return zero_text(*zero);
  const ModelResult& use = data.models[data.choice.recommended];
  std::string sentence = recommendation(use.name, use.candidate());
  if (const auto zero_N = large_force_zero_N(data)) {
    sentence.pop_back();
    return sentence + "; forces count from its free air, " + general(*zero_N, 2) + " N.";
  }
  return sentence + (use.errors.within_jnd >= kGoodShare ? " Confirm on another recording." : "");
}

// What is said of a model beside the recommended one.
std::string compared(const ModelResult& one) {
  return one.name + ", " + share_text(one.errors.within_jnd) + " within one JND, 99 % error " +
         general(one.errors.p99_error_over_jnd, 2) + " JND, " + tick_text(one.time.tick.median_ns);
}

// The lines below the answer: what else the rule says, and the next command.
std::vector<std::string> details(const ReportData& data, const ReportRequest& request) {
  const Ranking& choice = data.choice;
  const ModelResult& use = data.models[choice.recommended];
  std::vector<std::string> lines;
  if (const auto zero = other_zero(data)) {
    lines.push_back("Correct its zero: " + zero_command(*zero, request));
    lines.push_back("As recorded: " + recommendation(use.name, use.candidate()) + " With the surface aligned, which " +
                    "uses the forces of the test: " + share_text(use.moved.within_jnd) + ".");
  }
  if (use.untared.samples > 0)
    lines.push_back("With the forces as recorded, whose zero in free air is not subtracted: " +
                    share_text(use.untared.within_jnd) + " within one JND.");
  const auto tick_ns = [](const ModelResult& one) { return one.time.tick.median_ns; };
  if (std::all_of(data.models.begin() + 1, data.models.end(),
                  [&](const ModelResult& one) { return tick_ns(one) > data.budget_ns; }))
    lines.push_back("No tick is within the budget of " + tick_text(data.budget_ns) + ", so that it excludes none.");
  const std::size_t strokes = use.errors.drawn_strokes.units;
  if (strokes < kLeastUnits)
    lines.push_back("The test has " + std::to_string(strokes) + (strokes == 1 ? " stroke" : " strokes") +
                    ", too few for an interval: the figures decide as they are.");
  if (const ModelResult& best = data.models[choice.best]; choice.best != choice.recommended) {
    const bool close = best.errors.within_jnd - use.errors.within_jnd < kLeastShare &&
                       (use.errors.within_jnd < kManyWithin ||
                        use.errors.p99_error_over_jnd - best.errors.p99_error_over_jnd < kLeastDifference_jnd);
    lines.push_back(
        (close ? "As good"
               : "With better figures, which " + std::to_string(strokes) + " strokes do not tell from these") +
        (kAsFast * tick_ns(best) < tick_ns(use) ? ", and as fast within a tenth: " : ", but slower: ") +
        compared(best) + ".");
  }
  if (choice.fastest_below_jnd && tick_ns(data.models[*choice.fastest_below_jnd]) < kAsFast * tick_ns(use))
    lines.push_back(
        "The fastest whose 99 % error is below the JND: " + compared(data.models[*choice.fastest_below_jnd]) + ".");
  for (std::size_t i = 1; i < data.models.size(); ++i) {
    const ModelResult& one = data.models[i];
    const std::string family = family_name(*one.plan);
    if (family != family_name(ModelPlan{}) || one.selects_size || family == family_name(*use.plan)) continue;
    lines.push_back("palpate fit without --method makes " + compared(one) +
                    (choice.as_good[i] ? "; it is as good, and " + use.name + " is faster." : "; it is worse here."));
  }
  lines.push_back("Confirm: palpate replay --recording OTHER.csv --model " + shell_word(request.out + "/model.json"));
  return lines;
}

// All numbers of the report. Those that differ from run to run are in "timings".
OrderedJson report_json(const ReportData& data, const ReportRequest& request, const std::vector<Table>& tables,
                        const std::vector<Plot>& figures, const std::string& machine, double seconds) {
  OrderedJson numbers = OrderedJson::object();
  OrderedJson times = OrderedJson::object();
  for (const Table& table : tables) (table.has_times ? times : numbers)[table.name] = table_json(table);
  OrderedJson list = OrderedJson::array();
  for (const Plot& figure : figures) list.push_back(figure.name);
  OrderedJson candidates = OrderedJson::array(), as_good = OrderedJson::array();
  for (std::size_t i = 1; i < data.models.size(); ++i) {
    candidates.push_back(data.models[i].name);
    if (data.choice.as_good[i]) as_good.push_back(data.models[i].name);
  }
  OrderedJson offsets = OrderedJson::array(), zeros = OrderedJson::array();
  for (const TestedRecording& one : data.tested) {
    offsets.push_back(one.surface.at);
    zeros.push_back(one.recording->surface.force_zero_N);
  }
  return {{"format", "palpate-report"},
          {"version", 1},
          {"scene", data.scene.name},
          {"jnd", {{"offset_N", data.scene.jnd.offset_N}, {"weber_fraction", data.scene.jnd.weber_fraction}}},
          {"quick", request.quick},
          {"virtual_recordings", request.train.empty()},
          {"folds", data.recordings.folds.size() > 1 ? data.recordings.folds.size() : 0},
          {"noise_floor",
           {{"force_noise_N", data.floor.known ? OrderedJson(data.floor.force_noise_N) : OrderedJson()},
            {"within_jnd", data.floor.within_jnd},
            {"p99_error_over_jnd", data.floor.known ? OrderedJson(data.floor.p99_error_over_jnd) : OrderedJson()}}},
          {"surface_offset_m", offsets},
          {"force_zero_N", zeros},
          {"correction_used", data.corrects},
          {"relaxation_papers_times_s", data.papers_times_s},
          {"tables", numbers},
          {"figures", list},
          {"timings",
           {{"machine", machine},
            {"seconds", seconds},
            {"answer", answer(data)},
            {"details", details(data, request)},
            {"recommended", data.models[data.choice.recommended].name},
            {"candidates", candidates},
            {"best", data.models[data.choice.best].name},
            {"as_good", as_good},
            {"tables", times}}},
          {"program", {{"version", request.version}, {"compiler", kCompiler}}},
          {"command_line", request.command}};
}

// How far the 95 % bound of the recommended model holds.
std::string bound_note(const ModelResult& use) {
  if (!use.errors.bound.has_bounds()) return use.name + " gives no error bound.";
  return "The 95 % bound of " + use.name + " holds for " + percent(use.errors.bound.coverage) +
         " of the samples as recorded, " + percent(use.moved.bound.coverage) +
         " with the surface moved; its median is " +
         (std::isfinite(use.errors.bound.median_over_jnd) ? three_digits(use.errors.bound.median_over_jnd) + " JND"
                                                          : "not known: it exceeds the largest force") +
         ".";
}

// Notes on how the numbers of the first screen were obtained.
std::string notes_html(const ReportData& data, const ReportRequest& request) {
  std::vector<std::string> notes;
  for (const std::string& line : details(data, request)) notes.push_back(line);
  for (const ModelResult& one : data.models) {
    if (!one.same.empty()) notes.push_back("The same forces as " + one.name + ": " + joined(one.same) + ".");
  }
  notes.push_back(bound_note(data.models[data.choice.recommended]));
  const std::string& tested_on = data.recordings.folds.front().words;
  if (!tested_on.empty()) notes.push_back("No test recording: " + tested_on + ".");
  double largest_N = 0.0;
  bool accelerometer = false;
  for (const PreparedRecordingPointer& one : data.recordings.all) {
    largest_N = std::max(largest_N, largest_force_N(one->recording));
    accelerometer = accelerometer || one->recording.columns.acceleration;
  }
  const JndLine& jnd = data.scene.jnd;
  notes.push_back(jnd.offset_N == JndLine{}.offset_N && jnd.weber_fraction == JndLine{}.weber_fraction
                      ? kJndDefinition
                      : "Here one JND is " + three_digits(1e3 * jnd.offset_N) + " mN + " +
                            three_digits(100.0 * jnd.weber_fraction) + " % of the force.");
  if (largest_N > kStudiedUpTo_N)
    notes.push_back("The JND was measured up to 2.5 N; these forces go up to " + three_digits(largest_N) +
                    " N, where it is extrapolated.");
  notes.push_back(
      !data.floor.known
          ? "The errors of a perfect model could not be determined: from row to row the force of a test recording does "
            "not change as white noise does, but by motion or a filter."
          : "A perfect model would have " + percent(data.floor.within_jnd) +
                " within the JND and 99 % of its errors below " + three_digits(data.floor.p99_error_over_jnd) +
                " JND, because of the noise of the force sensor (" + three_digits(1e3 * data.floor.force_noise_N) +
                " mN, from second differences in the quietest fifth of each test recording, without drift).");
  notes.push_back(accelerometer ? "With the accelerometer of the recordings."
                                : "From positions alone, without an accelerometer.");
  return list_html(notes);
}

Table identified_table(const ReportData& data) {
  Table table;
  const auto add = [&](const std::string& what, const std::string& value) {
    table.begin_row();
    table.add({"", "identified"}, what);
    table.add({"", "value"}, value);
  };
  std::vector<std::string> features, times;
  for (const FeatureSpec& spec : data.models[data.choice.recommended].model->features())
    features.push_back(feature_name(spec).substr(std::string("feature_").size()));
  for (const double time_s : data.papers_times_s) times.push_back(three_digits(time_s));
  add("Features", joined(features));
  add("Correction by centres", data.corrects ? "used: it lowers the cross-validated error"
                                             : "not used: it does not lower the cross-validated error");
  if (!times.empty())
    add("Relaxation times of the methods on the force",
        joined(times, " and ") + " s, fitted to the training recordings");
  for (const auto& [centres, choices] : data.choices)
    add("On the force, " + (centres > 0 ? std::to_string(centres) + " centres" : "direct and voxel"),
        choices_text(choices));
  for (const auto& [base, errors] : data.by_size) {
    std::vector<std::string> sizes;
    for (const auto& [size, error] : errors)
      sizes.push_back(std::to_string(size) + ": " + three_digits(error) + " JND");
    add(std::string("Cross-validated by number of centres, on the ") + (base == Base::force ? "force" : "trend"),
        joined(sizes));
  }
  for (const RecordingOffset& surface : data.surfaces) {
    add("Surface of " + surface.name,
        fixed(1e3 * surface.offset_m, 3) + " mm" +
            (std::isfinite(surface.standard_error_m) ? " ± " + fixed(1e3 * surface.standard_error_m, 3) + " mm"
                                                     : ", not identified") +
            ", force zero " + fixed(1e3 * surface.force_zero_N, 1) + " mN");
  }
  return table;
}

// The data, the library that draws it and the script of the page; without the library the page has its figures only.
std::string curves_html(const std::string& data) {
  const std::string folder = "/usr/share/javascript/dygraphs/";
  const auto library = read_whole_file(folder + "dygraph.min.js"), style = read_whole_file(folder + "dygraph.min.css");
  const auto licence = read_whole_file("/usr/share/doc/libjs-dygraphs/copyright");
  const auto assets = find_assets();
  const auto script = read_whole_file((assets ? *assets : "") + "/report/page.js");
  if (!library || !style || !licence || !script) return {};
  return "<!-- dygraphs, from Debian's libjs-dygraphs:\n" + escape_html(*licence) + "-->\n<style>" + *style +
         "</style>\n<script>" + *library + "</script>\n<script type=\"application/json\" id=\"curves-data\">" + data +
         "</script>\n<script>" + *script + "</script>\n";
}

// The recommended model, fitted to all training recordings; a fold's model was fitted to a part of them.
Result<std::string> model_text(const ReportData& data, const ReportRequest& request, const FitControl& control) {
  const ModelResult& use = data.models[data.choice.recommended];
  const RecordingSet& set = data.recordings;
  if (set.trained < set.all.size()) return write_model_text(use.model->data());
  ModelFits fits(set.all, training_scene(request.scene));
  ModelPlan plan = *use.plan;
  if (plan.selects_centres()) plan.centres = use.size;
  auto fit = fits.fit(plan, control);
  return fit ? write_model_text(fit->model->data()) : fit.error();
}

}  // namespace

Result<ReportAnswer> make_report(const ReportRequest& request, const FitControl& control) {
  const double start_s = steady_now_s();
  if (const Status gnuplot = find_gnuplot(); !gnuplot) return gnuplot.error();
  // The folder is created before the fits, so that an error of it is reported at once.
  auto folder = ReportFolder::create(request.out, request.force);
  if (!folder) return folder.error();
  const auto recordings = split_recordings(request.train, request.test);
  if (!recordings) return recordings.error();
  const auto data = measure(*recordings, request.scene, request.quick, request.budget_ns,
                            control.part(0.0, kMeasuringShare), request.after ? &request.after->recording : nullptr);
  if (!data) return data.error();
  const std::string words = answer(*data);
  auto model = model_text(*data, request, control.part(kMeasuringShare, 0.99));
  if (!model) return model.error();
  const std::vector<Table> tables = make_tables(*data);
  const std::vector<Plot> figures = make_figures(*data);
  const std::string machine =
      processor() + ", " + std::to_string(std::max(1U, std::thread::hardware_concurrency())) + " cores";
  const double seconds = steady_now_s() - start_s;
  const OrderedJson json = report_json(*data, request, tables, figures, machine, seconds);
  std::vector<std::string> tests;
  for (const TestedRecording& one : data->tested) tests.push_back(one.recording->recording.name);
  if (const Status status = folder->write("model.json", *model); !status) return status.error();
  const Status written =
      write_report(*folder, request, "page.html", tables, figures,
                   {{"title", "Palpate report: " + escape_html(joined(tests))},
                    {"answer", escape_html(words)},
                    {"headline", table_html(headline_table(*data))},
                    {"curves", curves_html(curves_json(*data))},
                    {"notes", notes_html(*data, request)},
                    {"identified", table_html(identified_table(*data))},
                    {"origin", std::string(", ") + kCompiler + " · " + machine + " · " + three_digits(seconds) + " s"}},
                   json, control);
  if (!written) return written.error();
  return ReportAnswer{table_text(headline_table(*data)), words, details(*data, request)};
}

}  // namespace palpate
