// Figure 3 of Hoever & Harders (2009) from one's own study: (a) the JND over the reference
// force with the fitted line, the conservative one and the paper's; (b) the same relative to
// the reference force.
// Thread guarantee: slow side (starts a process, does I/O).
#pragma once

#include <string>

#include "engine/base/result.h"
#include "scenes/plot/plot.h"
#include "scenes/study/study_analysis.h"

namespace palpate {

Plot study_plot(const StudyAnalysis& analysis);

// Writes `folder`/figure3.gp and, by it, figure3.svg and figure3.png, each whole or not at
// all. Errors: a figure exists and `overwrite` is false; gnuplot is not installed or fails;
// the disk refuses. The script is there in either case, figures of an earlier run stay.
Status write_study_figures(const StudyAnalysis& analysis, const std::string& folder, bool overwrite);

}  // namespace palpate
