#include "scenes/report/report.h"

#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <thread>

#include "scenes/report/page.h"

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
    for (const std::size_t index : models) names.push_back(data.models[index].plan.name);
    return names;
  };
  OrderedJson offsets = OrderedJson::array();
  for (const MovedSurface& one : data.tested) offsets.push_back(one.offset_m);
  return {{"format", "palpate-report"},
          {"version", 1},
          {"scene", data.scene},
          {"jnd", {{"offset_N", data.jnd.offset_N}, {"weber_fraction", data.jnd.weber_fraction}}},
          {"quick", data.quick},
          {"virtual_recordings", data.virtual_recordings},
          {"folds", data.folds},
          {"noise_floor",
           {{"force_noise_N", data.floor.force_noise_N},
            {"within_jnd", data.floor.within_jnd},
            {"p99_error_over_jnd", data.floor.p99_error_over_jnd}}},
          {"surface_offset_m", offsets},
          {"correction_off", data.choice.correction_off},
          {"relaxation_times_2009_s", data.times_2009_s},
          {"tables", numbers},
          {"figures", list},
          {"timings",
           {{"machine", machine},
            {"seconds", seconds},
            {"answer", plain_text_of(answer)},
            {"recommended", data.models[data.choice.recommended].plan.name},
            {"candidates", named(data.choice.candidates)},
            {"qualified", named(data.choice.qualified)},
            {"tables", times}}},
          {"program", {{"version", request.version}, {"compiler", kCompiler}}},
          {"command_line", request.command_line}};
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
  std::vector<Figure> figures{speed_figure(*data), worst_figure(*data), force_figure(*data)};
  if (const Status status = write_parts(*folder, tables, figures, control); !status) return status.error();
  const std::string machine =
      processor() + ", " + std::to_string(std::max(1U, std::thread::hardware_concurrency())) + " cores";
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string origin = request.command_line + " · " + request.version + ", " + kCompiler + " · " + machine +
                             " · " + three_digits(seconds) + " s";
  const auto page = make_page(*data, words, origin, tables, figures);
  if (!page) return page.error();
  const OrderedJson json = report_json(*data, request, words, tables, figures, machine, seconds);
  if (const Status status = publish(*folder, *page, json, control); !status) return status.error();
  return plain_text_of(words);
}

}  // namespace palpate
