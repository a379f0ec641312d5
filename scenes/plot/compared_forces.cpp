#include "scenes/plot/compared_forces.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr std::size_t kMostMoments = 3000;
// The difference's axis reaches at least to the first, and beyond the second only for the first model.
constexpr double kLeastScale_jnd = 1.6;
constexpr double kMostScale_jnd = 5.0;

bool same_rows(const Series& one, const Series& other) {
  return std::ranges::equal(one.rows, other.rows, [](const PlotRow& a, const PlotRow& b) {
    return a.y == b.y || (std::isnan(a.y) && std::isnan(b.y));
  });
}

}  // namespace

void merge_equal(std::vector<Series>& series) {
  for (std::size_t i = series.size(); i-- > 0;) {
    for (std::size_t k = 0; k < i; ++k) {
      if (series[k].mark == Mark::area || !same_rows(series[i], series[k])) continue;
      series[k].name += ", " + series[i].name;
      series.erase(series.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
  }
}

std::vector<Panel> compared_forces(const std::string& title, const std::vector<ComparedModel>& models,
                                   const std::vector<ComparedMoment>& moments) {
  const auto over_jnd = [&](const ComparedMoment& moment, std::size_t model) {
    if (!moment.in_contact) return kNoValue;
    return (moment.force_N[model] - moment.measured_N) / models[model].jnd.at(moment.measured_N);
  };
  const auto worst_of = [&](const ComparedMoment& moment) {
    double worst = -1.0;
    for (std::size_t i = 0; i < models.size(); ++i) worst = std::max(worst, std::abs(over_jnd(moment, i)));
    return worst;
  };
  Panel force;
  Panel difference;
  force.title = title;
  force.y.title = "Force [N]";
  difference.x.title = "Time [s]";
  difference.y.title = "Difference [JND]";
  for (Panel* panel : {&force, &difference}) {
    panel->names_at_ends = true;
    panel->x.low = moments.front().time_s;
    panel->x.high = moments.back().time_s;
  }
  force.series = {{"measured", kMeasuredColour, Mark::line, {}}};
  difference.series = {{"within 1 JND", kMutedColour, Mark::area, {}}};
  for (std::size_t i = models.size(); i-- > 0;) {
    for (Panel* panel : {&force, &difference}) panel->series.push_back(models[i].curve);
  }
  double largest = kLeastScale_jnd, of_first = 0.0;
  const std::size_t group = moments.size() / kMostMoments + 1;
  for (std::size_t begin = 0; begin < moments.size(); begin += group) {
    const auto first = moments.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = moments.begin() + static_cast<std::ptrdiff_t>(std::min(begin + group, moments.size()));
    const ComparedMoment& shown = *std::ranges::max_element(first, last, {}, worst_of);
    largest = std::max(largest, 1.1 * worst_of(shown));
    force.series[0].rows.push_back({shown.time_s, shown.measured_N});
    difference.series[0].rows.push_back({shown.time_s, 0.0, -1.0, 1.0});
    for (std::size_t i = 0; i < models.size(); ++i) {
      const double over = over_jnd(shown, i);
      if (i == 0) of_first = std::max(of_first, 1.1 * std::abs(over));
      force.series[models.size() - i].rows.push_back({shown.time_s, shown.force_N[i]});
      difference.series[models.size() - i].rows.push_back({shown.time_s, over});
    }
  }
  difference.y.high = std::min(largest, std::max(kMostScale_jnd, of_first));
  difference.y.low = -difference.y.high;
  merge_equal(force.series);
  merge_equal(difference.series);
  return {std::move(force), std::move(difference)};
}

}  // namespace palpate
