#include "scenes/study/study_analysis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "engine/base/csv_scanner.h"

namespace palpate {
namespace {

constexpr std::uint64_t kPooledSeed = 4711;

// The usable answers of one subject.
struct SubjectAnswers {
  std::vector<const StudyRecord*> records;
  std::vector<AnswerCell> cells;  // their reference counts in `references`
  std::size_t unusable = 0;
};

bool is_usable(const StudyRecord& record) {
  return record.first_rendered_N > 0.5 * record.trial.first_N() &&
         record.second_rendered_N > 0.5 * record.trial.second_N();
}

double rendered_reference_N(const StudyRecord& record) {
  return record.trial.comparison_first ? record.second_rendered_N : record.first_rendered_N;
}

// The reference forces with usable answers, in order.
std::vector<double> references_in(const std::vector<const StudyData*>& files) {
  std::set<double> forces_N;
  for (const StudyData* file : files) {
    for (const StudyRecord& record : file->records) {
      if (!record.training && is_usable(record)) forces_N.insert(record.trial.reference_N);
    }
  }
  return {forces_N.begin(), forces_N.end()};
}

std::size_t index_of(const std::vector<double>& references_N, double reference_N) {
  return static_cast<std::size_t>(std::find(references_N.begin(), references_N.end(), reference_N) -
                                  references_N.begin());
}

SubjectAnswers usable_answers(const StudyData& data, const std::vector<double>& references_N) {
  SubjectAnswers answers;
  for (const StudyRecord& record : data.records) {
    if (record.training) continue;
    if (!is_usable(record)) {
      ++answers.unusable;
      continue;
    }
    answers.records.push_back(&record);
    add_answers(answers.cells, {index_of(references_N, record.trial.reference_N), record.rendered_difference(),
                                record.trial.comparison_first, record.comparison_judged_larger() ? 1.0 : 0.0, 1.0});
  }
  return answers;
}

Estimate scaled(Estimate relative, double reference_N) {
  return {relative.value * reference_N, relative.low * reference_N, relative.high * reference_N, relative.determined};
}

using Group = std::vector<const std::vector<AnswerCell>*>;

PsychometricFit fit_group(const Group& group, std::size_t references) {
  std::vector<AnswerCell> cells;
  for (const auto* subject : group) {
    for (const AnswerCell& cell : *subject) add_answers(cells, cell);
  }
  return fit_psychometric(cells, references);
}

// One function for the answers of a group; the intervals by drawing its members.
std::vector<Estimate> pooled_relative_jnds(const Group& group, std::size_t references, const IntervalSettings& settings,
                                           RandomStream random, const std::function<bool(double)>& progress) {
  const PsychometricFit fit = fit_group(group, references);
  if (group.size() == 1) return profile_jnds(*group.front(), fit, settings);
  std::vector<std::vector<double>> replicates(references);
  for (int i = 0; i < settings.resamples; ++i) {
    if (!progress(static_cast<double>(i) / settings.resamples)) return {};
    Group drawn;
    for (std::size_t k = 0; k < group.size(); ++k) drawn.push_back(group[random.index(group.size())]);
    const PsychometricFit again = fit_group(drawn, references);
    for (std::size_t r = 0; r < references; ++r) replicates[r].push_back(again.functions[r].jnd(settings.criterion));
  }
  std::vector<Estimate> estimates;
  for (std::size_t r = 0; r < references; ++r) {
    estimates.push_back(
        bias_corrected_interval(fit.functions[r].jnd(settings.criterion), replicates[r], settings.level));
    estimates.back().determined = fit.determined[r];
  }
  return estimates;
}

// Mean and standard error of the subjects' own JNDs at one reference force.
void average_subjects(const std::vector<SubjectJnd>& subjects, PooledJnd& pooled) {
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
  if (values.empty()) return;
  const double count = static_cast<double>(values.size());
  for (const double value : values) pooled.mean_N += value / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - pooled.mean_N) * (value - pooled.mean_N);
  if (values.size() > 1) pooled.standard_error_N = std::sqrt(squares / (count - 1.0) / count);
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
      const auto& planned_N = kReferenceForces_N;
      if (std::find(planned_N.begin(), planned_N.end(), record.trial.reference_N) != planned_N.end()) continue;
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

SubjectJnd analyse_subject(const StudyData& data, const IntervalSettings& settings) {
  const std::vector<double> references_N = references_in({&data});
  const SubjectAnswers answers = usable_answers(data, references_N);
  SubjectJnd result{data.header.subject, answers.unusable, {}};
  if (references_N.empty()) return result;
  const std::vector<Estimate> relative =
      profile_jnds(answers.cells, fit_psychometric(answers.cells, references_N.size()), settings);
  for (std::size_t r = 0; r < references_N.size(); ++r) {
    ReferenceJnd reference{references_N[r], 0.0, 0, {}};
    for (const StudyRecord* record : answers.records) {
      if (record->trial.reference_N != references_N[r]) continue;
      reference.rendered_N += rendered_reference_N(*record);
      ++reference.trials;
    }
    reference.rendered_N /= static_cast<double>(reference.trials);
    reference.jnd_N = scaled(relative[r], reference.rendered_N);
    result.references.push_back(reference);
  }
  return result;
}

Result<StudyAnalysis> analyse_study(const std::vector<StudyData>& files, const IntervalSettings& settings,
                                    bool with_published, const std::function<bool(double)>& progress) {
  if (const Status checked = check_files(files); !checked) return checked.error();
  std::vector<const StudyData*> pointers;
  for (const StudyData& file : files) pointers.push_back(&file);
  const std::vector<double> references_N = references_in(pointers);
  StudyAnalysis analysis;
  analysis.settings = settings;
  std::vector<SubjectAnswers> answers;
  Group group;
  for (const StudyData& file : files) answers.push_back(usable_answers(file, references_N));
  for (const SubjectAnswers& subject : answers) group.push_back(&subject.cells);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!progress(0.5 * static_cast<double>(i) / static_cast<double>(files.size()))) return Error{"interrupted"};
    analysis.subjects.push_back(analyse_subject(files[i], settings));
  }
  const std::vector<Estimate> pooled_relative =
      pooled_relative_jnds(group, references_N.size(), settings, RandomStream(kPooledSeed, 1),
                           [&](double share) { return progress(0.5 + 0.5 * share); });
  if (pooled_relative.empty()) return Error{"interrupted"};
  for (std::size_t r = 0; r < references_N.size(); ++r) {
    PooledJnd pooled{references_N[r], 0.0, 0, 0.0, 0.0, {}};
    average_subjects(analysis.subjects, pooled);
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
