#include "scenes/study/study_analysis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "engine/base/csv_scanner.h"

namespace palpate {
namespace {

constexpr std::uint64_t kPooledSeed = 4711;

constexpr std::size_t kReferences = kReferenceForces_N.size();

// The usable answers of one subject; references count as in kReferenceForces_N.
struct SubjectAnswers {
  std::vector<AnswerCell> cells;
  std::array<std::size_t, kReferences> trials{};
  std::array<double, kReferences> rendered_N{};  // summed up
  std::size_t unusable = 0;
};

bool is_usable(const StudyRecord& record) {
  return record.first_rendered_N > 0.5 * record.trial.first_N() &&
         record.second_rendered_N > 0.5 * record.trial.second_N();
}

std::size_t index_of(double reference_N) {
  const auto& planned_N = kReferenceForces_N;
  return static_cast<std::size_t>(std::find(planned_N.begin(), planned_N.end(), reference_N) - planned_N.begin());
}

SubjectAnswers usable_answers(const StudyData& data) {
  SubjectAnswers answers;
  for (const StudyRecord& record : data.records) {
    if (record.training) continue;
    if (!is_usable(record)) {
      ++answers.unusable;
      continue;
    }
    const std::size_t r = index_of(record.trial.reference_N);
    ++answers.trials[r];
    answers.rendered_N[r] += record.trial.comparison_first ? record.second_rendered_N : record.first_rendered_N;
    add_answers(answers.cells, {r, record.rendered_difference(), record.trial.comparison_first,
                                record.comparison_judged_larger() ? 1.0 : 0.0, 1.0});
  }
  return answers;
}

Estimate scaled(Estimate relative, double reference_N) {
  return {relative.value * reference_N, relative.low * reference_N, relative.high * reference_N, relative.determined};
}

SubjectJnd jnds_of(const std::string& subject, const SubjectAnswers& answers) {
  SubjectJnd result{subject, answers.unusable, {}};
  const std::vector<Estimate> relative = profile_jnds(answers.cells, fit_psychometric(answers.cells, kReferences));
  for (std::size_t r = 0; r < kReferences; ++r) {
    if (answers.trials[r] == 0) continue;
    const double rendered_N = answers.rendered_N[r] / static_cast<double>(answers.trials[r]);
    result.references.push_back(
        {kReferenceForces_N[r], rendered_N, answers.trials[r], scaled(relative[r], rendered_N)});
  }
  return result;
}

using Group = std::vector<const std::vector<AnswerCell>*>;

PsychometricFit fit_group(const Group& group) {
  std::vector<AnswerCell> cells;
  for (const auto* subject : group) {
    for (const AnswerCell& cell : *subject) add_answers(cells, cell);
  }
  return fit_psychometric(cells, kReferences);
}

// One function for the answers of a group; the intervals by drawing its members.
std::vector<Estimate> pooled_relative_jnds(const Group& group, int resamples,
                                           const std::function<bool(double)>& progress) {
  const PsychometricFit fit = fit_group(group);
  if (group.size() == 1) return profile_jnds(*group.front(), fit);
  RandomStream random(kPooledSeed, 1);
  std::vector<std::vector<double>> replicates(kReferences);
  for (int i = 0; i < resamples; ++i) {
    if (!progress(static_cast<double>(i) / resamples)) return {};
    Group drawn;
    for (std::size_t k = 0; k < group.size(); ++k) drawn.push_back(group[random.index(group.size())]);
    const PsychometricFit again = fit_group(drawn);
    for (std::size_t r = 0; r < kReferences; ++r) replicates[r].push_back(again.functions[r].jnd());
  }
  std::vector<Estimate> estimates;
  for (std::size_t r = 0; r < kReferences; ++r) {
    estimates.push_back(bias_corrected_interval(fit.functions[r].jnd(), replicates[r]));
    estimates.back().determined = fit.determined[r];
  }
  return estimates;
}

// Mean and standard error of the subjects' own JNDs at one reference force; false: nobody
// was asked there.
bool average_subjects(const std::vector<SubjectJnd>& subjects, PooledJnd& pooled) {
  std::vector<double> values;
  double rendered = 0.0, all = 0.0;
  for (const SubjectJnd& subject : subjects) {
    for (const ReferenceJnd& reference : subject.references) {
      if (reference.reference_N != pooled.reference_N) continue;
      rendered += reference.rendered_N;
      all += 1.0;
      if (reference.jnd_N.determined) values.push_back(reference.jnd_N.value);
    }
  }
  pooled.rendered_N = rendered / all;
  pooled.subjects = values.size();
  const double count = static_cast<double>(values.size());
  for (const double value : values) pooled.mean_N += value / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - pooled.mean_N) * (value - pooled.mean_N);
  if (values.size() > 1) pooled.standard_error_N = std::sqrt(squares / (count - 1.0) / count);
  return all > 0.0;
}

Status check_files(const std::vector<StudyData>& files) {
  if (const Status once = check_subjects(files); !once) return once;
  for (const StudyData& file : files) {
    const std::string& subject = file.header.subject;
    if (file.header.strokes != nullptr) {
      return Error{"found the procedure discriminate in the file of subject " + subject +
                   ", expected constant as in the first; analyse them apart"};
    }
    for (const StudyRecord& record : file.records) {
      if (index_of(record.trial.reference_N) < kReferences) continue;
      return Error{"found a reference force of " + shortest(record.trial.reference_N) + " N in the file of subject " +
                   subject + ", expected 0.3, 0.5, 1 or 2.5 N"};
    }
    const bool any = std::any_of(file.records.begin(), file.records.end(),
                                 [](const StudyRecord& record) { return !record.training && is_usable(record); });
    if (!any) return Error{"found no usable answer of subject " + subject + "; leave the file out"};
  }
  return {};
}

std::string row(const std::string& who, const std::string& how, double reference_N, double rendered_N,
                std::size_t count, const Estimate& jnd_N) {
  char text[256];
  std::snprintf(text, sizeof text, "%s,%s,%.4g,%.5g,%zu,%.5f,%.5f,%.5f,%.2f,%s\n", who.c_str(), how.c_str(),
                reference_N, rendered_N, count, jnd_N.value, jnd_N.low, jnd_N.high, 100.0 * jnd_N.value / rendered_N,
                jnd_N.determined ? "yes" : "no");
  return text;
}

}  // namespace

