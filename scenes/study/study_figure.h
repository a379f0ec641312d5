// Figure 3 of Hoever & Harders (2009) for a study: (a) the JND over the reference force with the fitted, the
// conservative and the paper's line; (b) the same relative to the reference force.
// Thread guarantee: slow side (starts a process, does I/O).
#pragma once

#include <string>

#include "engine/base/result.h"
#include "scenes/plot/plot.h"
#include "scenes/study/study_analysis.h"

namespace palpate {

Plot study_plot(const StudyAnalysis& analysis);

// Writes `folder`/figure3.gp, then draws figure3.svg and figure3.png. Each file is whole; if drawing fails, the script
// and earlier figures stay. Errors: a file exists and `overwrite` is false; gnuplot is missing or fails; a file cannot
// be written.
Status write_study_figures(const StudyAnalysis& analysis, const std::string& folder, bool overwrite);

}  // namespace palpate
