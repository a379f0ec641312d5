#include "scenes/plot/plot.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// Mantissas of tics on a logarithmic axis, from coarse to fine.
const std::vector<std::vector<double>> kLogSteps{
    {1.0}, {1.0, 3.0}, {1.0, 2.0, 5.0}, {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}};

std::vector<double> decade_tics(const AxisRange& range, const std::vector<double>& steps, int every) {
  std::vector<double> tics;
  for (int decade = static_cast<int>(std::floor(std::log10(range.low))); std::pow(10.0, decade) <= range.high;
       ++decade) {
    if (decade % every != 0) continue;
    for (const double step : steps) {
      const double at = step * std::pow(10.0, decade);
      if (at >= range.low * 0.999 && at <= range.high * 1.001) tics.push_back(at);
    }
  }
  return tics;
}

// The position of `value` on the axis: 0 at its low end, 1 at its high end.
double fraction_of(const Axis& axis, const AxisRange& range, double value) {
  if (!axis.logarithmic) return (value - range.low) / (range.high - range.low);
  return std::log(value / range.low) / std::log(range.high / range.low);
}

const PlotRow* last_point(const Series& series) {
  for (auto row = series.rows.rbegin(); row != series.rows.rend(); ++row)
    if (std::isfinite(row->y)) return &*row;
  return nullptr;
}

// Moves names beside the panel up and down as little as possible, so that they are a line apart. Those of levels, which
// are at lines across the panel, stay. With y_i = i line + z_i this is isotonic regression of z.
void spread(std::vector<NameTag>& names, double line) {
  std::ranges::stable_sort(names, {}, &NameTag::y);
  struct Block {
    double mean, weight;
    std::size_t names;
  };
  std::vector<Block> blocks;  // pool adjacent violators
  for (std::size_t i = 0; i < names.size(); ++i) {
    blocks.push_back({names[i].y - static_cast<double>(i) * line, names[i].colour == kMutedColour ? 1e3 : 1.0, 1});
    while (blocks.size() > 1 && blocks.back().mean < (blocks.end() - 2)->mean) {
      const Block last = blocks.back();
      blocks.pop_back();
      Block& joined = blocks.back();
      joined.mean = (joined.weight * joined.mean + last.weight * last.mean) / (joined.weight + last.weight);
      joined.weight += last.weight;
      joined.names += last.names;
    }
  }
  const double most = std::max(0.0, 1.0 - line * (static_cast<double>(names.size()) - 1.0));
  std::size_t i = 0;
  for (const Block& block : blocks)
    for (std::size_t k = 0; k < block.names; ++k, ++i)
      names[i].y = std::clamp(block.mean, 0.0, most) + static_cast<double>(i) * line;
}

// A bar of a point, or a level across the panel; fractions of the panel.
struct Segment {
  double x_low, x_high, y_low, y_high;
};

// Moves names from their points into one of the quadrants between the bars, to the right or left of the point and above
// or below it: where a name covers the fewest other names and segments, and is nearest to its own point.
void place_beside(std::vector<NameTag>& names, const std::vector<Segment>& segments, double line, double character) {
  const std::vector<NameTag> points = names;
  const auto begin_of = [&](const NameTag& name) {
    return name.begins_here ? name.x : name.x - character * static_cast<double>(name.text.size() + 1);
  };
  const auto cost_of = [&](const NameTag& trial, std::size_t own, std::size_t placed) {
    const double width = character * static_cast<double>(trial.text.size() + 1);
    const double begin = begin_of(trial), end = begin + width;
    // In lines; a line is about twice as high as a letter is wide.
    const auto distance = [&](const NameTag& point) {
      const double beside = std::max({0.0, begin - point.x, point.x - end}) / (2.0 * character);
      return std::hypot(beside, std::max(0.0, std::abs(point.y - trial.y) / line - 0.5));
    };
    double cost = 0.6 * std::abs(trial.y - points[own].y) / line;
    if (begin < 0.0 || end > 1.0 || trial.y < 0.5 * line || trial.y > 1.0 - 0.5 * line) cost += 100.0;
    for (const Segment& one : segments) {
      const bool beside = one.x_high < begin - 0.5 * character || one.x_low > end;
      if (!beside && one.y_high > trial.y - 0.5 * line && one.y_low < trial.y + 0.5 * line) cost += 1.0;
    }
    bool misleads = false;  // another point is as near
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (k == own) continue;
      misleads = misleads || distance(points[k]) < distance(points[own]) + 0.3;
      const double other = begin_of(names[k]),
                   other_end = other + character * static_cast<double>(names[k].text.size() + 1);
      if (k < placed && other < end && begin < other_end && std::abs(names[k].y - trial.y) < line) cost += 20.0;
    }
    return misleads ? cost + 6.0 : cost;
  };
  // Each name is placed among those before it, then twice more among all.
  for (std::size_t turn = 0; turn < 3 * names.size(); ++turn) {
    const std::size_t i = turn % names.size();
    double least = std::numeric_limits<double>::infinity();
    NameTag chosen = names[i];
    for (const double lines : {0.0, 0.7, -0.7, 1.2, -1.2, 1.7, -1.7, 2.3, -2.3, 3.0, -3.0}) {
      for (const bool right : {true, false}) {
        NameTag trial = points[i];
        trial.y += lines * line;
        trial.begins_here = right;
        const double cost = cost_of(trial, i, turn < names.size() ? i : names.size());
        if (cost >= least) continue;
        least = cost;
        chosen = trial;
      }
    }
    names[i] = chosen;
  }
}

}  // namespace

