// Computes results from the answers of all subjects: the JND line, or the discrimination of two strokes.
//
// JNDs are estimated per subject and reference force by maximum likelihood (PsychometricFunction), then averaged over
// the subjects. As in Hoever & Harders (2009), section 4.1 and figure 3, a line is fitted to the means by least squares
// with equal weights, and then shifted down until no point is below it: the conservative line. Differences and
// references are the rendered ones, not the planned ones. Excluded are training, rehearsals, and trials in which the
// mean of a force deviated from the plan by more than half its JND.
//
// Discrimination of strokes: chance is 50 %, one JND is kJndCriterion, 75 % correct. The strokes differ by less than
// the JND when the 95 % interval of the share correct (E. B. Wilson 1927, Journal of the American Statistical
// Association 22, 209-212) is below 75 %, by more when it is above. The prediction is "below" when the error nowhere
// exceeds one JND, "above" when its mean does, else none. Excluded are training, rehearsals, and trials in which the
// rendered force deviated from the stroke by more than half the JND at 0 N at any tick.
// Thread guarantee: pure functions; slow side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "scenes/study/study_file.h"

namespace palpate {

inline constexpr double kJndCriterion = 0.75;
inline constexpr double kCriterionQuantile = 0.6744897501960817;  // Phi^-1(kJndCriterion)

// With x = (comparison - reference) / reference and o = +1 when the comparison came second, -1 when it came first, the
// comparison is judged the larger with probability
//   P(x, o) = lapse + (1 - 2 lapse) Phi(slope x + order_bias o),
// a cumulative Gaussian with a lapse rate (Wichmann & Hill 2001, Perception & Psychophysics 63(8), 1293-1313). Each
// reference force has its own slope. The lapse rate and the order bias, which favours the second force, are the same
// for all reference forces of a subject. There is no other shift, because a subject cannot know which of two forces is
// the reference. (A shift and a lapse rate for each reference force, fitted to 80 answers each, made the JND 10 % too
// small and doubled its error.)
// The JND at a criterion c is half the distance between the comparisons that are judged larger with probability c and
// 1 - c, without lapses and order bias:
//   JND = Phi^-1(c) reference / slope.
// c = 0.75 gives half the interquartile distance; the paper does not state its criterion.
struct PsychometricFunction {
  double slope = 1.0;  // 0.25 .. 40, a JND of 2.7 times the reference to one of 1.7 %
  double order_bias = 0.0;
  double lapse = 0.0;  // 0 .. 0.06
  // Whether the answers bound the slope on both sides. They do not when all are correct or all are guesses; the slope
  // is then at or near an end of its range.
  bool determined = false;

  double at(double difference, bool comparison_first) const noexcept;
  // The JND over the reference, at kJndCriterion.
  double jnd() const noexcept { return kCriterionQuantile / slope; }
};

// The answers to all trials with the same stimuli. Counts may be fractional, for expected answers.
struct AnswerCell {
  std::size_t reference = 0;  // index of the reference force
  double difference = 0.0;    // x
  bool comparison_first = false;
  double judged_larger = 0.0;  // number of trials in which the comparison was judged the larger
  double trials = 0.0;
};

// The functions of `references` reference forces by joint maximum likelihood. The lapse rate is a multiple of 0.01.
std::vector<PsychometricFunction> fit_psychometric(const std::vector<AnswerCell>& cells, std::size_t references);

struct JndPoint {
  double reference_N = 0.0, jnd_N = 0.0;
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

struct ReferenceJnd {
  double reference_N = 0.0;  // as planned
  double rendered_N = 0.0;   // mean over the trials; 0 without usable answers
  std::size_t count = 0;     // trials; of a mean, subjects with a determined JND
  double jnd_N = 0.0;
  double standard_error_N = 0.0;  // of a mean
  bool determined = false;        // see PsychometricFunction; of a mean, whether any subject's JND is determined
};

struct SubjectJnd {
  std::string subject;       // "mean": over the subjects
  std::size_t unusable = 0;  // excluded trials
  std::array<ReferenceJnd, kReferenceForces_N.size()> references;
};

struct StudyAnalysis {
  std::vector<SubjectJnd> subjects;
  SubjectJnd mean;
  std::vector<JndPoint> points;
  // The lines, or the reason why there are none.
  Result<JndLines> lines = Error{"not analysed"};
};

// `files`: answers to constant stimuli that check_study_files accepts. `with_published`: adds kPangTanDurlach. Errors:
// a subject without usable answers.
Result<StudyAnalysis> analyse_study(const std::vector<StudyData>& files, bool with_published);

// One row per subject and reference force, then the means: CSV with a header row.
std::string analysis_table(const StudyAnalysis& analysis);

// The text of jnd.json (scenes/scene/scene.h): the conservative line of `analysis`, which must have one, and for
// information criterion, subjects, fitted line, and points with sources. Numbers are in full precision.
std::string jnd_file_text(const StudyAnalysis& analysis);

struct Discrimination {
  std::string subject;  // "all": all subjects together
  std::size_t trials = 0, correct = 0;
  std::size_t unusable = 0;  // excluded trials
};

// The share of correct answers with its 95 % interval; without trials 0 in 0 to 1.
struct CorrectShare {
  double share = 0.0, low = 0.0, high = 1.0;
};
CorrectShare correct_share(const Discrimination& result) noexcept;

// Prediction, result and their agreement in words, e.g.
// "Predicted below the JND (at most 0.71 of it). 52 % right [42 to 62], as by guessing;
// 75 % would be one JND: consistent."
std::string discrimination_verdict(const Discrimination& result, const StrokePair& strokes);

// The result of each subject, then of all answers together. `files`: of the same strokes, see check_study_files.
// Errors: a subject without usable answers.
Result<std::vector<Discrimination>> analyse_discrimination(const std::vector<StudyData>& files);

// One row per result: CSV with a header row.
std::string discrimination_table(const std::vector<Discrimination>& results, const StrokePair& strokes);

// A simulated subject that answers by a psychometric function, to test the study.
// A force F is perceived as F + s(F) n with n normal of variance 1; a bias is added to the second of two forces. The
// subject answers with the larger perceived force. s(F) = JND(F) / (0.6745 sqrt(2)), so that the JND at the criterion
// 0.75 is JND(F) = offset + weber_fraction F. In a share of the trials the subject guesses.
// Two strokes are compared at the tick at which they differ most in multiples of the JND. The subject perceives both
// forces there, as above, and knows from the reminder which stroke has the larger. It is correct with the probability
//   Phi(|F1 - F2| / sqrt(s(F1)^2 + s(F2)^2)),
// 75 % for one JND, the optimum for an observer with this noise who attends to one tick.
// Deterministic: the same seed gives the same answers.

struct SubjectTraits {
  JndLine jnd;
  double order_bias_jnd = 0.0;  // added to the second force, in multiples of the JND
  double lapse_rate = 0.0;      // 0 .. 0.5; the subject guesses in a share of 2 x this, half of it wrong
};

// A subject with the paper's JND at 2.5 N, 13.3 %.
inline constexpr SubjectTraits kSubjectOf2009{{0.05, 0.113}, 0.0, 0.01};

// All answers of one subject, including training, to forces that are rendered exactly as planned.
std::vector<StudyRecord> simulated_answers(const StudyHeader& header, const SubjectTraits& traits, std::uint64_t seed);

}  // namespace palpate
