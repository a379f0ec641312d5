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

using Trials = std::vector<StudyTrial>;

void append(Trials& trials, const Trials& more) { trials.insert(trials.end(), more.begin(), more.end()); }

// The training, with each reference against 60 % and 140 % of it, then the study.
Trials constant_trials(const std::string& code) {
  RandomStream random = subject_random(code, 2);
  Trials all = balanced({0.0, 0.0, false, true}, 2 * kReferenceForces_N.size(), random);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int percent = i % 2 == 0 ? kComparisonPercent.front() : kComparisonPercent.back();
    all[i].reference_N = kReferenceForces_N[i / 2];
    all[i].comparison_N = percent_of(kReferenceForces_N[i / 2], percent);
  }
  shuffle(all, random);
  random = subject_random(code, 1);
  std::vector<Trials> rounds(kRepetitions);
  for (const double reference_N : kReferenceForces_N) {
    for (const int percent : kComparisonPercent) {
      const Trials trials = balanced({reference_N, percent_of(reference_N, percent)}, kRepetitions, random);
      for (std::size_t i = 0; i < rounds.size(); ++i) rounds[i].push_back(trials[i]);
    }
  }
  for (Trials& round : rounds) {
    shuffle(round, random);
    append(all, round);
  }
  return all;
}

Trials stroke_trials(const std::string& code, const StrokePair& strokes) {
  const double reference_N = strokes.reference_mean_N;
  RandomStream random = subject_random(code, 5);
  Trials all = balanced({reference_N, percent_of(reference_N, 100.0 * kEasyShare), false, true}, 4, random);
  random = subject_random(code, 4);
  for (std::size_t i = 0; i < kDiscriminationTrials; i += kDiscriminationBlock)
    append(all, balanced({reference_N, strokes.comparison_mean_N}, kDiscriminationBlock, random));
  return all;
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

std::vector<StudyTrial> plan_study(const std::string& code, const StrokePair* strokes) {
  Trials trials = strokes == nullptr ? constant_trials(code) : stroke_trials(code, *strokes);
  std::size_t training = 0, study = 0;
  for (StudyTrial& trial : trials) trial.number = trial.training ? ++training : ++study;
  return trials;
}

Stimuli stimuli_of(const StudyTrial& trial, const StrokePair* strokes) {
  if (strokes == nullptr) return {Stimulus{}, Stimulus{trial.first_N()}, Stimulus{trial.second_N()}};
  const Stimulus reference{1.0, &strokes->reference_N};
  const Stimulus comparison =
      trial.training ? Stimulus{kEasyShare, &strokes->reference_N} : Stimulus{1.0, &strokes->comparison_N};
  return {reference, trial.comparison_first ? comparison : reference, trial.comparison_first ? reference : comparison};
}

}  // namespace palpate
