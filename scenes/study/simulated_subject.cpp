#include "scenes/study/simulated_subject.h"

#include <cmath>
#include <utility>

#include "scenes/study/psychometrics.h"

namespace palpate {
namespace {

double noise_N(const JndLine& jnd, double force_N) {
  static const double kPerJnd = 1.0 / (normal_quantile(kJndCriterion) * std::sqrt(2.0));
  return kPerJnd * jnd.at(force_N);
}

double felt_N(const Stimulus& stroke, std::uint32_t tick) {
  return stroke.size * interval_share(tick) * (*stroke.stroke_N)[tick];
}

}  // namespace

bool SimulatedSubject::second_feels_larger(double first_N, double second_N) noexcept {
  // Every trial draws the same number of random numbers, so that an answer does not change later trials.
  const bool missed = random_.uniform(0.0, 1.0) < 2.0 * traits_.lapse_rate;
  const bool guess = random_.uniform(0.0, 1.0) < 0.5;
  const double first_felt_N = first_N + noise_N(traits_.jnd, first_N) * random_.normal();
  const double second_felt_N = second_N + noise_N(traits_.jnd, second_N) * random_.normal();
  const double bias_N = traits_.order_bias_jnd * traits_.jnd.at(0.5 * (first_N + second_N));
  return missed ? guess : second_felt_N + bias_N > first_felt_N;
}

bool SimulatedSubject::answers_second(const Stimuli& stimuli) noexcept {
  if (stimuli.reminder.stroke_N == nullptr) return second_feels_larger(stimuli.first.size, stimuli.second.size);
  double most = -1.0, reference_N = 0.0, first_N = 0.0, second_N = 0.0;
  for (std::uint32_t i = 0; i < kInterval_ticks; ++i) {
    const double reminder_N = felt_N(stimuli.reminder, i);
    const double one_N = felt_N(stimuli.first, i), other_N = felt_N(stimuli.second, i);
    const double difference = std::abs(one_N - other_N) / traits_.jnd.at(reminder_N);
    if (difference <= most) continue;
    most = difference;
    reference_N = reminder_N;
    first_N = one_N;
    second_N = other_N;
  }
  return second_feels_larger(first_N, second_N) == (2.0 * reference_N > first_N + second_N);
}

std::vector<StudyRecord> simulated_answers(const StudyHeader& header, const SubjectTraits& traits, std::uint64_t seed) {
  const StudyPlan plan = plan_study(header.subject, header.strokes.get());
  SimulatedSubject subject(traits, seed);
  std::vector<StudyRecord> records;
  const auto answer = [&](const std::vector<StudyTrial>& trials, bool training) {
    for (std::size_t i = 0; i < trials.size(); ++i) {
      StudyRecord record;
      record.training = training;
      record.number = i + 1;
      record.trial = trials[i];
      record.first_rendered_N = trials[i].first_N();
      record.second_rendered_N = trials[i].second_N();
      if (header.strokes != nullptr) record.reminder_rendered_N = trials[i].reference_N;
      record.answered_second = subject.answers_second(plan.stimuli(trials[i], training));
      record.device = "simulated";
      records.push_back(std::move(record));
    }
  };
  answer(plan.training, true);
  answer(plan.trials, false);
  return records;
}

}  // namespace palpate
