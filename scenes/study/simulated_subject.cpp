#include "scenes/study/simulated_subject.h"

#include <cmath>
#include <utility>

#include "scenes/study/study_analysis.h"

namespace palpate {
namespace {

constexpr std::uint64_t kStream = 31;

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
