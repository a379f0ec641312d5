// The sequence of trials of one subject: constant stimuli (all known beforehand),
// adaptive (QUEST+, a quarter of the trials: the answers so far decide how large the
// next difference is), or two strokes to tell apart.
//
// The last is two-alternative forced choice with a reminder (M. J. Hautus, N. A.
// Macmillan & C. D. Creelman 2022, Detection Theory: A User's Guide, 3rd ed., chapter
// 7: "2AFCR"; the design of the duo-trio test with constant reference, ISO 10399): the
// reference stroke, then reference and comparison in either order; which of the two was
// like the first? Who uses the difference does as well as in 2AFC without a reminder, so
// that d' = sqrt(2) Phi^-1(share correct) and one JND (criterion 0.75) is 75 % correct:
// what the JND says can be held against it. A reminder is needed because strokes differ
// in any way, not only in size. No feedback after the training.
//
// After a restart the answers so far are given again in order: `next` then
// continues as if nothing had happened.
// Thread guarantee: one thread; slow side.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/study/study_plan.h"
#include "scenes/study/study_presenter.h"

namespace palpate {

enum class ProcedureKind : std::uint8_t { constant, adaptive, discriminate };

const char* procedure_name(ProcedureKind kind) noexcept;  // "constant", "adaptive", "discriminate"
// Errors: none of them.
Result<ProcedureKind> find_procedure(const std::string& name);

class StudyProcedure {
 public:
  // `code`: a subject code. `strokes`: for discriminate, else ignored.
  static std::unique_ptr<StudyProcedure> create(ProcedureKind kind, const std::string& code,
                                                const StrokePair* strokes = nullptr);
  virtual ~StudyProcedure() = default;

  virtual std::size_t trial_count() const noexcept = 0;
  // Trials between two breaks.
  virtual std::size_t trials_per_block() const noexcept = 0;
  // The trial to present now; the same until it is answered. Not when done.
  virtual StudyTrial next() const = 0;
  // Trials to learn the task before.
  virtual std::vector<StudyTrial> training() const = 0;
  // What is presented in a trial, of the training or not.
  virtual Stimuli stimuli(const StudyTrial& trial, bool training) const;
  virtual void answered(bool comparison_judged_larger) = 0;

  std::size_t answered_count() const noexcept { return answered_; }
  bool done() const noexcept { return answered_ == trial_count(); }

 protected:
  std::size_t answered_ = 0;
};

}  // namespace palpate
