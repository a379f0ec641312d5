#include "scenes/cli/replay_plot.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "engine/base/atomic_file.h"
#include "scenes/report/data/binned_errors.h"
#include "scenes/report/figures/figure.h"
#include "scenes/report/page/report_folder.h"
#include "scenes/scene/gnuplot.h"

namespace palpate::cli {
namespace {

constexpr std::size_t kMostMoments = 1800;  // more than pixels are of no use

std::string ending(const std::string& path) { return std::filesystem::path(path).extension().string(); }

double colour_of(const LoadedModel& model) {
  PlannedModel plan;
  if (const Method* method = find_method(model.model->method())) plan.request.method = method;
  return model_colour(plan);
}

}  // namespace

Status check_plot_path(const std::string& path, bool overwrite) {
  if (ending(path) != ".svg" && ending(path) != ".png") {
    return Error{"found --plot " + path + ", expected a file that ends in .svg or .png"};
  }
  std::error_code error;
  if (!overwrite && std::filesystem::exists(path, error)) return Error{path + " exists; pass --force to replace it"};
  return {};
}

ReplayPlot::ReplayPlot(const std::vector<LoadedModel>& models) : models_(models) {}

void ReplayPlot::add(const RecordingRow& row, const TickSnapshot& snapshot) {
  moments_.push_back({row.time_s, row.position_m, row.force_N, snapshot.in_contact});
  for (std::size_t i = 0; i < models_.size(); ++i) force_N_.push_back(static_cast<float>(snapshot.force_N[i]));
}

Status ReplayPlot::draw(const std::string& path, const std::string& recording, bool overwrite) const {
  if (const Status status = check_plot_path(path, overwrite); !status) return status;
  const auto gnuplot = find_gnuplot();
  if (!gnuplot) return gnuplot.error();
  const std::size_t count = models_.size();
  const JndLine jnd = models_.front().model->data().jnd;
  const auto ratio = [&](std::size_t moment, std::size_t model) {
    const double measured_N = moments_[moment].force_N;
    return (static_cast<double>(force_N_[moment * count + model]) - measured_N) / jnd.at(measured_N);
  };
  Figure figure;
  figure.name = "replay";
  Table trace{"replay", "", false, {{"time_s", ""}, {"depth_mm", ""}, {"force_N", ""}}, {}};
  for (const LoadedModel& model : models_) trace.columns.push_back({model.name, ""});
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::size_t group = moments_.size() / kMostMoments + 1;
  double limit = 1.6;
  // Of every group the moment with the largest error, so that a bad sample is seen.
  for (std::size_t first = 0; first < moments_.size(); first += group) {
    std::size_t worst = first;
    double largest = -1.0;
    for (std::size_t i = first; i < std::min(moments_.size(), first + group); ++i) {
      for (std::size_t m = 0; m < count && moments_[i].in_contact; ++m) {
        if (std::abs(ratio(i, m)) <= largest) continue;
        largest = std::abs(ratio(i, m));
        worst = i;
      }
    }
    limit = std::max(limit, 1.1 * largest);
    std::vector<TableCell> row{moments_[worst].time_s, 1e3 * moments_[worst].position_m, moments_[worst].force_N};
    for (std::size_t m = 0; m < count; ++m) row.emplace_back(moments_[worst].in_contact ? ratio(worst, m) : none);
    trace.rows.push_back(std::move(row));
  }
  double largest_N = 0.0;
  for (const Moment& moment : moments_) largest_N = std::max(largest_N, moment.force_N);
  Table bins{"replay_bins", "", false, {{"model", ""}, {"force_N", ""}, {"error_mN", ""}, {"colour", ""}}, {}};
  Table names{"replay_models", "", false, {{"model", ""}, {"label", ""}, {"colour", ""}}, {}};
  for (std::size_t m = 0; m < count; ++m) {
    BinnedErrors errors(jnd, largest_N);
    for (std::size_t i = 0; i < moments_.size(); ++i) {
      if (moments_[i].in_contact) errors.add(static_cast<double>(force_N_[i * count + m]), moments_[i].force_N);
    }
    for (const ErrorBin& bin : errors.bins()) {
      bins.rows.push_back({static_cast<std::uint64_t>(m), std::max(0.0, bin.mean_force_N),
                           1e3 * (bin.mean_abs_error_N + bin.std_abs_error_N), colour_of(models_[m])});
    }
    bins.rows.push_back({});
    names.rows.push_back({static_cast<std::uint64_t>(m), models_[m].name, colour_of(models_[m])});
  }
  figure.width = 900;
  figure.height = 345 + 70 * static_cast<int>(count);
  figure.set_text("title_text", recording);
  figure.set_number("models", static_cast<double>(count));
  figure.set_number("limit", std::min(limit, 5.0));
  figure.set_number("from_s", moments_.empty() ? 0.0 : moments_.front().time_s);
  figure.set_number("to_s", moments_.empty() ? 1.0 : moments_.back().time_s);
  double least_mN = 1e3 * jnd.at(0.0);
  for (const auto& row : bins.rows) {
    if (!row.empty() && row[2].number > 0.0) least_mN = std::min(least_mN, row[2].number);
  }
  figure.set_number("error_low", 0.7 * least_mN);
  figure.set_number("force_high", largest_N > 0.0 ? largest_N : 1.0);
  figure.set_number("jnd_offset_N", jnd.offset_N);
  figure.set_number("jnd_fraction", jnd.weber_fraction);
  figure.data = {std::move(trace), std::move(bins), std::move(names)};

  const auto files = figure_files({figure});
  if (!files) return files.error();
  auto folder = ReportFolder::create(path + ".parts", false);
  if (!folder) return folder.error();
  for (const auto& [name, text] : *files) {
    if (const Status status = folder->write(name, text); !status) return status;
  }
  if (const Status status = run_gnuplot(*gnuplot, folder->path_of(""), {"replay.gp"}); !status) return status;
  const auto drawn = folder->read("replay" + ending(path));
  if (!drawn) return drawn.error();
  return write_file_atomically(path, *drawn, overwrite);
}

}  // namespace palpate::cli
