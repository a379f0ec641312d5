#include "scenes/plot/plot.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>
#include <sstream>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

constexpr int kPageWidth = 800;  // pixels
constexpr int kRowHeight = 230;
constexpr double kCharacter = 9.8;  // pixels per character of an offset
// Room for the label of a tic and for a name, pixels, and the approximate share of a row's height that the panel has.
constexpr double kTicWidth = 90.0;
constexpr double kTicHeight = 28.0;
constexpr double kTagHeight = 17.0;
constexpr double kPanelShare = 0.65;

std::string number(double value) { return std::isfinite(value) ? shortest(value) : "NaN"; }

// Quotes the text for gnuplot. Characters that gnuplot cannot escape become apostrophes.
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

// Columns: x, y, the ends of the horizontal bar, the ends of the vertical bar or area. A bar that is missing has the
// length 0, and a row without a y breaks the line.
std::string data_block(const Series& series, const std::string& name) {
  const auto or_else = [](double value, double other) {
    return std::string(" ").append(number(std::isfinite(value) ? value : other));
  };
  std::string text = name + " << END\n";
  for (const PlotRow& row : series.rows) {
    const bool gap = !std::isfinite(row.y) && !std::isfinite(row.low);
    if (!gap) {
      text += number(row.x) + " " + number(row.y) + or_else(row.left, row.x) + or_else(row.right, row.x) +
              or_else(row.low, row.y) + or_else(row.high, row.y);
    }
    text += "\n";
  }
  return text + "END\n";
}

std::string axis_text(const char* name, const Axis& axis, const AxisRange& range, std::size_t most_tics) {
  const std::string letter(name);
  std::string text = (axis.logarithmic ? "set logscale " : "unset logscale ") + letter + "\n";
  text += "set " + letter + "range [" + number(range.low) + ":" + number(range.high) + "]\n";
  text += "set " + letter + "label " + quoted(axis.title) + "\n";
  // Large numbers get a prefix such as k, so that the labels do not overlap.
  const std::string plain = range.high < 1e4 ? "%g" : "%.0s%c";
  const std::string format = axis.logarithmic && !axis.unit.empty() ? "%.0s %c" + axis.unit : plain;
  text += "set format " + letter + " \"" + format + "\"\nset " + letter + "tics ";
  if (!axis.logarithmic) return text + "autofreq\n";
  std::string tics;
  for (const double at : log_tics(range, most_tics)) tics += (tics.empty() ? "" : ", ") + number(at);
  return text + "(" + tics + ")\n";
}

// The variables of style.gp that draw the marks.
constexpr const char* kStyles[] = {"line",        "dashed",      "curve", "hollow_curve", "bars",
                                   "hollow_bars", "square_bars", "up",    "down",         "area"};

// `named`: the names that are in the legend of this panel or an earlier one.
std::string drawn_with(const Series& series, bool names_at_ends, std::set<std::string>& named) {
  const bool area = series.mark == Mark::area;
  const bool in_legend = !series.name.empty() && (area || !names_at_ends) && named.insert(series.name).second;
  return std::string("@").append(kStyles[static_cast<std::size_t>(series.mark)]) +
         (area ? "" : " linecolor rgb " + colour_of(series.colour)) +
         (in_legend ? " title " + quoted(series.name) : " notitle");
}

// A line across the panel; a vertical one has its name at the upper end.
std::string level_text(const Level& level) {
  const std::string at = number(level.value);
  const std::string ends = level.vertical ? " from first " + at + ", graph 0 to first " + at + ", graph 1"
                                          : " from graph 0, first " + at + " to graph 1, first " + at;
  const std::string line = "set arrow" + ends + " nohead dashtype 2 linewidth 1.5 linecolor rgb muted\n";
  if (!level.vertical) return line;
  return line + "set label " + quoted(level.text) + " at first " + at +
         ", graph 1 right offset character -0.5,-0.7 textcolor rgb muted\n";
}

std::string tag_text(const NameTag& tag) {
  return "set label " + quoted(tag.text) + " at graph " + number(tag.x) + ", graph " + number(tag.y) +
         (tag.begins_here ? " left offset character 0.7,0" : " right offset character -0.7,0") + " textcolor rgb " +
         colour_of(tag.colour) + "\n";
}

struct PanelSize {
  double width = 0.0;  // pixels
  double height = 0.0;
};

