// The sequence of trials of one subject: constant stimuli (all known beforehand)
// or adaptive (QUEST+, a quarter of the trials: the answers so far decide how large the
// next difference is).
//
// After a restart the answers so far are given again in order: `next` then
// continues as if nothing had happened.
// Thread guarantee: one thread; slow side.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "scenes/study/study_plan.h"

namespace palpate {

enum class ProcedureKind : std::uint8_t { constant, adaptive };

const char* procedure_name(ProcedureKind kind) noexcept;  // "constant", "adaptive"
// Errors: neither.
Result<ProcedureKind> find_procedure(const std::string& name);

class StudyProcedure {
 public:
  // `code`: a subject code.
  static std::unique_ptr<StudyProcedure> create(ProcedureKind kind, const std::string& code);
  virtual ~StudyProcedure() = default;

  virtual std::size_t trial_count() const noexcept = 0;
  // Trials between two breaks.
  virtual std::size_t trials_per_block() const noexcept = 0;
  // The trial to present now; the same until it is answered. Not when done.
  virtual StudyTrial next() const = 0;
  virtual void answered(bool comparison_judged_larger) = 0;

  std::size_t answered_count() const noexcept { return answered_; }
  bool done() const noexcept { return answered_ == trial_count(); }

 protected:
  std::size_t answered_ = 0;
};

}  // namespace palpate
