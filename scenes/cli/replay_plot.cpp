#include "scenes/cli/replay_plot.h"

#include <algorithm>
#include <cmath>

#include "scenes/plot/draw.h"
#include "scenes/scene/method_look.h"

namespace palpate::cli {
namespace {

constexpr std::size_t kMostMoments = 3000;
constexpr double kLeastScale_jnd = 1.6;
constexpr double kMostScale_jnd = 5.0;

}  // namespace

void ReplayPlot::add(const RecordingRow& row, const TickSnapshot& snapshot) {
  Moment moment{row.time_s, row.force_N, snapshot.in_contact, {}};
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const JndLine& jnd = models_[i].model->data().jnd;
    moment.over_jnd.push_back(static_cast<float>((snapshot.force_N[i] - row.force_N) / jnd.at(row.force_N)));
  }
  moments_.push_back(std::move(moment));
}

Status ReplayPlot::draw(const std::string& path, const std::string& recording, const std::vector<ErrorSummary>& errors,
                        bool overwrite) const {
  Plot plot;
  plot.name = "replay";
  plot.height = 0.7;
  Panel force;
  force.title = recording;
  force.y.title = "Force [N]";
  force.series = {{"measured", kMeasuredColour, Mark::line, {}}};
  Panel difference;
  difference.y.title = "Difference [JND]";
  difference.series = {{"within 1 JND", kMutedColour, Mark::area, {}}};
  for (const LoadedModel& one : models_) {
    difference.series.push_back({one.name, method_rgb(one.model->method()), Mark::line, {}});
  }
  double largest = kLeastScale_jnd;
  const std::size_t group = moments_.size() / kMostMoments + 1;
  const auto worst_of = [](const Moment& moment) {
    float worst = 0.0F;
    for (const float over : moment.over_jnd) worst = std::max(worst, std::abs(over));
    return moment.in_contact ? static_cast<double>(worst) : -1.0;
  };
  // Of every group the moment with the largest error, so that a bad sample is seen.
  for (std::size_t first = 0; first < moments_.size(); first += group) {
    const auto begin = moments_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = moments_.begin() + static_cast<std::ptrdiff_t>(std::min(first + group, moments_.size()));
    const Moment& shown =
        *std::max_element(begin, end, [&](const Moment& a, const Moment& b) { return worst_of(a) < worst_of(b); });
    largest = std::max(largest, 1.1 * worst_of(shown));
    force.series[0].rows.push_back({shown.time_s, shown.measured_N});
    difference.series[0].rows.push_back({shown.time_s, 0.0, -1.0, 1.0});
    for (std::size_t i = 0; i < models_.size(); ++i) {
      const double over = static_cast<double>(shown.over_jnd[i]);
      difference.series[i + 1].rows.push_back({shown.time_s, shown.in_contact ? over : kNoValue});
    }
  }
  difference.y.high = std::min(largest, kMostScale_jnd);
  difference.y.low = -difference.y.high;
  difference.x.title = "Time [s]";
  Panel against;
  against.x.title = "Measured force [N]";
  against.y = {"Mean error + deviation", "N", true};
  Series jnd{"JND", kMutedColour, Mark::dashed, {}};
  for (std::size_t i = 0; i < models_.size(); ++i) {
    Series series{"", method_rgb(models_[i].model->method()), Mark::curve, {}};
    for (const ForceBin& bin : errors[i].bins) {
      if (bin.count > 0) series.rows.push_back({bin.mean_force_N, bin.mean_abs_error_N + bin.std_abs_error_N});
      if (i == 0) jnd.rows.push_back({0.5 * (bin.force_from_N + bin.force_to_N), bin.jnd_N});
    }
    against.series.push_back(std::move(series));
  }
  against.series.push_back(std::move(jnd));
  plot.panels = {std::move(force), std::move(difference), std::move(against)};
  return draw_plot(plot, {path}, overwrite);
}

}  // namespace palpate::cli
