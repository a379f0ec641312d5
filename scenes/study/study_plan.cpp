#include "scenes/study/study_plan.h"

#include <cmath>
#include <regex>
#include <utility>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

constexpr std::uint64_t kStudySeed = 0x70a1fa7e5eed0001u;  // fixed, so that the plan depends on the subject code only
constexpr std::size_t kDiscriminationTraining = 4;
constexpr double kEasyShare = 0.5;

// Random numbers of this subject; each use has its own `stream`.
RandomStream subject_random(const std::string& code, std::uint64_t stream) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const char letter : code) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
  return {hash ^ kStudySeed, stream};
}

// Shuffles in place (Fisher & Yates).
template <typename T>
void shuffle(std::vector<T>& values, RandomStream& random) {
  for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random.index(i)]);
}

// `count` flags (even), half of them set, shuffled.
std::vector<bool> balanced_flags(std::size_t count, RandomStream& random) {
  std::vector<std::uint8_t> flags(count, 0);
  for (std::size_t i = 0; i < count / 2; ++i) flags[i] = 1;
  shuffle(flags, random);
  return {flags.begin(), flags.end()};
}

// Each reference against 60 % and 140 %.
std::vector<StudyTrial> constant_training(RandomStream random) {
  const std::vector<bool> first = balanced_flags(2 * kReferenceForces_N.size(), random);
  std::vector<StudyTrial> trials;
  for (const double reference_N : kReferenceForces_N) {
    for (const int percent : {kComparisonPercent.front(), kComparisonPercent.back()})
      trials.push_back({reference_N, percent_of(reference_N, percent), first[trials.size()], true});
  }
  shuffle(trials, random);
  return trials;
}

// Appends the 320 trials.
void add_constant_trials(std::vector<StudyTrial>& trials, RandomStream random) {
  std::vector<std::vector<StudyTrial>> rounds(kRepetitions);
  for (const double reference_N : kReferenceForces_N) {
    for (const int percent : kComparisonPercent) {
      const std::vector<bool> first = balanced_flags(kRepetitions, random);
      for (std::size_t i = 0; i < rounds.size(); ++i)
        rounds[i].push_back({reference_N, percent_of(reference_N, percent), first[i]});
    }
  }
  for (std::vector<StudyTrial>& round : rounds) {
    shuffle(round, random);
    trials.insert(trials.end(), round.begin(), round.end());
  }
}

// Appends a block of trials of these two; the comparison comes first in half of them.
void add_stroke_block(std::vector<StudyTrial>& trials, RandomStream& random, const StudyTrial& trial,
                      std::size_t count) {
  for (const bool first : balanced_flags(count, random))
    trials.push_back({trial.reference_N, trial.comparison_N, first, trial.training});
}

}  // namespace

double percent_of(double reference_N, double percent) noexcept {
  return std::round(reference_N * percent * 100.0) / 1e4;
}

Status check_subject_code(const std::string& code) {
  static const std::regex kCode("[A-Z]{1,3}[0-9]{1,4}");
  if (std::regex_match(code, kCode)) return {};
  return Error{"found the subject \"" + code +
               "\", expected a code of one to three capital letters and one to four digits, such as S01; "
               "names are not stored"};
}

StudyPlan plan_study(const std::string& code, const StrokePair* strokes) {
  StudyPlan plan{strokes, {}};
  if (strokes == nullptr) {
    plan.trials = constant_training(subject_random(code, 2));
    plan.training = plan.trials.size();
    add_constant_trials(plan.trials, subject_random(code, 1));
    return plan;
  }
  const double reference_N = strokes->reference_mean_N;
  RandomStream random = subject_random(code, 5);
  add_stroke_block(plan.trials, random, {reference_N, percent_of(reference_N, 100.0 * kEasyShare), false, true},
                   kDiscriminationTraining);
  plan.training = kDiscriminationTraining;
  plan.block = kDiscriminationBlock;
  random = subject_random(code, 4);
  while (plan.trials.size() < plan.training + kDiscriminationTrials)
    add_stroke_block(plan.trials, random, {reference_N, strokes->comparison_mean_N}, kDiscriminationBlock);
  return plan;
}

Stimuli StudyPlan::stimuli(const StudyTrial& trial) const {
  if (strokes == nullptr) return {{trial.first_N()}, {trial.second_N()}, {}};
  const Stimulus reference{1.0, &strokes->reference_N};
  const Stimulus comparison =
      trial.training ? Stimulus{kEasyShare, &strokes->reference_N} : Stimulus{1.0, &strokes->comparison_N};
  if (trial.comparison_first) return {comparison, reference, reference};
  return {reference, comparison, reference};
}

}  // namespace palpate