Result<StudyAnalysis> analyse_study(const std::vector<StudyData>& files, int resamples, bool with_published,
                                    const std::function<bool(double)>& progress) {
  if (const Status checked = check_files(files); !checked) return checked.error();
  StudyAnalysis analysis;
  std::vector<SubjectAnswers> answers;
  Group group;
  for (const StudyData& file : files) answers.push_back(usable_answers(file));
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!progress(0.5 * static_cast<double>(i) / static_cast<double>(files.size()))) return Error{"interrupted"};
    group.push_back(&answers[i].cells);
    analysis.subjects.push_back(jnds_of(files[i].header.subject, answers[i]));
  }
  const std::vector<Estimate> pooled_relative =
      pooled_relative_jnds(group, resamples, [&](double share) { return progress(0.5 + 0.5 * share); });
  if (pooled_relative.empty()) return Error{"interrupted"};
  for (std::size_t r = 0; r < kReferences; ++r) {
    PooledJnd pooled{kReferenceForces_N[r], 0.0, 0, 0.0, 0.0, {}};
    if (!average_subjects(analysis.subjects, pooled)) continue;
    pooled.jnd_N = scaled(pooled_relative[r], pooled.rendered_N);
    analysis.pooled.push_back(pooled);
    if (pooled.subjects == 0) continue;
    analysis.points.push_back({pooled.rendered_N, pooled.mean_N, pooled.standard_error_N, "study"});
  }
  if (with_published) {
    for (const JndPoint& point : pang_tan_durlach_points()) analysis.points.push_back(point);
  }
  analysis.lines = fit_jnd_lines(analysis.points);
  return analysis;
}

std::string analysis_table(const StudyAnalysis& analysis) {
  std::string text =
      "subject,procedure,reference_N,rendered_N,count,jnd_N,jnd_low_N,jnd_high_N,jnd_percent,determined\n";
  for (const SubjectJnd& subject : analysis.subjects) {
    for (const ReferenceJnd& reference : subject.references) {
      text += row(subject.subject, "constant", reference.reference_N, reference.rendered_N, reference.trials,
                  reference.jnd_N);
    }
  }
  for (const PooledJnd& pooled : analysis.pooled) {
    const double half_N = 1.96 * pooled.standard_error_N;
    const Estimate mean{pooled.mean_N, pooled.mean_N - half_N, pooled.mean_N + half_N, pooled.subjects > 0};
    text += row("all", "mean", pooled.reference_N, pooled.rendered_N, pooled.subjects, mean);
    text += row("all", "pooled", pooled.reference_N, pooled.rendered_N, analysis.subjects.size(), pooled.jnd_N);
  }
  return text;
}

}  // namespace palpate
