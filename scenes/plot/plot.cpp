#include "scenes/plot/plot.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/base/csv_scanner.h"
#include "engine/base/text.h"
#include "engine/base/whole_file.h"
#include "scenes/scene/assets.h"

namespace palpate {
namespace {

constexpr int kPageWidth = 800;  // pixels
constexpr int kRowHeight = 230;
constexpr int kLegendLine = 20;
constexpr double kCharacter = 9.8;  // pixels, in which an offset in characters counts

std::string number(double value) { return std::isfinite(value) ? shortest(value) : "NaN"; }

// Quoted for gnuplot, which has no way to write these.
std::string quoted(const std::string& text) {
  std::string safe(1, '"');
  for (const char letter : text)
    safe += letter == '"' || letter == '\\' || letter == '\n' || letter == '`' ? '\'' : letter;
  return safe + '"';
}

std::string colour_of(Hue colour) {
  if (colour == kInkColour) return "ink";
  return colour == kMutedColour ? "muted" : std::to_string(colour);
}

std::string data_name(std::size_t panel, std::size_t series) {
  return "$panel" + std::to_string(panel) + "_" + std::to_string(series);
}

std::string data_block(const Series& series, const std::string& name) {
  std::string text = name + " << END\n";
  for (const PlotRow& row : series.rows) {
    // A row without a y breaks the line.
    const bool gap = !std::isfinite(row.y) && !std::isfinite(row.low);
    text += gap ? "\n" : number(row.x) + " " + number(row.y) + " " + number(row.low) + " " + number(row.high) + "\n";
  }
  return text + "END\n";
}

// Of a logarithmic axis: every decade is labelled; where there are few, 2 and 5 as well, and where there is
// hardly one, what lies between.
std::string log_tics(const char* axis, double low, double high) {
  const bool few = high / low < 50.0;
  const bool hardly = high / low < 5.0;
  const bool many = high / low > 1e7;
  std::string tics;
  for (int decade = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, decade) <= high; ++decade) {
    for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
      const double at = step * std::pow(10.0, decade);
      const bool wanted = step == 1.0 ? !many || decade % 2 == 0 : step == 2.0 || step == 5.0 ? few : hardly;
      if (at < low * 0.999 || at > high * 1.001 || !wanted) continue;
      tics += (tics.empty() ? "" : ", ") + number(at);
    }
  }
  return std::string("set ") + axis + "tics (" + tics + ")\n";
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
};

// Of an axis: what is asked for, and else what the data and the named lines have.
Range range_of(const Panel& panel, bool vertical, const Axis& axis) {
  Range range;
  const auto include = [&](double value) {
    if (!std::isfinite(value) || (axis.logarithmic && value <= 0.0)) return;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  };
  for (const Series& series : panel.series) {
    for (const PlotRow& row : series.rows) {
      include(vertical ? row.y : row.x);
      if (!vertical) continue;
      include(row.low);
      include(row.high);
    }
  }
  for (const Level& level : panel.levels) {
    if (level.vertical != vertical) include(level.value);
  }
  if (!(range.low <= range.high)) range = axis.logarithmic ? Range{0.1, 10.0} : Range{0.0, 1.0};
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

std::string axis_text(const char* name, const Axis& axis, const Range& range) {
  const std::string letter(name);
  std::string text = (axis.logarithmic ? "set logscale " : "unset logscale ") + letter + "\n";
  text += "set " + letter + "range [" + number(range.low) + ":" + number(range.high) + "]\n";
  text += "set " + letter + "label " + quoted(axis.title) + "\n";
  if (!axis.logarithmic) return text + "set " + letter + "tics autofreq\nset format " + letter + " \"%g\"\n";
  // Counts of thousands and more would run into each other.
  const std::string plain = range.high < 1e4 ? "%g" : "%.0s%c";
  text += "set format " + letter + " \"" + (axis.unit.empty() ? plain : "%.0s %c" + axis.unit) + "\"\n";
  return text + log_tics(name, range.low, range.high);
}

// How a mark is drawn, a variable of style.gp, and what stands for it in the legend.
struct MarkStyle {
  const char* style;
  const char* legend;
};
constexpr MarkStyle kMarks[] = {{"line", "— "},   {"dashed", "– – "}, {"points", "● "},
                                {"hollow", "○ "}, {"curve", "● "},    {"hollow_curve", "○ "},
                                {"bars", "● "},   {"plus", "● "},     {"area", "■ "}};

const MarkStyle& style_of(const Series& series) { return kMarks[static_cast<std::size_t>(series.mark)]; }

std::string drawn_with(const Series& series) {
  const std::string hue = series.mark == Mark::area ? "" : " linecolor rgb " + colour_of(series.colour);
  return std::string(1, '@').append(style_of(series).style) + hue;
}

// A line across and its name: beside the panel, where no curve is, or at the upper end of one that stands.
std::string level_text(const Level& level) {
  const std::string at = number(level.value);
  const std::string ends = level.vertical ? " from first " + at + ", graph 0 to first " + at + ", graph 1"
                                          : " from graph 0, first " + at + " to graph 1, first " + at;
  const std::string place = level.vertical ? " at first " + at + ", graph 1 right offset character -0.5,-0.7"
                                           : " at graph 1, first " + at + " left offset character 0.5,0";
  return "set arrow" + ends + " nohead dashtype 2 linewidth 1.5 linecolor rgb muted\nset label " + quoted(level.text) +
         place + " textcolor rgb muted\n";
}

// Room for the names of the lines across, beside the panel.
int right_margin(const Panel& panel) {
  std::size_t longest = 0;
  for (const Level& level : panel.levels) longest = std::max(longest, level.vertical ? 0 : level.text.size());
  return static_cast<int>(std::max<std::size_t>(3, longest + 1));
}

std::string panel_text(const Panel& panel, std::size_t index) {
  std::string text = "set title " + quoted(panel.title) + "\n";
  text += axis_text("x", panel.x, range_of(panel, false, panel.x)) +
          axis_text("y", panel.y, range_of(panel, true, panel.y));
  text += "set rmargin " + std::to_string(right_margin(panel)) + "\n";
  for (const Level& level : panel.levels) text += level_text(level);
  std::string curves;
  for (const bool area : {true, false}) {  // grey is behind everything, so first
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
      const Series& series = panel.series[i];
      if ((series.mark == Mark::area) != area || series.rows.empty()) continue;
      curves += (curves.empty() ? "" : ", \\\n  ") + data_name(index, i) + " " + drawn_with(series);
    }
  }
  return text + "plot " + (curves.empty() ? "NaN" : curves) + "\nunset arrow\nunset label\n";
}

