#include "scenes/study/discrimination.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/text.h"
#include "scenes/study/psychometrics.h"

namespace palpate {

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
  Discrimination result{subject};
  for (const StudyRecord& record : records) {
    if (record.trial.training) continue;
    const bool usable = record.rendered && record.worst_N <= 0.5 * strokes.jnd.at(0.0);
    ++(usable ? result.trials : result.unusable);
    if (usable && record.found_reference()) ++result.correct;
  }
  return result;
}

std::string discrimination_verdict(const Discrimination& result, const StrokePair& strokes) {
  const std::string most = fixed(strokes.max_over_jnd, 2), mean = fixed(strokes.mean_over_jnd, 2);
  const bool below = strokes.max_over_jnd <= 1.0, above = strokes.mean_over_jnd > 1.0;
  const std::string prediction =
      below   ? "Predicted below the JND (at most " + most + " of it). "
      : above ? "Predicted above the JND (" + mean + " of it on average). "
              : "Above the JND for a moment only (at most " + most + " of it, on average " + mean + "). ";
  if (result.trials == 0) return prediction + "No usable answers yet.";
  const ShareInterval interval = wilson_interval(result.correct, result.trials);
  const bool found_below = interval.high<kJndCriterion, found_above = interval.low> kJndCriterion;
  const std::string agreement = !found_below && !found_above ? "too few answers to decide, the interval contains 75 %."
                                : below || above ? (found_below == below ? "consistent." : "not consistent.")
                                : found_below    ? "less noticeable than one JND."
                                                 : "more noticeable than one JND.";
  return prediction + fixed(100.0 * result.share(), 0) + " % right [" + fixed(100.0 * interval.low, 0) + " to " +
         fixed(100.0 * interval.high, 0) + "], " + (interval.low > 0.5 ? "more than by guessing" : "as by guessing") +
         "; 75 % would be one JND: " + agreement;
}

Result<std::vector<Discrimination>> analyse_discrimination(const std::vector<StudyData>& files) {
  if (const Status checked = check_study_files(files); !checked) return checked.error();
  if (files.front().header.strokes == nullptr)
    return Error{"found constant stimuli, expected the procedure discriminate"};
  std::vector<Discrimination> results;
  Discrimination all{"all"};
  for (const StudyData& file : files) {
    const Discrimination one = discrimination_of(file.header.subject, file.records, *file.header.strokes);
    if (one.trials == 0) return Error{"found no usable answer of subject " + one.subject + "; leave the file out"};
    all.trials += one.trials;
    all.correct += one.correct;
    all.unusable += one.unusable;
    results.push_back(one);
  }
  results.push_back(all);
  return results;
}

std::string discrimination_table(const std::vector<Discrimination>& results, const StrokePair& strokes) {
  std::string table =
      "subject,trials,correct,unusable,share_correct,share_low,share_high,predicted_mean_over_jnd,"
      "predicted_max_over_jnd\n";
  for (const Discrimination& one : results) {
    const ShareInterval interval = wilson_interval(one.correct, one.trials);
    char text[320];
    std::snprintf(text, sizeof text, "%s,%zu,%zu,%zu,%.4f,%.4f,%.4f,%.4f,%.4f\n", one.subject.c_str(), one.trials,
                  one.correct, one.unusable, one.share(), interval.low, interval.high, strokes.mean_over_jnd,
                  strokes.max_over_jnd);
    table += text;
  }
  return table;
}

}  // namespace palpate
