// Figure 3 of Hoever & Harders (2009) for a study: (a) the JND over the reference force with the fitted, the
// conservative and the paper's line; (b) the same relative to the reference force.
// Thread guarantee: pure functions.
#pragma once

#include "scenes/plot/plot.h"
#include "scenes/study/study_analysis.h"

namespace palpate {

Plot study_plot(const StudyAnalysis& analysis);

}  // namespace palpate