struct Legend {
  std::string text;  // commands that set it, for the first panel
  int lines = 0;
};

// Every name once, from left to right, on as many lines as it takes.
Legend legend_of(const Plot& plot) {
  Legend legend;
  std::set<std::string> seen;
  const int most = static_cast<int>(plot.width * kPageWidth / kCharacter);
  int column = 0;
  for (const Panel& panel : plot.panels) {
    for (const Series& series : panel.series) {
      if (series.name.empty() || !seen.insert(series.name).second) continue;
      const int length = static_cast<int>(series.name.size()) + 4;
      if (legend.lines == 0 || column + length > most) {
        ++legend.lines;
        column = 0;
      }
      legend.text += "set label " + quoted(style_of(series).legend + series.name) +
                     " at screen 0, screen 1 left offset character " + std::to_string(column + 2) + "," +
                     number(-0.9 * legend.lines) + " textcolor rgb " +
                     (series.mark == Mark::area ? "muted" : colour_of(series.colour)) + "\n";
      column += length;
    }
  }
  return legend;
}

}  // namespace

Result<std::string> plot_script(const Plot& plot) {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  const std::string path = *assets + "/figures/style.gp";
  const auto style = read_whole_file(path);
  if (!style) return Error{"cannot read " + path + ", the style of all figures; check the assets folder"};
  const Legend legend = legend_of(plot);
  const int rows = (static_cast<int>(plot.panels.size()) + plot.columns - 1) / plot.columns;
  const int height = static_cast<int>(rows * kRowHeight * plot.height) + kLegendLine * legend.lines;
  std::string text = "# gnuplot " + plot.name + ".gp draws " + plot.name + ".svg and " + plot.name + ".png here.\n";
  text += "width = " + std::to_string(static_cast<int>(plot.width * kPageWidth)) +
          "\nheight = " + std::to_string(height) + "\n" + *style;
  for (std::size_t p = 0; p < plot.panels.size(); ++p) {
    for (std::size_t s = 0; s < plot.panels[p].series.size(); ++s) {
      text += data_block(plot.panels[p].series[s], data_name(p, s));
    }
  }
  // Room for the legend: as high as the lines of a title.
  std::string room = legend.lines > 0 ? " title \" " : "";
  for (int i = 1; i < legend.lines; ++i) room += "\\n ";
  if (legend.lines > 0) room += '"';
  for (const char* medium : {"svg", "png"}) {
    text += "eval " + std::string(medium) + "\nset output '" + plot.name + "." + medium + "'\n";
    text += "set multiplot layout " + std::to_string(rows) + "," + std::to_string(plot.columns) + room + "\n";
    text += legend.text;
    for (std::size_t p = 0; p < plot.panels.size(); ++p) text += panel_text(plot.panels[p], p);
    text += "unset multiplot\nunset output\n";
  }
  return text;
}

}  // namespace palpate
