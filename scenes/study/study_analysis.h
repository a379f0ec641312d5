// Computes the JND line from the answers of all subjects.
// JNDs are estimated per subject and reference force by maximum likelihood (psychometrics.h), then averaged over the
// subjects as in the paper. The means are the points of the line (scenes/study/jnd_lines.h). Differences and
// references are the rendered ones, not the planned ones. Excluded are training, rehearsals, and trials in which the
// mean of a force deviated from the plan by more than half its JND.
// Deterministic. Thread guarantee: pure functions; slow side.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/study/jnd_lines.h"
#include "scenes/study/psychometrics.h"
#include "scenes/study/study_file.h"

namespace palpate {

struct ReferenceJnd {
  double reference_N = 0.0;  // as planned
  double rendered_N = 0.0;   // mean over the trials
  std::size_t trials = 0;
  double jnd_N = 0.0;
  bool determined = false;  // see PsychometricFit
};

struct SubjectJnd {
  std::string subject;
  std::size_t unusable = 0;  // excluded trials
  std::vector<ReferenceJnd> references;
};

struct MeanJnd {
  double reference_N = 0.0;
  double rendered_N = 0.0;
  std::size_t subjects = 0;  // number of subjects whose JND is determined
  double jnd_N = 0.0;
  double standard_error_N = 0.0;
};

struct StudyAnalysis {
  std::vector<SubjectJnd> subjects;
  std::vector<MeanJnd> means;
  std::vector<JndPoint> points;
  // The lines, or the reason why there are none.
  Result<JndLines> lines = Error{"not analysed"};
};

// `with_published`: adds the point of Pang, Tan & Durlach (1991). Errors: no file; a subject twice, or without usable
// answers; a file of the discrimination study; an unknown reference force.
Result<StudyAnalysis> analyse_study(const std::vector<StudyData>& files, bool with_published);

// One row per subject and reference force, then the means: CSV with a header row.
std::string analysis_table(const StudyAnalysis& analysis);

}  // namespace palpate
