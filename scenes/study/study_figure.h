// Figure 3 of Hoever & Harders (2009) from one's own study, by gnuplot: (a) the JND
// over the reference force with the fitted line, the conservative one and the paper's;
// (b) the same relative to the reference force.
// Thread guarantee: slow side (starts a process, does I/O).
#pragma once

#include <string>

#include "engine/base/result.h"
#include "scenes/study/study_analysis.h"

namespace palpate {

// A gnuplot script that holds its own data and writes figure3a and figure3b, each as
// .svg and .png, into the current folder.
std::string study_figure_script(const StudyAnalysis& analysis);

// Writes `folder`/figure3.gp and, by it, figure3a and figure3b as .svg and .png, each
// whole or not at all. Errors: a figure exists and `overwrite` is false; gnuplot is not
// installed or fails; the disk refuses. The script is there in either case, figures
// of an earlier run stay.
Status write_study_figures(const StudyAnalysis& analysis, const std::string& folder, bool overwrite);

}  // namespace palpate
