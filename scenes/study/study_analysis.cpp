#include "scenes/study/study_analysis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "engine/base/random_stream.h"
#include "engine/base/text.h"
#include "scenes/evaluation/model_errors.h"

namespace palpate {
namespace {

constexpr double kFlattestSlope = 0.25;
constexpr double kSteepestSlope = 40.0;
constexpr double kLargestBias = 3.0;
constexpr double kLapseStep = 0.01;
constexpr int kLapseSteps = 6;
constexpr double kConverged = 1e-9;  // of the log likelihood
// The answers bound a slope if the log likelihood at both ends of the range is lower than at the fit by at least this,
// which is a likelihood ratio of 1.1.
constexpr double kNoticeablyWorse = 0.1;
constexpr double kLeastProbability = 1e-12;

using Cells = std::vector<AnswerCell>;

// The argument at which `function`, with one maximum between `low` and `high`, is largest, to 1e-7: golden-section
// search (Kiefer 1953).
template <typename Function>
double maximum_between(double low, double high, const Function& function) {
  double best = high - (high - low) / std::numbers::phi, at_best = function(best);
  while (high - low > 1e-7) {
    const double other = low + high - best, at_other = function(other);
    ((other < best) == (at_other > at_best) ? high : low) = at_other > at_best ? best : other;
    if (at_other > at_best) {
      best = other;
      at_best = at_other;
    }
  }
  return 0.5 * (low + high);
}

// Phi.
double normal_cdf(double z) noexcept { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double log_likelihood(const Cells& cells, const PsychometricFunction& function) {
  double sum = 0.0;
  for (const AnswerCell& cell : cells) {
    const double p =
        std::clamp(function.at(cell.difference, cell.comparison_first), kLeastProbability, 1.0 - kLeastProbability);
    sum += cell.judged_larger * std::log(p) + (cell.trials - cell.judged_larger) * std::log1p(-p);
  }
  return sum;
}

// The function of one reference force with the most likely slope.
PsychometricFunction with_best_slope(const Cells& cells, PsychometricFunction function) {
  function.slope = std::exp(maximum_between(std::log(kFlattestSlope), std::log(kSteepestSlope), [&](double log_slope) {
    function.slope = std::exp(log_slope);
    return log_likelihood(cells, function);
  }));
  return function;
}

bool bounds_slope(const Cells& cells, const PsychometricFunction& fitted) {
  const double limit = log_likelihood(cells, fitted) - kNoticeablyWorse;
  PsychometricFunction flattest = fitted, steepest = fitted;
  flattest.slope = kFlattestSlope;
  steepest.slope = kSteepestSlope;
  return log_likelihood(cells, flattest) < limit && log_likelihood(cells, steepest) < limit;
}

constexpr std::size_t kReferences = kReferenceForces_N.size();
constexpr double kNormal95 = 1.9599639845400542;  // Phi^-1(0.975), for intervals of 95 %

bool is_usable(const StudyRecord& record) {
  const auto deviates = [](double planned_N, double rendered_N) {
    return std::abs(rendered_N - planned_N) > 0.5 * JndLine{}.at(planned_N);
  };
  return record.rendered && !deviates(record.trial.first_N(), record.first_rendered_N) &&
         !deviates(record.trial.second_N(), record.second_rendered_N);
}

Result<SubjectJnd> jnds_of(const StudyData& data) {
  SubjectJnd result{data.header.subject, 0, {}};
  std::array<Moments, kReferences> rendered_N;
  std::vector<AnswerCell> answers;
  for (const StudyRecord& record : data.records) {
    const StudyTrial& trial = record.trial;
    if (trial.training) continue;
    if (!is_usable(record)) {
      ++result.unusable;
      continue;
    }
    const auto* const found = std::ranges::find(kReferenceForces_N, trial.reference_N);
    const auto r = static_cast<std::size_t>(found - kReferenceForces_N.begin());
    rendered_N.at(r).add(record.reference_rendered_N());
    answers.push_back(
        {r, record.rendered_difference(), trial.comparison_first, record.comparison_judged_larger() ? 1.0 : 0.0, 1.0});
  }
  if (answers.empty()) return Error{"found no usable answer of subject " + result.subject + "; leave the file out"};
  const auto functions = fit_psychometric(answers, kReferences);
  for (std::size_t r = 0; r < kReferences; ++r) {
    const double mean_N = rendered_N[r].mean();
    result.references[r] = {kReferenceForces_N[r],       mean_N, rendered_N[r].count(),
                            mean_N * functions[r].jnd(), 0.0,    functions[r].determined};
  }
  return result;
}

// Mean and standard error of the subjects' JNDs at reference force `r`.
ReferenceJnd mean_of(const std::vector<SubjectJnd>& subjects, std::size_t r) {
  Moments rendered_N, jnd_N;
  for (const SubjectJnd& subject : subjects) {
    const ReferenceJnd& one = subject.references[r];
    if (one.count > 0) rendered_N.add(one.rendered_N);
    if (one.determined) jnd_N.add(one.jnd_N);
  }
  const std::size_t count = jnd_N.count();
  const double error_N = count > 1 ? jnd_N.deviation() / std::sqrt(static_cast<double>(count) - 1.0) : 0.0;
  return {kReferenceForces_N[r], rendered_N.mean(), count, jnd_N.mean(), error_N, count > 0};
}

std::string row(const std::string& subject, const ReferenceJnd& one) {
  if (one.rendered_N == 0.0) return "";
  char text[256];
  std::snprintf(text, sizeof text, "%s,%.4g,%.5g,%zu,%.5f,%.5f,%.2f,%s\n", subject.c_str(), one.reference_N,
                one.rendered_N, one.count, one.jnd_N, one.standard_error_N, 100.0 * one.jnd_N / one.rendered_N,
                one.determined ? "yes" : "no");
  return text;
}

constexpr std::uint64_t kStream = 31;

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

// Whether the second of two forces is perceived as the larger. Draws the same number of random numbers for every trial,
// so that an answer does not change later trials.
bool second_feels_larger(const SubjectTraits& traits, double first_N, double second_N, RandomStream& random) noexcept {
  const double noise_per_jnd = 1.0 / (kCriterionQuantile * std::sqrt(2.0));
  const auto perceived_N = [&](double force_N) {
    return force_N + noise_per_jnd * traits.jnd.at(force_N) * random.normal();
  };
  const bool missed = random.uniform(0.0, 1.0) < 2.0 * traits.lapse_rate;
  const bool guess = random.uniform(0.0, 1.0) < 0.5;
  const double first_perceived_N = perceived_N(first_N), second_perceived_N = perceived_N(second_N);
  const double bias_N = traits.order_bias_jnd * traits.jnd.at(0.5 * (first_N + second_N));
  return missed ? guess : second_perceived_N + bias_N > first_perceived_N;
}

// Whether the answer is "second": the larger of two forces, or the stroke that equals the reminder.
bool answers_second(const SubjectTraits& traits, const Stimuli& stimuli, RandomStream& random) {
  const Stimulus &reminder = stimuli[0], &first = stimuli[1], &second = stimuli[2];
  if (!has_reminder(stimuli)) return second_feels_larger(traits, first.size, second.size, random);
  const auto difference = [&](std::uint32_t tick) {
    return std::abs(first.force_N(tick) - second.force_N(tick)) / traits.jnd.at(reminder.force_N(tick));
  };
  std::uint32_t most = 0;
  for (std::uint32_t tick = 1; tick < kInterval_ticks; ++tick)
    if (difference(tick) > difference(most)) most = tick;
  const double first_N = first.force_N(most), second_N = second.force_N(most);
  return second_feels_larger(traits, first_N, second_N, random) == (2.0 * reminder.force_N(most) > first_N + second_N);
}

}  // namespace

double PsychometricFunction::at(double difference, bool comparison_first) const noexcept {
  return lapse + (1.0 - 2.0 * lapse) * normal_cdf(slope * difference + (comparison_first ? -order_bias : order_bias));
}

// For a given bias and lapse rate the reference forces are independent, so that the likelihood is maximised by nested
// searches: over the lapse rate, the bias, and the slope of each reference force.
std::vector<PsychometricFunction> fit_psychometric(const Cells& cells, std::size_t references) {
  std::vector<Cells> of_reference(references);
  for (const AnswerCell& cell : cells) of_reference[cell.reference].push_back(cell);
  PsychometricFunction shared;
  const auto best_at = [&](double bias) {
    shared.order_bias = bias;
    double sum = 0.0;
    for (const Cells& own : of_reference) sum += log_likelihood(own, with_best_slope(own, shared));
    return sum;
  };
  PsychometricFunction best;
  double most_likely = 0.0;
  for (int i = 0; i <= kLapseSteps; ++i) {
    shared.lapse = kLapseStep * i;
    const double reached = best_at(maximum_between(-kLargestBias, kLargestBias, best_at));
    if (i > 0 && !(reached > most_likely + kConverged)) break;  // the likelihood has one maximum over the lapse rate
    most_likely = reached;
    best = shared;
  }
  std::vector<PsychometricFunction> functions;
  for (const Cells& own : of_reference) {
    functions.push_back(with_best_slope(own, best));
    functions.back().determined = bounds_slope(own, functions.back());
  }
  return functions;
}

Result<JndLines> fit_jnd_lines(const std::vector<JndPoint>& points) {
  double count = 0.0, mean_force = 0.0, mean_jnd = 0.0, squares = 0.0, products = 0.0;
  for (const JndPoint& point : points) {  // Welford (1962)
    const double force = point.reference_N - mean_force;
    mean_force += force / ++count;
    mean_jnd += (point.jnd_N - mean_jnd) / count;
    squares += force * (point.reference_N - mean_force);
    products += force * (point.jnd_N - mean_jnd);
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
  StudyAnalysis analysis;
  for (const StudyData& file : files) {
    auto subject = jnds_of(file);
    if (!subject) return subject.error();
    analysis.subjects.push_back(std::move(*subject));
  }
  analysis.mean.subject = "mean";
  for (std::size_t r = 0; r < kReferences; ++r) {
    const ReferenceJnd& mean = analysis.mean.references[r] = mean_of(analysis.subjects, r);
    if (mean.determined) analysis.points.push_back({mean.rendered_N, mean.jnd_N, mean.standard_error_N, "study"});
  }
  if (with_published) analysis.points.push_back(kPangTanDurlach);
  analysis.lines = fit_jnd_lines(analysis.points);
  return analysis;
}

std::string analysis_table(const StudyAnalysis& analysis) {
  std::string text = "subject,reference_N,rendered_N,count,jnd_N,standard_error_N,jnd_percent,determined\n";
  for (const SubjectJnd& subject : analysis.subjects)
    for (const ReferenceJnd& one : subject.references) text += row(subject.subject, one);
  for (const ReferenceJnd& mean : analysis.mean.references) text += row(analysis.mean.subject, mean);
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

CorrectShare correct_share(const Discrimination& result) noexcept {
  if (result.trials == 0) return {};
  const double n = static_cast<double>(result.trials), share = static_cast<double>(result.correct) / n;
  const double z2 = kNormal95 * kNormal95 / n;
  const double middle = (share + 0.5 * z2) / (1.0 + z2);
  const double half = std::sqrt(share * (1.0 - share) * z2 + 0.25 * z2 * z2) / (1.0 + z2);
  return {share, std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::string discrimination_verdict(const Discrimination& result, const StrokePair& strokes) {
  const std::string most = fixed(strokes.max_over_jnd, 2), mean = fixed(strokes.mean_over_jnd, 2);
  const bool below = strokes.max_over_jnd <= 1.0, above = strokes.mean_over_jnd > 1.0;
  const std::string prediction =
      below   ? "Predicted below the JND (at most " + most + " of it). "
      : above ? "Predicted above the JND (" + mean + " of it on average). "
              : "Above the JND for a moment only (at most " + most + " of it, on average " + mean + "). ";
  if (result.trials == 0) return prediction + "No usable answers yet.";
  const auto [share, low, high] = correct_share(result);
  const bool found_below = high < kJndCriterion;
  const std::string agreement = !found_below && low <= kJndCriterion
                                    ? "too few answers to decide, the interval contains 75 %."
                                : below || above ? (found_below == below ? "consistent." : "not consistent.")
                                : found_below    ? "less noticeable than one JND."
                                                 : "more noticeable than one JND.";
  return prediction + fixed(100.0 * share, 0) + " % right [" + fixed(100.0 * low, 0) + " to " + fixed(100.0 * high, 0) +
         "], " + (low > 0.5 ? "more than by guessing" : "as by guessing") + "; 75 % would be one JND: " + agreement;
}

Result<std::vector<Discrimination>> analyse_discrimination(const std::vector<StudyData>& files) {
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
    const auto [share, low, high] = correct_share(one);
    char text[320];
    std::snprintf(text, sizeof text, "%s,%zu,%zu,%zu,%.4f,%.4f,%.4f,%.4f,%.4f\n", one.subject.c_str(), one.trials,
                  one.correct, one.unusable, share, low, high, strokes.mean_over_jnd, strokes.max_over_jnd);
    table += text;
  }
  return table;
}

std::vector<StudyRecord> simulated_answers(const StudyHeader& header, const SubjectTraits& traits, std::uint64_t seed) {
  const StrokePair* strokes = header.strokes.get();
  RandomStream random(seed, kStream);
  std::vector<StudyRecord> records;
  for (const StudyTrial& trial : plan_study(header.subject, strokes)) {
    StudyRecord record{trial, trial.first_N(), trial.second_N()};
    if (strokes != nullptr) record.reminder_rendered_N = trial.reference_N;
    record.answered_second = answers_second(traits, stimuli_of(trial, strokes), random);
    record.device = "simulated";
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace palpate
