#include "scenes/study/study_figure.h"

#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "engine/base/atomic_file.h"
#include "engine/base/whole_file.h"
#include "scenes/scene/gnuplot.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScript = "figure3.gp";
const std::array<const char*, 4> kFigures = {"figure3a.svg", "figure3a.png", "figure3b.svg", "figure3b.png"};

std::string text_of(const char* format, double a, double b = 0.0, double c = 0.0, double d = 0.0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b, c, d);
  return text;
}

// Reference, JND, standard error, twice: absolute in N, relative in percent.
std::string data_block(const char* name, const std::vector<JndPoint>& points, bool study) {
  std::string text = std::string("$") + name + " << END\n";
  for (const JndPoint& point : points) {
    if ((point.source == "study") != study) continue;
    text += text_of("%.6g %.6g %.6g ", point.reference_N, point.jnd_N, point.standard_error_N);
    text += text_of("%.6g %.6g\n", 100.0 * point.jnd_N / point.reference_N,
                    100.0 * point.standard_error_N / point.reference_N);
  }
  return text + "END\n";
}

std::string subjects_block(const StudyAnalysis& analysis) {
  std::string text = "$subjects << END\n";
  for (const SubjectJnd& subject : analysis.subjects) {
    for (const ReferenceJnd& reference : subject.references) {
      if (!reference.jnd_N.determined) continue;
      text += text_of("%.6g %.6g %.6g\n", reference.rendered_N, reference.jnd_N.value,
                      100.0 * reference.jnd_N.value / reference.rendered_N);
    }
  }
  return text + "END\n";
}

bool has_published(const std::vector<JndPoint>& points) {
  return std::any_of(points.begin(), points.end(), [](const JndPoint& point) { return point.source != "study"; });
}

// One `plot` line for (a), factor 1 and columns 2, 3, or (b), columns 4, 5.
std::string plot_line(const StudyAnalysis& analysis, bool relative) {
  const auto curve = [&](const char* name) { return relative ? std::string("100 * ") + name + "(x) / x" : std::string(name) + "(x)"; };
  std::string text = "plot " + curve("paper") + " with lines ls 4 title paper_title, \\\n";
  if (analysis.lines.ok()) {
    text += "  " + curve("fitted") + " with lines ls 2 title fitted_title, \\\n";
    text += "  " + curve("conservative") + " with lines ls 3 title conservative_title, \\\n";
  }
  text += std::string("  $subjects using 1:") + (relative ? "3" : "2") + " with points ls 5 title \"single subjects\", \\\n";
  if (has_published(analysis.points)) {
    text += std::string("  $published using 1:") + (relative ? "4" : "2") + " with points ls 6 title \"Pang, Tan \\\\& Durlach (1991)\", \\\n";
  }
  text += std::string("  $study using 1:") + (relative ? "4:5" : "2:3") + " with yerrorbars ls 1 title study_title\n";
  return text;
}

std::string lines_text(const StudyAnalysis& analysis) {
  const JndLine paper;
  std::string text = text_of("paper(x) = %.9g + %.9g * x\n", paper.offset_N, paper.weber_fraction);
  text += text_of("paper_title = \"Hoever \\\\& Harders (2009): %.3f N + %.2f %%\"\n", paper.offset_N, 100.0 * paper.weber_fraction);
  if (!analysis.lines.ok()) return text;
  const JndLine& fitted = analysis.lines->fitted;
  const JndLine& conservative = analysis.lines->conservative;
  text += text_of("fitted(x) = %.9g + %.9g * x\nconservative(x) = %.9g + %.9g * x\n", fitted.offset_N,
                  fitted.weber_fraction, conservative.offset_N, conservative.weber_fraction);
  text += text_of("fitted_title = \"fitted: %.3f N + %.2f %%\"\n", fitted.offset_N, 100.0 * fitted.weber_fraction);
  text += text_of("conservative_title = \"conservative: %.3f N + %.2f %%\"\n", conservative.offset_N,
                  100.0 * conservative.weber_fraction);
  return text;
}