std::string panel_text(const Panel& panel, std::size_t index, const PanelSize& size, std::set<std::string>& named) {
  std::string text = "set title " + quoted(panel.title) + "\n";
  text += axis_text("x", panel.x, range_of(panel, false), static_cast<std::size_t>(size.width / kTicWidth)) +
          axis_text("y", panel.y, range_of(panel, true), static_cast<std::size_t>(size.height / kTicHeight));
  const std::vector<NameTag> tags = name_tags(panel, kTagHeight / size.height, kCharacter / size.width);
  std::size_t longest = 2;  // characters of the names beside the panel
  for (const NameTag& tag : tags) longest = std::max(longest, tag.beside_panel ? tag.text.size() : 0);
  text += "set rmargin " + std::to_string(longest + 1) + "\n";
  for (const Level& level : panel.levels) text += level_text(level);
  for (const NameTag& tag : tags) text += tag_text(tag);
  std::string curves;
  for (const bool area : {true, false}) {  // areas first, so that they are behind the curves
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
      const Series& series = panel.series[i];
      if ((series.mark == Mark::area) != area || series.rows.empty()) continue;
      curves += (curves.empty() ? "" : ", \\\n  ") + data_name(index, i) + " " +
                drawn_with(series, panel.names_at_ends, named);
    }
  }
  return text + "plot " + (curves.empty() ? "NaN" : curves) + "\nunset arrow\nunset label\n";
}

constexpr std::size_t kMostMoments = 3000;
// The difference's axis reaches at least to the first, and beyond the second only for the first model.
constexpr double kLeastScale_jnd = 1.6;
constexpr double kMostScale_jnd = 5.0;

bool same_rows(const Series& one, const Series& other) {
  return std::ranges::equal(one.rows, other.rows, [](const PlotRow& a, const PlotRow& b) {
    return a.y == b.y || (std::isnan(a.y) && std::isnan(b.y));
  });
}

namespace fs = std::filesystem;

constexpr std::size_t kRandomLetters = 6;  // of mkdtemp
// A folder is locked within this time after it was made.
constexpr std::chrono::seconds kLockedBy(10);

bool run_in_shell(const std::string& command, std::string& text) {
  std::FILE* const output = popen(command.c_str(), "r");
  if (output == nullptr) return false;
  char chunk[4096];
  while (const std::size_t count = std::fread(chunk, 1, sizeof chunk, output)) text.append(chunk, count);
  return pclose(output) == 0;
}

// The first line of gnuplot's output that is neither empty nor a warning.
std::string first_line(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool says = line.find_first_not_of(" \t^") != std::string::npos;
    if (says && line.find("warning:") == std::string::npos) return line;
  }
  return "no message";
}

// Runs gnuplot without the user's settings.
Status run_gnuplot(const std::string& folder, const std::string& script) {
  std::string message;
  if (run_in_shell(
          "cd " + shell_word(folder) + " && LC_ALL=C gnuplot -d " + shell_word(script) + " 2>&1 >/dev/null </dev/null",
          message))
    return {};
  return Error{"gnuplot could not draw " + script + ": " + first_line(message) +
               "; check that it is gnuplot 5.4 or newer with the svg and pngcairo terminals"};
}

// Locks a folder against `remove_abandoned`; -1 if another object has locked it.
int lock_folder(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0 || flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  close(descriptor);
  return -1;
}

// Removes the scratch folders of programs that were killed: nothing locks them, and they are too old to be locked next.
void remove_abandoned(const std::string& parent, const std::string& name) {
  std::error_code error;
  std::vector<fs::path> abandoned;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, error)) {
    const std::string found = entry.path().filename().string();
    if (!found.starts_with(name) || found.size() != name.size() + kRandomLetters || !entry.is_directory(error))
      continue;
    const auto age = fs::file_time_type::clock::now() - entry.last_write_time(error);
    if (!error && age > kLockedBy) abandoned.push_back(entry.path());
  }
  for (const fs::path& path : abandoned) {
    const int lock = lock_folder(path.string());
    if (lock < 0) continue;
    fs::remove_all(path, error);
    close(lock);
  }
}

}  // namespace

