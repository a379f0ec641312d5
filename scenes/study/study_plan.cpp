#include "scenes/study/study_plan.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

constexpr std::uint64_t kStudySeed = 0x70a1fa7e5eed0001u;  // fixed, so that the plan depends on the subject code only
constexpr std::size_t kMostLetters = 3;
constexpr std::size_t kMostDigits = 4;
constexpr std::uint64_t kConstantStream = 1;
constexpr std::uint64_t kTrainingStream = 2;
constexpr std::uint64_t kDiscriminationStream = 4;
constexpr std::uint64_t kDiscriminationTrainingStream = 5;
constexpr std::size_t kDiscriminationTraining = 4;
constexpr double kEasyShare = 0.5;

bool is_code(const std::string& text) {
  std::size_t letters = 0;
  while (letters < text.size() && text[letters] >= 'A' && text[letters] <= 'Z') ++letters;
  std::size_t digits = 0;
  while (letters + digits < text.size() && text[letters + digits] >= '0' && text[letters + digits] <= '9') ++digits;
  return letters >= 1 && letters <= kMostLetters && digits >= 1 && digits <= kMostDigits &&
         letters + digits == text.size();
}

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

// The 320 trials.
std::vector<StudyTrial> constant_trials(const std::string& code) {
  RandomStream random = subject_random(code, kConstantStream);
  std::vector<std::vector<StudyTrial>> rounds(kRepetitions);
  for (const double reference_N : kReferenceForces_N) {
    for (const int percent : kComparisonPercent) {
      const std::vector<bool> first = balanced_flags(kRepetitions, random);
      for (std::size_t i = 0; i < rounds.size(); ++i) {
        rounds[i].push_back({reference_N, percent_of(reference_N, percent), first[i]});
      }
    }
  }
  std::vector<StudyTrial> trials;
  for (std::vector<StudyTrial>& round : rounds) {
    shuffle(round, random);
    trials.insert(trials.end(), round.begin(), round.end());
  }
  return trials;
}

// Each reference against 60 % and 140 %.
std::vector<StudyTrial> constant_training(const std::string& code) {
  RandomStream random = subject_random(code, kTrainingStream);
  const std::vector<bool> first = balanced_flags(2 * kReferenceForces_N.size(), random);
  std::vector<StudyTrial> trials;
  for (const double reference_N : kReferenceForces_N) {
    for (const int percent : {kComparisonPercent.front(), kComparisonPercent.back()}) {
      trials.push_back({reference_N, percent_of(reference_N, percent), first[trials.size()]});
    }
  }
  shuffle(trials, random);
  return trials;
}

// `count` trials of these two; in each block the comparison comes first in half of the trials.
std::vector<StudyTrial> stroke_trials(RandomStream random, double reference_N, double comparison_N, std::size_t count,
                                      std::size_t block) {
  std::vector<StudyTrial> trials;
  while (trials.size() < count) {
    for (const bool first : balanced_flags(block, random)) trials.push_back({reference_N, comparison_N, first});
  }
  return trials;
}

}  // namespace

double percent_of(double reference_N, double percent) noexcept {
  return std::round(reference_N * percent * 100.0) / 1e4;
}

Status check_subject_code(const std::string& code) {
  if (is_code(code)) return {};
  return Error{"found the subject \"" + code +
               "\", expected a code of one to three capital letters and one to four digits, such as S01; "
               "names are not stored"};
}

StudyPlan plan_study(const std::string& code, const StrokePair* strokes) {
  if (strokes == nullptr) return {nullptr, constant_training(code), constant_trials(code)};
  const double reference_N = strokes->reference_mean_N;
  StudyPlan plan{strokes, {}, {}, kDiscriminationBlock};
  plan.training =
      stroke_trials(subject_random(code, kDiscriminationTrainingStream), reference_N,
                    percent_of(reference_N, 100.0 * kEasyShare), kDiscriminationTraining, kDiscriminationTraining);
  plan.trials = stroke_trials(subject_random(code, kDiscriminationStream), reference_N, strokes->comparison_mean_N,
                              kDiscriminationTrials, kDiscriminationBlock);
  return plan;
}

Stimuli StudyPlan::stimuli(const StudyTrial& trial, bool in_training) const {
  if (strokes == nullptr) return {{trial.first_N()}, {trial.second_N()}, {}};
  const Stimulus reference{1.0, &strokes->reference_N};
  const Stimulus comparison =
      in_training ? Stimulus{kEasyShare, &strokes->reference_N} : Stimulus{1.0, &strokes->comparison_N};
  if (trial.comparison_first) return {comparison, reference, reference};
  return {reference, comparison, reference};
}

}  // namespace palpate
