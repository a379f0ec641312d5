#include "scenes/study/discrimination.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/text.h"
#include "scenes/study/psychometrics.h"

namespace palpate {
namespace {

bool is_usable(const StudyRecord& record, const JndLine& jnd) {
  return record.rendered && record.worst_N <= 0.5 * jnd.at(0.0);
}

std::string row_of(const Discrimination& result, const StrokePair& strokes) {
  const ShareInterval interval = wilson_interval(result.correct, result.trials);
  char text[320];
  std::snprintf(text, sizeof text, "%s,%zu,%zu,%zu,%.4f,%.4f,%.4f,%.4f,%.4f\n", result.subject.c_str(), result.trials,
                result.correct, result.unusable, result.share(), interval.low, interval.high, strokes.mean_over_jnd,
                strokes.max_over_jnd);
  return text;
}

// The predicted difference: -1 below one JND, 1 above it, 0 neither.
int predicted_side(const StrokePair& strokes) {
  if (strokes.max_over_jnd <= 1.0) return -1;
  return strokes.mean_over_jnd > 1.0 ? 1 : 0;
}

int found_side(const ShareInterval& interval) {
  if (interval.high < kJndCriterion) return -1;
  return interval.low > kJndCriterion ? 1 : 0;
}

std::string prediction_words(const StrokePair& strokes) {
  const int side = predicted_side(strokes);
  const std::string most = fixed(strokes.max_over_jnd, 2), mean = fixed(strokes.mean_over_jnd, 2);
  if (side < 0) return "Predicted below the JND (at most " + most + " of it). ";
  if (side > 0) return "Predicted above the JND (" + mean + " of it on average). ";
  return "Above the JND for a moment only (at most " + most + " of it, on average " + mean + "). ";
}

std::string agreement_words(int predicted, int found) {
  if (found == 0) return "too few answers to tell, the interval holds 75 %.";
  if (predicted == 0)
    return found < 0 ? "not noticed as one JND would be." : "noticed more often than one JND would be.";
  return predicted == found ? "consistent." : "not consistent.";
}

Status check_discrimination_files(const std::vector<StudyData>& files) {
  if (const Status once = check_subjects(files); !once) return once;
  for (const StudyData& file : files) {
    const StudyHeader& header = file.header;
    if (header.strokes == nullptr) {
      return Error{"found the procedure " + std::string(header.procedure()) + " in the file of subject " +
                   header.subject + ", expected discriminate as in the others; analyse them apart"};
    }
    const StrokePair& first = *files.front().header.strokes;
    if (!same_strokes(*header.strokes, first)) {
      return Error{"found other strokes in the file of subject " + header.subject + ", expected \"" + first.reference +
                   "\" and \"" + first.comparison + "\" in " + first.recording +
                   " as in the first; analyse them apart"};
    }
  }
  return {};
}

}  // namespace

double Discrimination::share() const noexcept {
  return trials > 0 ? static_cast<double>(correct) / static_cast<double>(trials) : 0.0;
}

ShareInterval wilson_interval(std::size_t correct, std::size_t trials) noexcept {
  if (trials == 0) return {};
  const double n = static_cast<double>(trials), share = static_cast<double>(correct) / n;
  const double z = normal_quantile(0.975), z2 = z * z / n;
  const double middle = (share + 0.5 * z2) / (1.0 + z2);
  const double half = std::sqrt(share * (1.0 - share) * z2 + 0.25 * z2 * z2) / (1.0 + z2);
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

Discrimination discrimination_of(const std::string& subject, const std::vector<StudyRecord>& records,
                                 const StrokePair& strokes) {
  Discrimination result{subject, 0, 0, 0};
  for (const StudyRecord& record : records) {
    if (record.training) continue;
    if (!is_usable(record, strokes.jnd)) {
      ++result.unusable;
      continue;
    }
    ++result.trials;
    result.correct += record.found_reference() ? 1 : 0;
  }
  return result;
}

std::string discrimination_verdict(const Discrimination& result, const StrokePair& strokes) {
  if (result.trials == 0) return prediction_words(strokes) + "No usable answers yet.";
  const ShareInterval interval = wilson_interval(result.correct, result.trials);
  char text[200];
  std::snprintf(text, sizeof text, "%.0f %% right [%.0f to %.0f], %s; 75 %% would be one JND: ", 100.0 * result.share(),
                100.0 * interval.low, 100.0 * interval.high,
                interval.low > 0.5 ? "more than by guessing" : "as by guessing");
  return prediction_words(strokes) + text + agreement_words(predicted_side(strokes), found_side(interval));
}

Result<DiscriminationAnalysis> analyse_discrimination(const std::vector<StudyData>& files) {
  if (const Status checked = check_discrimination_files(files); !checked) return checked.error();
  DiscriminationAnalysis analysis;
  analysis.strokes = files.front().header.strokes;
  analysis.all.subject = "all";
  for (const StudyData& file : files) {
    const Discrimination one = discrimination_of(file.header.subject, file.records, *analysis.strokes);
    if (one.trials == 0) return Error{"found no usable answer of subject " + one.subject + "; leave the file out"};
    analysis.all.trials += one.trials;
    analysis.all.correct += one.correct;
    analysis.all.unusable += one.unusable;
    analysis.subjects.push_back(one);
  }
  return analysis;
}

std::string discrimination_table(const DiscriminationAnalysis& analysis) {
  std::string text =
      "subject,trials,correct,unusable,share_correct,share_low,share_high,predicted_mean_over_jnd,"
      "predicted_max_over_jnd\n";
  for (const Discrimination& subject : analysis.subjects) text += row_of(subject, *analysis.strokes);
  return text + row_of(analysis.all, *analysis.strokes);
}

}  // namespace palpate
