#include "scenes/study/study_plan.h"

#include <cmath>

namespace palpate {
namespace {

constexpr std::uint64_t kStudySeed = 0x70a1fa7e5eed0001u;  // fixed: codes alone differ
constexpr std::size_t kMostLetters = 3;
constexpr std::size_t kMostDigits = 4;
constexpr std::uint64_t kConstantStream = 1;
constexpr std::uint64_t kTrainingStream = 2;
constexpr std::uint64_t kDiscriminationStream = 4;
constexpr std::uint64_t kDiscriminationTrainingStream = 5;
constexpr std::size_t kDiscriminationTraining = 4;

bool is_code(const std::string& text) {
  std::size_t letters = 0;
  while (letters < text.size() && text[letters] >= 'A' && text[letters] <= 'Z') ++letters;
  std::size_t digits = 0;
  while (letters + digits < text.size() && text[letters + digits] >= '0' && text[letters + digits] <= '9') ++digits;
  return letters >= 1 && letters <= kMostLetters && digits >= 1 && digits <= kMostDigits &&
         letters + digits == text.size();
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

RandomStream subject_random(const std::string& code, std::uint64_t stream) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const char letter : code) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
  return {hash ^ kStudySeed, stream};
}

std::vector<bool> balanced_flags(std::size_t count, RandomStream& random) {
  std::vector<std::uint8_t> flags(count, 0);
  for (std::size_t i = 0; i < count / 2; ++i) flags[i] = 1;
  shuffle(flags, random);
  return {flags.begin(), flags.end()};
}

std::vector<StudyTrial> plan_constant_trials(const std::string& code) {
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

std::vector<StudyTrial> plan_training_trials(const std::string& code) {
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

std::vector<StudyTrial> plan_discrimination_trials(const std::string& code, double reference_mean_N,
                                                   double comparison_mean_N) {
  RandomStream random = subject_random(code, kDiscriminationStream);
  std::vector<StudyTrial> trials;
  while (trials.size() < kDiscriminationTrials) {
    for (const bool first : balanced_flags(kDiscriminationBlock, random)) {
      trials.push_back({reference_mean_N, comparison_mean_N, first});
    }
  }
  return trials;
}

std::vector<StudyTrial> plan_discrimination_training(const std::string& code, double reference_mean_N) {
  RandomStream random = subject_random(code, kDiscriminationTrainingStream);
  std::vector<StudyTrial> trials;
  for (const bool first : balanced_flags(kDiscriminationTraining, random)) {
    trials.push_back({reference_mean_N, percent_of(reference_mean_N, 100.0 * kEasyShare), first});
  }
  return trials;
}

const char* procedure_name(ProcedureKind kind) noexcept {
  return kind == ProcedureKind::constant ? "constant" : "discriminate";
}

Result<ProcedureKind> find_procedure(const std::string& name) {
  for (const ProcedureKind kind : {ProcedureKind::constant, ProcedureKind::discriminate}) {
    if (name == procedure_name(kind)) return kind;
  }
  return Error{"found the procedure \"" + name + "\", expected constant or discriminate"};
}

StudyPlan plan_study(ProcedureKind kind, const std::string& code, const StrokePair* strokes) {
  if (kind == ProcedureKind::constant) return {kind, plan_training_trials(code), plan_constant_trials(code)};
  return {kind, plan_discrimination_training(code, strokes->reference_mean_N),
          plan_discrimination_trials(code, strokes->reference_mean_N, strokes->comparison_mean_N),
          kDiscriminationBlock};
}

Stimuli StudyPlan::stimuli(const StudyTrial& trial, bool in_training) const {
  if (kind == ProcedureKind::constant) return {{trial.first_N()}, {trial.second_N()}, false, {}};
  const Stimulus reference{1.0, StimulusKind::reference};
  const Stimulus comparison =
      in_training ? Stimulus{kEasyShare, StimulusKind::reference} : Stimulus{1.0, StimulusKind::comparison};
  return {trial.comparison_first ? comparison : reference, trial.comparison_first ? reference : comparison, true,
          reference};
}

}  // namespace palpate
