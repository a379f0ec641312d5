#include "scenes/study/study_procedure.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "scenes/study/quest_plus.h"

namespace palpate {
namespace {

class ConstantStimuli final : public StudyProcedure {
 public:
  explicit ConstantStimuli(const std::string& code)
      : trials_(plan_constant_trials(code)), training_(plan_training_trials(code)) {}

  std::size_t trial_count() const noexcept override { return trials_.size(); }
  std::size_t trials_per_block() const noexcept override { return 64; }  // two repetitions of each pair
  std::vector<StudyTrial> training() const override { return training_; }
  StudyTrial next() const override { return trials_[answered_]; }
  void answered(bool) override { ++answered_; }

 private:
  std::vector<StudyTrial> trials_;
  std::vector<StudyTrial> training_;
};

class ReminderTrials final : public StudyProcedure {
 public:
  ReminderTrials(const std::string& code, const StrokePair& strokes)
      : trials_(plan_discrimination_trials(code, strokes.reference_mean_N, strokes.comparison_mean_N)),
        training_(plan_discrimination_training(code, strokes.reference_mean_N)) {}

  std::size_t trial_count() const noexcept override { return trials_.size(); }
  std::size_t trials_per_block() const noexcept override { return kDiscriminationBlock; }
  std::vector<StudyTrial> training() const override { return training_; }
  StudyTrial next() const override { return trials_[answered_]; }
  void answered(bool) override { ++answered_; }

  Stimuli stimuli(const StudyTrial& trial, bool training) const override {
    const Stimulus reference{1.0, StimulusKind::reference};
    const Stimulus comparison = training ? Stimulus{kEasyShare, StimulusKind::reference} : Stimulus{1.0, StimulusKind::comparison};
    return {trial.comparison_first ? comparison : reference, trial.comparison_first ? reference : comparison, true,
            reference};
  }

 private:
  std::vector<StudyTrial> trials_;
  std::vector<StudyTrial> training_;
};

class Adaptive final : public StudyProcedure {
 public:
  explicit Adaptive(const std::string& code)
      : slots_(plan_adaptive_slots(code)), training_(plan_training_trials(code)) {
    choose();
  }

  std::size_t trial_count() const noexcept override { return slots_.size(); }
  std::size_t trials_per_block() const noexcept override { return 40; }
  std::vector<StudyTrial> training() const override { return training_; }
  StudyTrial next() const override { return trial_; }

  void answered(bool comparison_judged_larger) override {
    const double difference = (trial_.comparison_N - trial_.reference_N) / trial_.reference_N;
    beliefs_.answered(reference_index(), difference, trial_.comparison_first, comparison_judged_larger);
    ++answered_;
    if (!done()) choose();
  }

 private:
  std::size_t reference_index() const {
    const auto at = std::find(kReferenceForces_N.begin(), kReferenceForces_N.end(), slots_[answered_].reference_N);
    return static_cast<std::size_t>(at - kReferenceForces_N.begin());
  }

  void choose() {
    const AdaptiveSlot& slot = slots_[answered_];
    const double difference =
        beliefs_.next_difference(reference_index(), slot.comparison_larger, slot.comparison_first);
    const double percent = 100.0 + (slot.comparison_larger ? 100.0 : -100.0) * difference;
    trial_ = {slot.reference_N, percent_of(slot.reference_N, percent), slot.comparison_first};
  }

  std::vector<AdaptiveSlot> slots_;
  std::vector<StudyTrial> training_;
  QuestPlus beliefs_;
  StudyTrial trial_;
};

constexpr std::array<std::pair<ProcedureKind, const char*>, 3> kNames = {{{ProcedureKind::constant, "constant"},
                                                                          {ProcedureKind::adaptive, "adaptive"},
                                                                          {ProcedureKind::discriminate, "discriminate"}}};

}  // namespace

const char* procedure_name(ProcedureKind kind) noexcept { return kNames[static_cast<std::size_t>(kind)].second; }

Result<ProcedureKind> find_procedure(const std::string& name) {
  for (const auto& [kind, known] : kNames) {
    if (name == known) return kind;
  }
  return Error{"found the procedure \"" + name + "\", expected constant, adaptive or discriminate"};
}

Stimuli StudyProcedure::stimuli(const StudyTrial& trial, bool) const {
  return {{trial.first_N()}, {trial.second_N()}, false, {}};
}

std::unique_ptr<StudyProcedure> StudyProcedure::create(ProcedureKind kind, const std::string& code,
                                                       const StrokePair* strokes) {
  if (kind == ProcedureKind::discriminate) return std::make_unique<ReminderTrials>(code, *strokes);
  if (kind == ProcedureKind::constant) return std::make_unique<ConstantStimuli>(code);
  return std::make_unique<Adaptive>(code);
}

}  // namespace palpate
