// From the answers of all subjects to the JND line.
//
// Per subject and reference force: maximum likelihood (psychometrics.h). For each reference force then the
// mean over the subjects, as in the paper; the means are the points of the line (scenes/study/jnd_lines.h).
// Differences and references are those that were rendered, not those that were planned. Training trials
// do not count, nor do rehearsals, and trials in which a mean force was off by more than half its JND.
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
  double rendered_N = 0.0;   // mean of what was rendered
  std::size_t trials = 0;
  double jnd_N = 0.0;
  bool determined = false;  // the answers bound it
};

struct SubjectJnd {
  std::string subject;
  std::size_t unusable = 0;  // trials
  std::vector<ReferenceJnd> references;
};

struct MeanJnd {
  double reference_N = 0.0;
  double rendered_N = 0.0;
  std::size_t subjects = 0;  // whose own JND is determined
  double jnd_N = 0.0;
  double standard_error_N = 0.0;
};

struct StudyAnalysis {
  std::vector<SubjectJnd> subjects;
  std::vector<MeanJnd> means;
  std::vector<JndPoint> points;
  // Line and reason why there is none.
  Result<JndLines> lines = Error{"not analysed"};
};

// `with_published`: Pang, Tan & Durlach's point belongs to the line too. Errors: no file; a subject twice; a
// subject without answers.
Result<StudyAnalysis> analyse_study(const std::vector<StudyData>& files, bool with_published);

// One row per subject and reference force, then the means: CSV with a header row.
std::string analysis_table(const StudyAnalysis& analysis);

}  // namespace palpate
