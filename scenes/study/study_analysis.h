// From the answers of all subjects to the JND line.
//
// Per subject and reference force: maximum likelihood with a likelihood interval
// (psychometrics.h). For each reference force then the mean over the subjects, as in the
// paper, and one function for the answers of all, its interval by drawing subjects with
// replacement. That one and its interval lie above the subjects' at the larger forces,
// where a JND is a small part of the comparisons' range: the 320 answers of one subject do
// not tell a miss from a lapse, and each miss that is taken for a lapse makes the function
// steeper; all answers together tell. The means are the points of the line
// (scenes/study/jnd_lines.h). Differences and references are those that were rendered, not those
// that were planned. Training trials do not count, nor do trials whose forces did not
// reach half of what was planned.
// Deterministic. Thread guarantee: pure functions; slow side (seconds).
#pragma once

#include <functional>
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
  Estimate jnd_N;
};

struct SubjectJnd {
  std::string subject;
  std::size_t unusable = 0;  // trials
  std::vector<ReferenceJnd> references;
};

struct PooledJnd {
  double reference_N = 0.0;
  double rendered_N = 0.0;
  std::size_t subjects = 0;  // whose own JND is determined
  double mean_N = 0.0;       // of their JNDs
  double standard_error_N = 0.0;
  Estimate jnd_N;  // one function for all answers
};

struct StudyAnalysis {
  std::vector<SubjectJnd> subjects;
  std::vector<PooledJnd> pooled;
  std::vector<JndPoint> points;
  // Line and reason why there is none.
  Result<JndLines> lines = Error{"not analysed"};
};

// `resamples`: of the subjects, for the JND of all together. `with_published`: Pang, Tan & Durlach's point
// belongs to the line too. `progress` gets the share done, and ends it by false ("interrupted"). Errors: no
// file; a subject twice; a subject without answers.
Result<StudyAnalysis> analyse_study(const std::vector<StudyData>& files, int resamples, bool with_published,
                                    const std::function<bool(double)>& progress);

// One row per subject and reference force, then pooled: CSV with a header row.
std::string analysis_table(const StudyAnalysis& analysis);

}  // namespace palpate
