// Figure 3 of Hoever & Harders (2009) from one's own study, by gnuplot: (a) the JND
// over the reference force with the fitted line, the conservative one and the paper's;
// (b) the same relative to the reference force.
// Thread guarantee: slow side (starts a process, does I/O).
#pragma once

#include <string>

#include "engine/result.h"
#include "scenes/study/study_analysis.h"

namespace palpate {

// A gnuplot script that holds its own data and writes `stem`a and `stem`b, each as .svg
// and .png. `stem`: a path, without quotes or line breaks.
std::string study_figure_script(const StudyAnalysis& analysis, const std::string& stem);

// Writes `folder`/figure3.gp and, by it, figure3a and figure3b as .svg and .png.
// Errors: `folder` has a quote or a line break; a figure exists and `overwrite` is
// false; gnuplot is not installed or fails. The script is there in either case.
Status write_study_figures(const StudyAnalysis& analysis, const std::string& folder, bool overwrite);

}  // namespace palpate