AxisRange range_of(const Panel& panel, bool vertical) {
  const Axis& axis = vertical ? panel.y : panel.x;
  AxisRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto include = [&](double value) {
    if (!std::isfinite(value) || (axis.logarithmic && value <= 0.0)) return;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  };
  for (const Series& series : panel.series) {
    for (const PlotRow& row : series.rows) {
      include(vertical ? row.y : row.x);
      include(vertical ? row.low : row.left);
      include(vertical ? row.high : row.right);
    }
  }
  for (const Level& level : panel.levels)
    if (level.vertical != vertical) include(level.value);
  if (!(range.low <= range.high)) range = axis.logarithmic ? AxisRange{0.1, 10.0} : AxisRange{0.0, 1.0};
  if (axis.logarithmic) {
    range.low /= 1.25;
    range.high *= 1.25;
  } else {
    const double room = 0.04 * (range.high - range.low) + (range.high == range.low ? 0.5 : 0.0);
    range.low = range.low >= 0.0 && range.low < 0.3 * range.high ? 0.0 : range.low - room;
    range.high += room;
  }
  if (std::isfinite(axis.low)) range.low = axis.low;
  if (std::isfinite(axis.high)) range.high = axis.high;
  return range;
}

std::vector<double> log_tics(const AxisRange& range, std::size_t most) {
  std::vector<double> decades = decade_tics(range, kLogSteps.front(), 1);
  for (int every = 2; decades.size() > most; ++every) decades = decade_tics(range, kLogSteps.front(), every);
  if (decades.size() >= 3) return decades;
  std::vector<double> two = decades.size() == 2 ? decades : std::vector<double>{range.low, range.high};
  for (const std::vector<double>& steps : kLogSteps) {
    std::vector<double> tics = decade_tics(range, steps, 1);
    if (tics.size() >= 3 && tics.size() <= std::max<std::size_t>(most, 5)) return tics;
    if (tics.size() == 2) two = std::move(tics);
  }
  return two;
}

std::vector<NameTag> name_tags(const Panel& panel, double line, double character) {
  const AxisRange x = range_of(panel, false);
  const AxisRange y = range_of(panel, true);
  std::vector<NameTag> tags;
  for (const Level& level : panel.levels)
    if (!level.vertical) tags.push_back({level.text, kMutedColour, 1.0, fraction_of(panel.y, y, level.value), true});
  std::vector<NameTag> points;
  std::vector<Segment> segments;
  for (const NameTag& level : tags) segments.push_back({0.0, 1.0, level.y, level.y});
  for (const Series& series : panel.series) {
    const PlotRow* last = last_point(series);
    if (!panel.names_at_ends || series.name.empty() || series.mark == Mark::area || last == nullptr) continue;
    const bool ends = series.rows.size() > 1;
    if (!ends) {
      const auto at = [&](const Axis& axis, const AxisRange& range, double value, double otherwise) {
        return fraction_of(axis, range, std::isfinite(value) ? value : otherwise);
      };
      const double middle_x = fraction_of(panel.x, x, last->x), middle_y = fraction_of(panel.y, y, last->y);
      segments.push_back(
          {at(panel.x, x, last->left, last->x), at(panel.x, x, last->right, last->x), middle_y, middle_y});
      segments.push_back({middle_x, middle_x, at(panel.y, y, last->low, last->y), at(panel.y, y, last->high, last->y)});
    }
    (ends ? tags : points)
        .push_back({series.name, series.colour, ends ? 1.0 : fraction_of(panel.x, x, last->x),
                    std::clamp(fraction_of(panel.y, y, last->y), 0.0, 1.0), ends});
  }
  spread(tags, line);
  place_beside(points, segments, line, character);
  tags.insert(tags.end(), points.begin(), points.end());
  return tags;
}

std::vector<Series> cut_marks(const Panel& panel) {
  std::vector<Series> marks;
  for (const Series& series : panel.series) {
    if (series.mark != Mark::line && series.mark != Mark::dashed) continue;
    Series up{"", series.colour, Mark::up, {}};
    Series down{"", series.colour, Mark::down, {}};
    const PlotRow* highest = nullptr;  // of the current stretch beyond the edge
    const auto close = [&] {
      if (highest == nullptr) return;
      const bool above = highest->y > panel.y.high;
      (above ? up : down).rows.push_back({highest->x, above ? panel.y.high : panel.y.low});
      highest = nullptr;
    };
    for (const PlotRow& row : series.rows) {
      const bool beyond = row.y > panel.y.high || row.y < panel.y.low;  // always false on an axis without limits
      if (!beyond) close();
      if (beyond && (highest == nullptr || std::abs(row.y) > std::abs(highest->y))) highest = &row;
    }
    close();
    if (!up.rows.empty()) marks.push_back(std::move(up));
    if (!down.rows.empty()) marks.push_back(std::move(down));
  }
  return marks;
}

}  // namespace palpate
