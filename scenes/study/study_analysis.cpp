#include "scenes/study/study_analysis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "engine/base/csv_scanner.h"

namespace palpate {
namespace {

constexpr std::size_t kReferences = kReferenceForces_N.size();

// The usable answers of one subject; references count as in kReferenceForces_N.
struct SubjectAnswers {
  std::vector<AnswerCell> cells;
  std::array<std::size_t, kReferences> trials{};
  std::array<double, kReferences> rendered_N{};  // sums
  std::size_t unusable = 0;
};

bool rendered(double planned_N, double rendered_N) {
  return std::abs(rendered_N - planned_N) <= 0.5 * JndLine{}.at(planned_N);
}

bool is_usable(const StudyRecord& record) {
  return record.rendered && rendered(record.trial.first_N(), record.first_rendered_N) &&
         rendered(record.trial.second_N(), record.second_rendered_N);
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

SubjectJnd jnds_of(const std::string& subject, const SubjectAnswers& answers) {
  SubjectJnd result{subject, answers.unusable, {}};
  const PsychometricFit fit = fit_psychometric(answers.cells, kReferences);
  for (std::size_t r = 0; r < kReferences; ++r) {
    if (answers.trials[r] == 0) continue;
    const double rendered_N = answers.rendered_N[r] / static_cast<double>(answers.trials[r]);
    result.references.push_back(
        {kReferenceForces_N[r], rendered_N, answers.trials[r], rendered_N * fit.functions[r].jnd(), fit.determined[r]});
  }
  return result;
}

// Mean and standard error of the subjects' JNDs at one reference force; false: no subject has answers there.
bool average_subjects(const std::vector<SubjectJnd>& subjects, MeanJnd& mean) {
  std::vector<double> values;
  double rendered_N = 0.0, all = 0.0;
  for (const SubjectJnd& subject : subjects) {
    for (const ReferenceJnd& reference : subject.references) {
      if (reference.reference_N != mean.reference_N) continue;
      rendered_N += reference.rendered_N;
      all += 1.0;
      if (reference.determined) values.push_back(reference.jnd_N);
    }
  }
  mean.rendered_N = rendered_N / all;
  mean.subjects = values.size();
  const double count = static_cast<double>(values.size());
  for (const double value : values) mean.jnd_N += value / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean.jnd_N) * (value - mean.jnd_N);
  if (values.size() > 1) mean.standard_error_N = std::sqrt(squares / (count - 1.0) / count);
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

std::string row(const std::string& who, double reference_N, double rendered_N, std::size_t count, double jnd_N,
                double standard_error_N, bool determined) {
  char text[256];
  std::snprintf(text, sizeof text, "%s,%.4g,%.5g,%zu,%.5f,%.5f,%.2f,%s\n", who.c_str(), reference_N, rendered_N, count,
                jnd_N, standard_error_N, 100.0 * jnd_N / rendered_N, determined ? "yes" : "no");
  return text;
}

}  // namespace

Result<StudyAnalysis> analyse_study(const std::vector<StudyData>& files, bool with_published) {
  if (const Status checked = check_files(files); !checked) return checked.error();
  StudyAnalysis analysis;
  for (const StudyData& file : files) analysis.subjects.push_back(jnds_of(file.header.subject, usable_answers(file)));
  for (const double reference_N : kReferenceForces_N) {
    MeanJnd mean{reference_N, 0.0, 0, 0.0, 0.0};
    if (!average_subjects(analysis.subjects, mean)) continue;
    analysis.means.push_back(mean);
    if (mean.subjects > 0) analysis.points.push_back({mean.rendered_N, mean.jnd_N, mean.standard_error_N, "study"});
  }
  if (with_published) {
    for (const JndPoint& point : pang_tan_durlach_points()) analysis.points.push_back(point);
  }
  analysis.lines = fit_jnd_lines(analysis.points);
  return analysis;
}

std::string analysis_table(const StudyAnalysis& analysis) {
  std::string text = "subject,reference_N,rendered_N,count,jnd_N,standard_error_N,jnd_percent,determined\n";
  for (const SubjectJnd& subject : analysis.subjects) {
    for (const ReferenceJnd& one : subject.references)
      text += row(subject.subject, one.reference_N, one.rendered_N, one.trials, one.jnd_N, 0.0, one.determined);
  }
  for (const MeanJnd& mean : analysis.means)
    text += row("mean", mean.reference_N, mean.rendered_N, mean.subjects, mean.jnd_N, mean.standard_error_N,
                mean.subjects > 0);
  return text;
}

}  // namespace palpate
