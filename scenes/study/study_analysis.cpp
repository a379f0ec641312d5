#include "scenes/study/study_analysis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "engine/base/csv_scanner.h"
#include "engine/base/text.h"
#include "scenes/study/psychometrics.h"

namespace palpate {
namespace {

constexpr std::size_t kReferences = kReferenceForces_N.size();

bool is_usable(const StudyRecord& record) {
  const auto deviates = [](double planned_N, double rendered_N) {
    return std::abs(rendered_N - planned_N) > 0.5 * JndLine{}.at(planned_N);
  };
  return record.rendered && !deviates(record.trial.first_N(), record.first_rendered_N) &&
         !deviates(record.trial.second_N(), record.second_rendered_N);
}

// An index of kReferenceForces_N; kReferences for another force.
std::size_t index_of(double reference_N) {
  return static_cast<std::size_t>(std::find(kReferenceForces_N.begin(), kReferenceForces_N.end(), reference_N) -
                                  kReferenceForces_N.begin());
}

Result<SubjectJnd> jnds_of(const StudyData& data) {
  SubjectJnd result{data.header.subject, 0, {}};
  // Trials with equal stimuli, by reference force, order and difference, form one cell. 1e-4 is the resolution of a
  // recorded force, 0.1 mN, over the smallest reference.
  std::map<std::tuple<std::size_t, bool, long>, AnswerCell> cells;
  std::array<ReferenceJnd, kReferences> references;
  for (const StudyRecord& record : data.records) {
    const StudyTrial& trial = record.trial;
    const std::size_t r = index_of(trial.reference_N);
    if (r == kReferences) {
      return Error{"found a reference force of " + shortest(trial.reference_N) + " N in the file of subject " +
                   result.subject + ", expected 0.3, 0.5, 1 or 2.5 N"};
    }
    if (trial.training) continue;
    if (!is_usable(record)) {
      ++result.unusable;
      continue;
    }
    ++references[r].count;
    references[r].rendered_N += record.reference_rendered_N();
    const double difference = record.rendered_difference();
    AnswerCell& cell = cells[{r, trial.comparison_first, std::lround(1e4 * difference)}];
    cell = {r, difference, trial.comparison_first, cell.judged_larger + (record.comparison_judged_larger() ? 1.0 : 0.0),
            cell.trials + 1.0};
  }
  if (cells.empty()) return Error{"found no usable answer of subject " + result.subject + "; leave the file out"};
  std::vector<AnswerCell> answers;
  for (const auto& [stimuli, cell] : cells) answers.push_back(cell);
  const PsychometricFit fit = fit_psychometric(answers, kReferences);
  for (std::size_t r = 0; r < kReferences; ++r) {
    ReferenceJnd& one = references[r];
    if (one.count == 0) continue;
    one.reference_N = kReferenceForces_N[r];
    one.rendered_N /= static_cast<double>(one.count);
    one.jnd_N = one.rendered_N * fit.functions[r].jnd();
    one.determined = fit.determined[r];
    result.references.push_back(one);
  }
  return result;
}

// Mean and standard error of the subjects' JNDs at one reference force. Its rendered force is 0 if no subject has
// answers there.
ReferenceJnd mean_of(const std::vector<SubjectJnd>& subjects, double reference_N) {
  ReferenceJnd mean{reference_N};
  double sum_N = 0.0, sum_N2 = 0.0, rendered_N = 0.0, all = 0.0;
  for (const SubjectJnd& subject : subjects) {
    for (const ReferenceJnd& one : subject.references) {
      if (one.reference_N != reference_N) continue;
      rendered_N += one.rendered_N;
      all += 1.0;
      if (!one.determined) continue;
      ++mean.count;
      sum_N += one.jnd_N;
      sum_N2 += one.jnd_N * one.jnd_N;
    }
  }
  if (all == 0.0) return mean;
  mean.rendered_N = rendered_N / all;
  mean.determined = mean.count > 0;
  const double count = static_cast<double>(mean.count);
  if (mean.determined) mean.jnd_N = sum_N / count;
  if (mean.count > 1)
    mean.standard_error_N = std::sqrt(std::max(0.0, sum_N2 / count - mean.jnd_N * mean.jnd_N) / (count - 1.0));
  return mean;
}

std::string row(const std::string& subject, const ReferenceJnd& one) {
  char text[256];
  std::snprintf(text, sizeof text, "%s,%.4g,%.5g,%zu,%.5f,%.5f,%.2f,%s\n", subject.c_str(), one.reference_N,
                one.rendered_N, one.count, one.jnd_N, one.standard_error_N, 100.0 * one.jnd_N / one.rendered_N,
                one.determined ? "yes" : "no");
  return text;
}

}  // namespace

Result<JndLines> fit_jnd_lines(const std::vector<JndPoint>& points) {
  const double count = static_cast<double>(points.size());
  double mean_force = 0.0, mean_jnd = 0.0, squares = 0.0, products = 0.0;
  for (const JndPoint& point : points) {
    mean_force += point.reference_N / count;
    mean_jnd += point.jnd_N / count;
  }
  for (const JndPoint& point : points) {
    squares += (point.reference_N - mean_force) * (point.reference_N - mean_force);
    products += (point.reference_N - mean_force) * (point.jnd_N - mean_jnd);
  }
  if (!(squares > 1e-6)) return Error{"found JNDs at fewer than two reference forces, expected two or more for a line"};
  JndLines lines;
  lines.fitted = lines.conservative = {mean_jnd - products / squares * mean_force, products / squares};
  JndLine& line = lines.conservative;
  for (const JndPoint& point : points)
    line.offset_N = std::min(line.offset_N, point.jnd_N - line.weber_fraction * point.reference_N);
  if (line.weber_fraction >= 0.0 && line.offset_N > 0.0) return lines;
  return Error{"the conservative line through the JNDs is " + fixed(line.offset_N, 4) + " N + " +
               fixed(100.0 * line.weber_fraction, 2) +
               " %, expected one that is positive at 0 N and does not decrease with the force; more subjects or more "
               "trials may help"};
}

Result<StudyAnalysis> analyse_study(const std::vector<StudyData>& files, bool with_published) {
  if (const Status checked = check_study_files(files); !checked) return checked.error();
  if (files.front().header.strokes != nullptr)
    return Error{"found the procedure discriminate, expected constant stimuli for a JND"};
  StudyAnalysis analysis;
  for (const StudyData& file : files) {
    auto subject = jnds_of(file);
    if (!subject) return subject.error();
    analysis.subjects.push_back(std::move(*subject));
  }
  for (const double reference_N : kReferenceForces_N) {
    const ReferenceJnd mean = mean_of(analysis.subjects, reference_N);
    if (mean.rendered_N > 0.0) analysis.means.push_back(mean);
    if (mean.determined) analysis.points.push_back({mean.rendered_N, mean.jnd_N, mean.standard_error_N, "study"});
  }
  if (with_published) analysis.points.push_back(kPangTanDurlach);
  analysis.lines = fit_jnd_lines(analysis.points);
  return analysis;
}

std::string analysis_table(const StudyAnalysis& analysis) {
  std::string text = "subject,reference_N,rendered_N,count,jnd_N,standard_error_N,jnd_percent,determined\n";
  for (const SubjectJnd& subject : analysis.subjects) {
    for (const ReferenceJnd& one : subject.references) text += row(subject.subject, one);
  }
  for (const ReferenceJnd& mean : analysis.means) text += row("mean", mean);
  return text;
}

std::string jnd_file_text(const StudyAnalysis& analysis) {
  using OrderedJson = nlohmann::ordered_json;
  const JndLines& lines = *analysis.lines;
  OrderedJson subjects = OrderedJson::array(), points = OrderedJson::array();
  for (const SubjectJnd& subject : analysis.subjects) subjects.push_back(subject.subject);
  for (const JndPoint& point : analysis.points) {
    OrderedJson entry = {{"reference_N", point.reference_N}, {"jnd_N", point.jnd_N}};
    if (point.standard_error_N > 0.0) entry["standard_error_N"] = point.standard_error_N;
    entry["source"] = point.source;
    points.push_back(entry);
  }
  const OrderedJson document = {
      {"format", "palpate-jnd"},
      {"version", 1},
      {"offset_N", lines.conservative.offset_N},
      {"weber_fraction", lines.conservative.weber_fraction},
      {"criterion", kJndCriterion},
      {"subjects", subjects},
      {"fitted", {{"offset_N", lines.fitted.offset_N}, {"weber_fraction", lines.fitted.weber_fraction}}},
      {"points", points}};
  return document.dump(2) + "\n";
}

}  // namespace palpate
