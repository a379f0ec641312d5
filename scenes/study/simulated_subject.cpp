#include "scenes/study/simulated_subject.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "scenes/study/psychometrics.h"
#include "scenes/study/study_session.h"

namespace palpate {
namespace {

double noise_N(const JndLine& jnd, double force_N) {
  static const double kPerJnd = 1.0 / (normal_quantile(kJndCriterion) * std::sqrt(2.0));
  return kPerJnd * jnd.at(force_N);
}

// The difference that is told apart with z standard deviations; its sign is that of z.
double difference_at(const JndLine& jnd, double reference_N, double z) {
  double low = z < 0.0 ? -reference_N : 0.0, high = z < 0.0 ? 0.0 : 100.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    const double noise = std::hypot(noise_N(jnd, reference_N), noise_N(jnd, reference_N + middle));
    (middle < z * noise ? low : high) = middle;
  }
  return low;
}

}  // namespace

double true_relative_jnd(const JndLine& jnd, double reference_N, double criterion) {
  const double z = normal_quantile(criterion);
  return 0.5 * (difference_at(jnd, reference_N, z) - difference_at(jnd, reference_N, -z)) / reference_N;
}

bool SimulatedSubject::second_feels_larger(double first_N, double second_N) noexcept {
  // Always the same number of draws, so that trials do not shift each other.
  const bool missed = random_.uniform(0.0, 1.0) < 2.0 * traits_.lapse_rate;
  const bool guess = random_.uniform(0.0, 1.0) < 0.5;
  const double first_felt_N = first_N + noise_N(traits_.jnd, first_N) * random_.normal();
  const double second_felt_N = second_N + noise_N(traits_.jnd, second_N) * random_.normal();
  const double bias_N = traits_.order_bias_jnd * traits_.jnd.at(0.5 * (first_N + second_N));
  return missed ? guess : second_felt_N + bias_N > first_felt_N;
}

Result<std::vector<StudyRecord>> run_simulated_session(const StudyHeader& header, const SubjectTraits& traits,
                                                       std::uint64_t seed) {
  constexpr std::uint64_t kRest_ticks = 1;
  auto session = StudySession::create(header, std::make_unique<MemoryStore>(), kRest_ticks);
  if (!session) return session.error();
  StudySession& study = **session;
  SimulatedSubject subject(traits, seed);
  study.accept_consent("simulated");
  double rendered_N = 0.0;
  while (study.state() != StudyState::done) {
    rendered_N = study.tick(rendered_N);
    study.update();
    if (study.state() == StudyState::answering) {
      const PresentationState& felt = study.presentation();
      study.answer(subject.second_feels_larger(felt.first_rendered_N, felt.second_rendered_N));
    }
    study.proceed();
  }
  return study.store().records();
}

}  // namespace palpate
