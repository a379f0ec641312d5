// The worst seconds: the difference from the measured force inside the JND band, a strip
// a method, and what the tool did there.
#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/report/figures/figures.h"
#include "scenes/report/measure/trace_finder.h"

namespace palpate {
namespace {

constexpr std::size_t kTracePoints = 900;  // more than pixels are of no use
constexpr double kRetreat_m_per_s = 0.02;
constexpr double kFirstTouch_s = 0.1;

// The main models whose forces are drawn in one strip.
struct Strip {
  std::string label;
  double colour = 0.0;
  std::vector<std::size_t> models;  // the paper's first, Palpate's last
};

std::vector<Strip> strips_of(const ReportData& data) {
  std::vector<Strip> strips;
  for (const Method* method : methods()) {
    Strip strip;
    for (std::size_t i = 0; i < main_models(data); ++i) {
      const PlannedModel& plan = data.models[i].plan;
      if (plan.rung == Rung::no_force || plan.request.method != method) continue;
      strip.label = model_label(plan);
      strip.colour = model_colour(plan);
      strip.models.push_back(i);
    }
    if (!strip.models.empty()) strips.push_back(std::move(strip));
  }
  return strips;
}

double ratio(const ReportData& data, const TraceRow& row, std::size_t model) {
  return (static_cast<double>(row.force_N[model]) - row.measured_N) / data.jnd.at(row.measured_N);
}

// One row a group: the one with the largest error of any drawn model, so that a single
// bad sample stays in the picture.
std::vector<TraceRow> fewer(const ReportData& data, const std::vector<Strip>& strips) {
  const std::vector<TraceRow>& rows = data.trace.rows;
  const std::size_t group = rows.size() / kTracePoints + 1;
  std::vector<TraceRow> kept;
  const auto error = [&](const TraceRow& row) {
    double worst = 0.0;
    for (const Strip& strip : strips) {
      if (row.in_contact) worst = std::max(worst, std::abs(ratio(data, row, strip.models.back())));
    }
    return worst;
  };
  for (std::size_t first = 0; first < rows.size(); first += group) {
    std::size_t best = first;
    for (std::size_t i = first; i < std::min(rows.size(), first + group); ++i) {
      if (error(rows[i]) > error(rows[best])) best = i;
    }
    kept.push_back(rows[best]);
  }
  return kept;
}

// What the tool did where the last main model is beyond the JND.
std::string what_happened(const ReportData& data) {
  const std::vector<TraceRow>& rows = data.trace.rows;
  const std::size_t model = main_models(data) - 1;
  std::map<std::string, std::size_t> reasons;
  std::size_t beyond = 0;
  double touched_s = -1e300;
  bool was_in_contact = true;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const TraceRow& row = rows[i];
    if (row.in_contact && !was_in_contact) touched_s = row.time_s;
    was_in_contact = row.in_contact;
    if (!row.in_contact || std::abs(ratio(data, row, model)) <= 1.0) continue;
    ++beyond;
    const std::size_t before = i >= 10 ? i - 10 : 0;
    const double velocity = (row.position_m - rows[before].position_m) / (row.time_s - rows[before].time_s);
    if ((row.out_of_domain >> model & 1U) != 0) ++reasons["the tool was outside the training data"];
    else if (row.time_s - touched_s < kFirstTouch_s) ++reasons["the tool had just touched the surface"];
    else if (velocity < -kRetreat_m_per_s) ++reasons["the tool was going back fast"];
    else if (velocity > kRetreat_m_per_s) ++reasons["the tool was going in fast"];
    else ++reasons["the tool was nearly still"];
  }
  const std::string& name = data.models[model].plan.name;
  if (beyond == 0) return "Even here " + name + " stays within the JND.";
  std::vector<std::pair<std::size_t, std::string>> order;
  for (const auto& [reason, count] : reasons) order.emplace_back(count, reason);
  std::sort(order.rbegin(), order.rend());
  std::string text = "Where " + name + " leaves the band ";
  for (std::size_t i = 0; i < std::min<std::size_t>(order.size(), 3); ++i) {
    text += (i == 0 ? "" : ", in ") + (i == 0 ? "in " : std::string()) +
            fixed(100.0 * static_cast<double>(order[i].first) / static_cast<double>(beyond), 0) + " % of the samples " +
            order[i].second;
  }
  return text + ".";
}

}  // namespace

Figure trace_figure(const ReportData& data) {
  Figure figure;
  figure.name = "worst_trace";
  const std::vector<TraceRow>& rows = data.trace.rows;
  const double length_s = rows.empty() ? 0.0 : rows.back().time_s - rows.front().time_s;
  const bool five = length_s > 0.95 * TraceFinder::kTraceSeconds;
  figure.title = std::string("The worst ") + (five ? std::string("five") : fixed(length_s, 2)) + " seconds";
  const std::vector<Strip> strips = strips_of(data);
  figure.caption = "Of " + data.trace.recording + ", where the models err most. Top: the measured force. Below: how far "
                   "each model's force is from it, in JNDs; in the grey band a hand cannot tell. Strong: Palpate; "
                   "thin: the paper's recipe. " + (rows.empty() || strips.empty() ? "" : what_happened(data));
  Table table{"worst_trace", "", false, {{"time_s", ""}, {"depth_mm", ""}, {"force_N", ""}}, {}};
  for (const Strip& strip : strips) {
    for (const std::size_t model : strip.models) table.columns.push_back({data.models[model].plan.name, ""});
  }
  double largest = 1.0;
  double from_s = 0.0;
  double to_s = 1.0;
  const std::vector<TraceRow> kept = fewer(data, strips);
  for (const TraceRow& row : kept) {
    std::vector<TableCell> line{row.time_s, 1e3 * row.position_m, row.measured_N};
    for (const Strip& strip : strips) {
      for (const std::size_t model : strip.models) {
        line.emplace_back(row.in_contact ? ratio(data, row, model) : kNoNumber);
        if (row.in_contact && model == strip.models.back()) largest = std::max(largest, std::abs(ratio(data, row, model)));
      }
    }
    table.rows.push_back(std::move(line));
  }
  if (!kept.empty()) {
    from_s = kept.front().time_s;
    to_s = kept.back().time_s;
  }
  Table legend{"worst_trace_strips", "", false, {{"strip", ""}, {"label", ""}, {"colour", ""}, {"first_column", ""}, {"last_column", ""}}, {}};
  std::uint64_t column = 4;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const std::uint64_t last = column + strips[i].models.size() - 1;
    legend.rows.push_back({static_cast<std::uint64_t>(i), strips[i].label, strips[i].colour, column, last});
    column = last + 1;
  }
  figure.width = 760;
  figure.height = 130 + 62 * static_cast<int>(strips.size());
  figure.data = {std::move(table), std::move(legend)};
  figure.set_number("strips", static_cast<double>(strips.size()));
  figure.set_number("from_s", from_s);
  figure.set_number("to_s", to_s);
  figure.set_number("limit", std::min(std::max(1.6, 1.1 * largest), 5.0));
  return figure;
}

}  // namespace palpate
