#include "scenes/study/recovery.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "engine/base/parallel.h"
#include "scenes/study/simulated_subject.h"
#include "scenes/study/study_analysis.h"

namespace palpate {
namespace {

constexpr std::uint64_t kTraitsStream = 41;
constexpr int kAtOnce = 16;  // subjects between two reports of progress

struct Found {
  double truth_N = 0.0;
  Estimate jnd_N;
};
using SubjectFound = std::vector<Found>;  // in order of the reference force

SubjectTraits drawn_traits(RandomStream& random) {
  SubjectTraits traits;
  traits.jnd = {random.uniform(0.03, 0.065), random.uniform(0.05, 0.12)};
  traits.order_bias_jnd = random.uniform(-0.5, 0.5);
  traits.lapse_rate = random.uniform(0.0, 0.03);
  return traits;
}

Result<SubjectFound> study_one(const RecoverySettings& settings, int subject) {
  const auto number = static_cast<std::uint64_t>(subject);
  RandomStream random(settings.seed, kTraitsStream + number);
  const SubjectTraits traits = drawn_traits(random);
  char code[16];
  std::snprintf(code, sizeof code, "R%04d", subject % 10000);
  const StudyHeader header{code, settings.procedure, settings.timing};
  const auto records = run_simulated_session(header, traits, random.next());
  if (!records) return records.error();
  SubjectFound found;
  for (const ReferenceJnd& reference : analyse_subject({header, "", *records, 0}, settings.intervals).references) {
    const double truth = true_relative_jnd(traits.jnd, reference.reference_N, settings.intervals.criterion);
    found.push_back({truth * reference.reference_N, reference.jnd_N});
  }
  return found;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

RecoveryRow row_of(const std::vector<SubjectFound>& all, std::size_t reference) {
  RecoveryRow row;
  row.reference_N = kReferenceForces_N[reference];
  std::vector<double> ratios, widths;
  double squares = 0.0;
  int held = 0;
  for (const SubjectFound& subject : all) {
    const Found& found = subject[reference];
    ++row.subjects;
    held += found.jnd_N.low <= found.truth_N && found.truth_N <= found.jnd_N.high ? 1 : 0;
    ratios.push_back(found.jnd_N.value / found.truth_N);
    widths.push_back(found.jnd_N.high / found.jnd_N.low);
    if (!found.jnd_N.determined) continue;
    ++row.determined;
    squares += std::log(ratios.back()) * std::log(ratios.back());
  }
  row.coverage = static_cast<double>(held) / static_cast<double>(row.subjects);
  row.rms_log_error = row.determined > 0 ? std::sqrt(squares / row.determined) : 0.0;
  row.median_ratio = median(ratios);
  row.median_high_over_low = median(widths);
  return row;
}

}  // namespace

Result<std::vector<RecoveryRow>> measure_recovery(const RecoverySettings& settings,
                                                  const std::function<bool(double)>& progress) {
  std::vector<Result<SubjectFound>> all(static_cast<std::size_t>(settings.subjects), Error{"not run"});
  for (int from = 0; from < settings.subjects; from += kAtOnce) {
    if (!progress(static_cast<double>(from) / settings.subjects)) return Error{"interrupted"};
    parallel_for(std::min(kAtOnce, settings.subjects - from), [&](int part) {
      all[static_cast<std::size_t>(from + part)] = study_one(settings, from + part);
    });
  }
  std::vector<SubjectFound> found;
  for (const auto& subject : all) {
    if (!subject) return subject.error();
    found.push_back(*subject);
  }
  std::vector<RecoveryRow> rows;
  for (std::size_t reference = 0; reference < kReferenceForces_N.size() && !found.empty(); ++reference) {
    rows.push_back(row_of(found, reference));
  }
  return rows;
}

}  // namespace palpate
