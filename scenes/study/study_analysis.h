// Computes the JND line from the answers of all subjects.
// JNDs are estimated per subject and reference force by maximum likelihood (psychometrics.h), then averaged over the
// subjects. As in Hoever & Harders (2009), section 4.1 and figure 3, a line is fitted to the means over the reference
// force by least squares with equal weights, and then shifted down until no point is below it. A model error below that
// conservative line is below every measured threshold.
// Differences and references are the rendered ones, not the planned ones. Excluded are training, rehearsals, and trials
// in which the mean of a force deviated from the plan by more than half its JND.
// Deterministic. Thread guarantee: pure functions; slow side.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "scenes/study/study_file.h"

namespace palpate {

struct JndPoint {
  double reference_N = 0.0;
  double jnd_N = 0.0;
  double standard_error_N = 0.0;  // 0: not known
  std::string source;             // "study", or a publication
};

struct JndLines {
  JndLine fitted;
  JndLine conservative;
};

// Errors: fewer than two reference forces; JNDs that decrease with the force; a conservative line that is not
// positive at 0 N.
Result<JndLines> fit_jnd_lines(const std::vector<JndPoint>& points);

// The only value of X.-D. Pang, H. Z. Tan & N. I. Durlach (1991), "Manual discrimination of force using active finger
// motion", Perception & Psychophysics 49(6), 531-540, within the range of this study: 9 % at 2.5 N, as quoted by
// Hoever & Harders. (The abstract of Pang et al. summarises 2.5 to 10 N as "roughly 7 %".)
inline const JndPoint kPangTanDurlach{2.5, 0.09 * 2.5, 0.0, "Pang, Tan & Durlach (1991)"};

// The JND of a subject, or the mean over the subjects, at one reference force.
struct ReferenceJnd {
  double reference_N = 0.0;  // as planned
  double rendered_N = 0.0;   // mean over the trials
  std::size_t count = 0;     // trials; of a mean, subjects whose JND is determined
  double jnd_N = 0.0;
  double standard_error_N = 0.0;  // of a mean
  bool determined = false;        // see PsychometricFit; of a mean, whether it is of any subject
};

struct SubjectJnd {
  std::string subject;
  std::size_t unusable = 0;  // excluded trials
  std::vector<ReferenceJnd> references;
};

struct StudyAnalysis {
  std::vector<SubjectJnd> subjects;
  std::vector<ReferenceJnd> means;
  std::vector<JndPoint> points;
  // The lines, or the reason why there are none.
  Result<JndLines> lines = Error{"not analysed"};
};

// `with_published`: adds kPangTanDurlach. Errors: those of check_study_files; a subject without usable answers; a file
// of the discrimination study; an unknown reference force.
Result<StudyAnalysis> analyse_study(const std::vector<StudyData>& files, bool with_published);

// One row per subject and reference force, then the means: CSV with a header row.
std::string analysis_table(const StudyAnalysis& analysis);

// The text of the file that scenes/scene/jnd_file.h reads: the conservative line of `analysis`, which has one, and, for
// information, criterion, subjects, the fitted line, and the points with their sources. Numbers are in full precision.
std::string jnd_file_text(const StudyAnalysis& analysis);

}  // namespace palpate