const char* const kStyles =
    "set style line 1 lc rgb \"#000000\" pt 7 ps 1.2 lw 2\n"
    "set style line 2 lc rgb \"#0072B2\" lw 2\n"
    "set style line 3 lc rgb \"#0072B2\" lw 2 dt 2\n"
    "set style line 4 lc rgb \"#999999\" lw 2 dt 3\n"
    "set style line 5 lc rgb \"#E69F00\" pt 6 ps 0.5\n"
    "set style line 6 lc rgb \"#D55E00\" pt 9 ps 1.5\n"
    "set grid lc rgb \"#dddddd\"\nset xlabel \"reference force [N]\"\nset samples 500\n";

// A folder of its own in `parent`, gone with this object.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& parent) : path_(parent + "/.palpate-figures-XXXXXX") {
    if (mkdtemp(path_.data()) == nullptr) path_.clear();
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  const std::string& path() const noexcept { return path_; }  // empty: there is none

 private:
  std::string path_;
};

Result<std::string> read_figure(const std::string& path) {
  const std::optional<std::string> text = read_whole_file(path);
  if (!text || text->empty()) return Error{"gnuplot wrote no " + path + "; check that it is gnuplot 5.4 or newer (gnuplot-nox)"};
  return *text;
}

// All figures that gnuplot left in `drawn`, each whole, into `folder`.
Status take_figures(const std::string& drawn, const std::string& folder, bool overwrite) {
  std::vector<AtomicFile> files;
  for (const char* figure : kFigures) {
    const Result<std::string> text = read_figure(drawn + "/" + figure);
    if (!text) return text.error();
    Result<AtomicFile> file = AtomicFile::create(folder + "/" + figure, overwrite);
    if (!file) return file.error();
    file->write(*text);
    files.push_back(std::move(*file));
  }
  for (AtomicFile& file : files) {
    if (const Status status = file.commit(); !status) return status;
  }
  return {};
}

}  // namespace

std::string study_figure_script(const StudyAnalysis& analysis) {
  double largest_N = 0.0;
  for (const JndPoint& point : analysis.points) largest_N = std::max(largest_N, point.reference_N);
  std::string text = "# gnuplot 5: the JND over the reference force, as figure 3 of Hoever & Harders (2009)\n";
  text += data_block("study", analysis.points, true) + data_block("published", analysis.points, false) +
          subjects_block(analysis) + lines_text(analysis) + kStyles;
  char title[96];
  std::snprintf(title, sizeof title, "study_title = \"mean of %zu subject%s, standard error\"\n",
                analysis.subjects.size(), analysis.subjects.size() == 1 ? "" : "s");
  text += title;
  text += text_of("set xrange [0:%.6g]\nset yrange [0:*]\n", 1.08 * largest_N);
  for (const bool relative : {false, true}) {
    text += relative ? "set ylabel \"JND [% of the reference]\"\nset key top right\nset yrange [0:80]\n"
                     : "set ylabel \"JND [N]\"\nset key top left\n";
    const std::string name = relative ? "figure3b" : "figure3a";
    text += "set terminal svg size 720,480 dynamic background \"white\" font \"sans,13\"\nset output '" + name + ".svg'\n";
    text += plot_line(analysis, relative);
    text += "set terminal pngcairo size 1080,720 font \"sans,16\"\nset output '" + name + ".png'\nreplot\n";
  }
  return text + "set output\n";
}

Status write_study_figures(const StudyAnalysis& analysis, const std::string& folder, bool overwrite) {
  for (const char* figure : kFigures) {
    const std::string path = folder + "/" + figure;
    if (!overwrite && fs::exists(path)) return Error{path + " exists; pass --force to replace it"};
  }
  const std::string text = study_figure_script(analysis);
  if (const Status status = write_file_atomically(folder + "/" + kScript, text, overwrite); !status) return status;
  const Result<std::string> gnuplot = find_gnuplot();
  if (!gnuplot) return gnuplot.error();
  const ScratchFolder scratch(folder);
  if (scratch.path().empty()) return Error{"cannot make a folder in " + folder + "; is there space left?"};
  if (const Status status = write_file_atomically(scratch.path() + "/" + kScript, text, false); !status) return status;
  if (const Status status = run_gnuplot(*gnuplot, scratch.path(), {kScript}); !status) return status;
  return take_figures(scratch.path(), folder, overwrite);
}

}  // namespace palpate