Result<std::string> plot_script(Plot plot) {
  for (Panel& panel : plot.panels) {
    std::vector<Series> marks = cut_marks(panel);
    panel.series.insert(panel.series.end(), marks.begin(), marks.end());
  }
  const auto assets = find_assets();
  if (!assets) return assets.error();
  const auto style = read_plain_file(*assets + "/figures/style.gp", "the style of all figures");
  if (!style) return style.error();
  const int rows = (static_cast<int>(plot.panels.size()) + plot.columns - 1) / plot.columns;
  const int height = static_cast<int>(rows * kRowHeight * plot.height);
  std::string text = "# gnuplot " + plot.name + ".gp draws " + plot.name + ".svg and " + plot.name + ".png here.\n";
  const PanelSize size{plot.width * kPageWidth / plot.columns - 100.0, kPanelShare * kRowHeight * plot.height};
  text += "width = " + std::to_string(static_cast<int>(plot.width * kPageWidth)) +
          "\nheight = " + std::to_string(height) + "\n" + *style;
  for (std::size_t p = 0; p < plot.panels.size(); ++p)
    for (std::size_t s = 0; s < plot.panels[p].series.size(); ++s)
      text += data_block(plot.panels[p].series[s], data_name(p, s));
  for (const char* medium : {"svg", "png"}) {
    text += "eval " + std::string(medium) + "\nset output '" + plot.name + "." + medium + "'\n";
    text += "set multiplot layout " + std::to_string(rows) + "," + std::to_string(plot.columns) + "\n";
    std::set<std::string> named;
    for (std::size_t p = 0; p < plot.panels.size(); ++p) text += panel_text(plot.panels[p], p, size, named);
    text += "unset multiplot\nunset output\n";
  }
  return text;
}

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
  const auto worst_of = [&](const ComparedMoment& moment) {
    double worst = -1.0;
    for (std::size_t i = 0; i < models.size(); ++i)
      worst = std::max(worst, std::abs(moment.over_jnd(i, models[i].jnd)));
    return worst;
  };
  const double from_s = moments.front().time_s, to_s = moments.back().time_s;
  Panel force{.title = title,
              .x = {.low = from_s, .high = to_s},
              .y = {"Force [N]"},
              .series = {{"measured", kMeasuredColour, Mark::line, {}}},
              .names_at_ends = true};
  Panel difference{.x = {.title = "Time [s]", .low = from_s, .high = to_s},
                   .y = {"Difference [JND]"},
                   .series = {{"within 1 JND", kMutedColour, Mark::area, {}}},
                   .names_at_ends = true};
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
      const double over = shown.over_jnd(i, models[i].jnd);
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

ScratchFolder::ScratchFolder(const std::string& parent, const std::string& name)
    : path_(parent + "/" + name + std::string(kRandomLetters, 'X')) {
  remove_abandoned(parent, name);
  if (mkdtemp(path_.data()) == nullptr) {
    path_.clear();
  } else {
    lock_ = lock_folder(path_);
  }
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
  if (lock_ >= 0) close(lock_);
}

Status find_gnuplot() {
  std::string path;
  if (run_in_shell("command -v gnuplot", path)) return {};
  return Error{"found no gnuplot in PATH, which draws the figures; install it (Debian: apt-get install gnuplot-nox)"};
}

Status draw_plots(const std::string& folder, const std::vector<Plot>& plots) {
  if (const Status found = find_gnuplot(); !found) return found;
  for (const Plot& plot : plots) {
    const auto text = plot_script(plot);
    if (!text) return text.error();
    const std::string script = plot.name + ".gp";
    if (const Status status = write_file_atomically(folder + "/" + script, *text, true); !status) return status;
    if (const Status status = run_gnuplot(folder, script); !status) return status;
    // gnuplot does not report a write that failed.
    for (const char* ending : {".svg", ".png"}) {
      const std::string drawn = plot.name + ending;
      std::error_code missing;
      if (const auto bytes = fs::file_size(folder + "/" + drawn, missing); missing || bytes == 0)
        return Error{"gnuplot wrote no " + drawn + "; check the free space, and that it is gnuplot 5.4 or newer"};
    }
  }
  return {};
}

std::string plot_ending_error(const std::string& path) {
  const bool known = path.ends_with(".svg") || path.ends_with(".png");
  return known ? "" : "found " + path + ", expected a file that ends in .svg or .png";
}

Status draw_plot(const Plot& plot, const std::string& path, bool overwrite) {
  if (const std::string wrong = plot_ending_error(path); !wrong.empty()) return Error{"--plot: " + wrong};
  if (const auto trial = AtomicFile::create(path, overwrite); !trial) return trial.error();
  const fs::path parent = fs::path(path).parent_path();
  const ScratchFolder scratch(parent.empty() ? "." : parent.string());
  if (scratch.path().empty()) return Error{"cannot write " + path + ": no folder can be made beside it"};
  if (const Status status = draw_plots(scratch.path(), {plot}); !status) return status;
  const std::string drawn = scratch.path() + "/" + plot.name + fs::path(path).extension().string();
  const auto bytes = read_plain_file(drawn, "a drawing of gnuplot");
  return bytes ? write_file_atomically(path, *bytes, overwrite) : bytes.error();
}

}  // namespace palpate
