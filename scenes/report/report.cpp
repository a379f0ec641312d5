#include "scenes/report/report.h"

#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "scenes/scene/gnuplot.h"
#include "scenes/report/page/report_folder.h"
#include "scenes/report/measure/model_facts.h"
#include "scenes/report/measure/run_methods.h"
#include "scenes/report/page/tables.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr double kRecordingShare = 0.02;
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

ReportOrigin origin_of(const ReportRequest& request) {
  ReportOrigin origin;
  origin.command_line = request.command_line;
  origin.version = request.version;
  origin.machine = processor() + ", " + std::to_string(std::max(1U, std::thread::hardware_concurrency())) + " cores";
#if defined(__clang__)
  origin.compiler = "clang " __clang_version__;
#else
  origin.compiler = "g++ " __VERSION__;
#endif
  return origin;
}

// The first svg's own words: "gnuplot 5.4 patchlevel 4".
std::string gnuplot_version(const std::string& svg) {
  const std::string start = "Produced by GNUPLOT ";
  const std::size_t at = svg.find(start);
  if (at == std::string::npos) return "gnuplot";
  std::string version = svg.substr(at + start.size(), svg.find('<', at) - at - start.size());
  while (!version.empty() && version.back() == ' ') version.pop_back();
  return "gnuplot " + version;
}

OrderedJson recipes_json(const ReportRecipe& recipe) {
  OrderedJson object = OrderedJson::object();
  if (recipe.paper) object["paper"] = {{"reduction", "force"}, {"weighting", "relative"}, {"kernel", kernel_name(recipe.kernel)}};
  if (recipe.palpate) {
    object["palpate"] = {{"reduction", reduction_name(recipe.reduction)},
                         {"weighting", weighting_name(recipe.weighting)},
                         {"features", recipe.features},
                         {"kernel", kernel_name(recipe.kernel)}};
  }
  return object;
}

OrderedJson recommendation_json(const Recommendation& choice) {
  return {{"recommended", choice.recommended.empty() ? OrderedJson(nullptr) : OrderedJson(choice.recommended)},
          {"chosen", choice.chosen},
          {"on_left_out_strokes", choice.left_out},
          {"tied", choice.tied},
          {"reason", choice.reason}};
}

// All numbers. "timings" holds all that differs from run to run.
OrderedJson report_json(const ReportData& data, const ReportOrigin& origin, const std::vector<Table>& tables,
                 const std::vector<Figure>& figures, const ReportPlan& plan) {
  OrderedJson numbers = OrderedJson::object();
  OrderedJson times = OrderedJson::object();
  for (const Table& table : tables) (table.has_times ? times : numbers)[table.name] = table_json(table);
  OrderedJson list = OrderedJson::array();
  for (const Figure& figure : figures) {
    list.push_back({{"name", figure.name}, {"title", figure.title}, {"has_times", figure.has_times}});
  }
  return {{"format", "palpate-report"},
          {"version", 1},
          {"scene", data.scene},
          {"jnd", {{"offset_N", data.jnd.offset_N}, {"weber_fraction", data.jnd.weber_fraction}}},
          {"quick", data.quick},
          {"virtual_recordings", data.virtual_recordings},
          {"folds", data.folds},
          {"recipes", recipes_json(plan.recipe)},
          {"recommendation", recommendation_json(data.recommendation)},
          {"surface_offset_m", data.surface_offset_m},
          {"relaxation_times_s", data.relaxation_times},
          {"seeds", plan.seeds},
          {"findings", findings(data, false)},
          {"tables", numbers},
          {"figures", list},
          {"timings",
           {{"machine", origin.machine},
            {"seconds", origin.seconds},
            {"findings", findings(data, true)},
            {"tables", times}}},
          {"program", {{"version", origin.version}, {"compiler", origin.compiler}, {"gnuplot", origin.gnuplot}}},
          {"command_line", origin.command_line}};
}

Result<std::map<std::string, std::string>> draw(const ReportFolder& folder, const std::string& gnuplot,
                                                const std::vector<Figure>& figures) {
  const auto files = figure_files(figures);
  if (!files) return files.error();
  for (const auto& [name, text] : *files) {
    if (const Status status = folder.write("figures/" + name, text); !status) return status.error();
  }
  std::vector<std::string> scripts;
  for (const Figure& figure : figures) scripts.push_back(figure.name + ".gp");
  if (const Status status = run_gnuplot(gnuplot, folder.path_of("figures"), scripts); !status) return status.error();
  std::map<std::string, std::string> svgs;
  for (const Figure& figure : figures) {
    const auto svg = folder.read("figures/" + figure.name + ".svg");
    if (!svg) return svg.error();
    svgs[figure.name] = *svg;
  }
  return svgs;
}

std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), folder, ignored).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

Result<ReportSummary> make_report(const ReportRequest& request, const FitControl& control) {
  const auto start = std::chrono::steady_clock::now();
  const auto gnuplot = find_gnuplot();
  if (!gnuplot) return gnuplot.error();
  const auto scene = load_scene(request.scene);
  if (!scene) return scene.error();
  // A folder that cannot be written is told now and not after minutes.
  auto folder = ReportFolder::create(request.out, request.force);
  if (!folder) return folder.error();

  const auto recordings = load_recordings(request.train, request.test, scene->jnd,
                                          [&](double share) { return control.may_continue(kRecordingShare * share); });
  if (!recordings) return recordings.error();
  const ReportPlan plan = make_plan(request.quick, scene->features.size(), request.recipe);
  FitControl measuring;
  measuring.progress = [&](double fraction) {
    return control.may_continue(kRecordingShare + (kMeasuringShare - kRecordingShare) * fraction);
  };
  auto data = run_methods(*recordings, *scene, plan, measuring);
  if (!data) return data.error();
  data->quick = request.quick;
  add_model_facts(*data);
  // Some seconds, and the same for everybody: not for a quick report.
  if (!request.quick) data->hard_cases = hard_case_table(run_hard_cases());

  const std::vector<Table> tables = make_tables(*data);
  for (const Table& table : tables) {
    if (const Status status = folder->write("tables/" + table.name + ".csv", table_csv(table)); !status) {
      return status.error();
    }
  }
  const std::vector<Figure> figures = make_figures(*data);
  const auto svgs = draw(*folder, *gnuplot, figures);
  // Ctrl-C at a terminal ends gnuplot as well: that is no trouble of gnuplot's.
  if (!control.may_continue(0.99)) return interrupted();
  if (!svgs) return svgs.error();

  ReportOrigin origin = origin_of(request);
  origin.gnuplot = gnuplot_version(svgs->begin()->second);
  origin.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const OrderedJson numbers = report_json(*data, origin, tables, figures, plan);
  // Names of recordings need not be UTF-8; what cannot be said is replaced.
  const std::string json = numbers.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
  if (const Status status = folder->write("report.json", json); !status) return status.error();
  const auto page = make_page(*data, origin, tables, figures, *svgs);
  if (!page) return page.error();
  if (const Status status = folder->write("index.html", *page); !status) return status.error();
  if (!control.may_continue(1.0)) return interrupted();
  if (const Status status = folder->commit(); !status) return status.error();

  ReportSummary summary;
  summary.findings = findings(*data, false);
  for (std::string& sentence : findings(*data, true)) summary.findings.push_back(std::move(sentence));
  summary.files = files_in(request.out);
  return summary;
}

}  // namespace palpate
