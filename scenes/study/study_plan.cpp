#include "scenes/study/study_plan.h"

#include <cmath>
#include <regex>
#include <utility>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

// Fixed, so that the plan depends on the subject code only.
constexpr std::uint64_t kStudySeed = 0x70a1fa7e5eed0001u;
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

// The trial `count` times (even), the comparison first in half of them, shuffled.
std::vector<StudyTrial> balanced(StudyTrial trial, std::size_t count, RandomStream& random) {
  std::vector<StudyTrial> trials(count, trial);
  for (std::size_t i = 0; i < count / 2; ++i) trials[i].comparison_first = true;
  shuffle(trials, random);
  return trials;
}

void append(std::vector<StudyTrial>& trials, const std::vector<StudyTrial>& more) {
  trials.insert(trials.end(), more.begin(), more.end());
}

// Each reference against 60 % and 140 %, then the study.
void add_constant_trials(StudyPlan& plan, const std::string& code) {
  RandomStream random = subject_random(code, 2);
  plan.trials = balanced({0.0, 0.0, false, true}, 2 * kReferenceForces_N.size(), random);
  for (std::size_t i = 0; i < plan.trials.size(); ++i) {
    const int percent = i % 2 == 0 ? kComparisonPercent.front() : kComparisonPercent.back();
    plan.trials[i].reference_N = kReferenceForces_N[i / 2];
    plan.trials[i].comparison_N = percent_of(kReferenceForces_N[i / 2], percent);
  }
  shuffle(plan.trials, random);
  random = subject_random(code, 1);
  std::vector<std::vector<StudyTrial>> rounds(kRepetitions);
  for (const double reference_N : kReferenceForces_N) {
    for (const int percent : kComparisonPercent) {
      const auto trials = balanced({reference_N, percent_of(reference_N, percent)}, kRepetitions, random);
      for (std::size_t i = 0; i < rounds.size(); ++i) rounds[i].push_back(trials[i]);
    }
  }
  for (std::vector<StudyTrial>& round : rounds) {
    shuffle(round, random);
    append(plan.trials, round);
  }
}

void add_stroke_trials(StudyPlan& plan, const std::string& code) {
  const double reference_N = plan.strokes->reference_mean_N;
  RandomStream random = subject_random(code, 5);
  plan.trials = balanced({reference_N, percent_of(reference_N, 100.0 * kEasyShare), false, true}, 4, random);
  plan.block = kDiscriminationBlock;
  random = subject_random(code, 4);
  for (std::size_t i = 0; i < kDiscriminationTrials; i += plan.block)
    append(plan.trials, balanced({reference_N, plan.strokes->comparison_mean_N}, plan.block, random));
}

}  // namespace

double percent_of(double reference_N, double percent) noexcept {
  return std::round(reference_N * percent * 100.0) / 1e4;
}

Status check_subject_code(const std::string& code) {
  static const std::regex kCode("[A-Z]{1,3}[0-9]{1,4}");
  if (std::regex_match(code, kCode)) return {};
  return Error{"found the subject \"" + code +
               "\", expected a code of one to three capital letters and one to four digits, such as S01; names are "
               "not stored"};
}

StudyPlan plan_study(const std::string& code, const StrokePair* strokes) {
  StudyPlan plan{strokes, {}};
  strokes == nullptr ? add_constant_trials(plan, code) : add_stroke_trials(plan, code);
  std::size_t study = 0;
  for (StudyTrial& trial : plan.trials) trial.number = trial.training ? ++plan.training : ++study;
  return plan;
}

Stimuli StudyPlan::stimuli(const StudyTrial& trial) const {
  if (strokes == nullptr) return {Stimulus{}, Stimulus{trial.first_N()}, Stimulus{trial.second_N()}};
  const Stimulus reference{1.0, &strokes->reference_N};
  const Stimulus comparison =
      trial.training ? Stimulus{kEasyShare, &strokes->reference_N} : Stimulus{1.0, &strokes->comparison_N};
  return {reference, trial.comparison_first ? comparison : reference, trial.comparison_first ? reference : comparison};
}

}  // namespace palpate
