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

}  // namespace

bool SimulatedSubject::second_feels_larger(double first_N, double second_N) noexcept {
  // Always the same number of draws, so that trials do not shift each other.
  const bool missed = random_.uniform(0.0, 1.0) < 2.0 * traits_.lapse_rate;
  const bool guess = random_.uniform(0.0, 1.0) < 0.5;
  const double first_felt_N = first_N + noise_N(traits_.jnd, first_N) * random_.normal();
  const double second_felt_N = second_N + noise_N(traits_.jnd, second_N) * random_.normal();
  const double bias_N = traits_.order_bias_jnd * traits_.jnd.at(0.5 * (first_N + second_N));
  return missed ? guess : second_felt_N + bias_N > first_felt_N;
}

bool SimulatedSubject::second_feels_like(const std::vector<double>& reference_N, const std::vector<double>& first_N,
                                         const std::vector<double>& second_N) noexcept {
  std::size_t moment = 0;
  double most = -1.0;
  for (std::size_t i = 0; i < reference_N.size(); ++i) {
    const double difference = std::abs(first_N[i] - second_N[i]) / traits_.jnd.at(reference_N[i]);
    if (difference <= most) continue;
    most = difference;
    moment = i;
  }
  const double reference = reference_N[moment], first = first_N[moment], second = second_N[moment];
  const bool reference_is_larger = 2.0 * reference > first + second;
  return second_feels_larger(first, second) == reference_is_larger;
}

namespace {

// What the hand was given in the presentation that is going on, tick by tick.
struct Felt {
  std::vector<double> reminder_N, first_N, second_N;

  void take(const PresentationState& state, double force_N) {
    if (state.phase == PresentationPhase::lead_in) *this = {};
    if (state.phase == PresentationPhase::reminder) reminder_N.push_back(force_N);
    if (state.phase == PresentationPhase::first) first_N.push_back(force_N);
    if (state.phase == PresentationPhase::second) second_N.push_back(force_N);
  }
};

}  // namespace

Result<std::vector<StudyRecord>> run_simulated_session(const StudyHeader& header, const SubjectTraits& traits,
                                                       std::uint64_t seed) {
  constexpr std::uint64_t kRest_ticks = 1;
  auto session = StudySession::create(header, std::make_unique<MemoryStore>(), kRest_ticks);
  if (!session) return session.error();
  StudySession& study = **session;
  SimulatedSubject subject(traits, seed);
  Felt felt;
  study.accept_consent("simulated");
  double rendered_N = 0.0;
  while (study.state() != StudyState::done) {
    rendered_N = study.tick(rendered_N);
    study.update();
    const PresentationState& state = study.presentation();
    if (header.strokes != nullptr) felt.take(state, rendered_N);
    if (study.state() == StudyState::answering) {
      study.answer(header.strokes != nullptr
                       ? subject.second_feels_like(felt.reminder_N, felt.first_N, felt.second_N)
                       : subject.second_feels_larger(state.first_rendered_N, state.second_rendered_N));
    }
    study.proceed();
  }
  return study.store().records();
}

}  // namespace palpate
