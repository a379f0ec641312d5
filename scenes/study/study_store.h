// Where answers go. The session keeps nothing of its own: what was answered is
// what the store holds.
// Thread guarantee: one thread; slow side (does I/O).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/study/stroke_pair.h"
#include "scenes/study/study_plan.h"

namespace palpate {

// What all trials of one subject have in common.
struct StudyHeader {
  std::string subject;
  std::shared_ptr<const StrokePair> strokes = nullptr;  // to tell apart; null: constant stimuli
  // What new answers are given on, and whether it renders force; of each row, for a study
  // may go on with another device.
  std::string device = "unknown";
  bool rendered = true;

  // As files call it.
  const char* procedure() const noexcept { return strokes != nullptr ? "discriminate" : "constant"; }
};

// One answered trial.
struct StudyRecord {
  bool training = false;
  std::size_t number = 1;  // from 1, in its own count
  StudyTrial trial;
  double first_rendered_N = 0.0;  // mean while held, to 0.1 mN
  double second_rendered_N = 0.0;
  bool limited = false;
  bool answered_second = false;      // "the second was larger", or "it was like the reminder"
  std::uint32_t response_ms = 0;     // from the end of the second force
  double reminder_rendered_N = 0.0;  // these two with strokes only
  double worst_N = 0.0;              // at any tick away from what it should be, to 0.1 mN

  std::string device = "unknown";
  bool rendered = true;  // false: a rehearsal, nobody could feel anything

  bool comparison_judged_larger() const noexcept { return answered_second != trial.comparison_first; }
  bool found_larger() const noexcept { return answered_second == (trial.second_N() > trial.first_N()); }
  bool found_reference() const noexcept { return answered_second == trial.comparison_first; }
  // The difference that was rendered, relative to the reference that was.
  double rendered_difference() const noexcept;
  bool operator==(const StudyRecord&) const = default;
};

class StudyStore {
 public:
  virtual ~StudyStore() = default;

  // Whether the subject has consented, now or in an earlier session.
  virtual bool consented() const noexcept = 0;
  // Answers of earlier sessions and of this one, in order.
  virtual const std::vector<StudyRecord>& records() const noexcept = 0;

  // Records the consent; once. `text`: what was shown; `when`: any text without a
  // line break, may be empty. Errors: not written.
  virtual Status consent(const std::string& text, const std::string& when) = 0;
  // When it returns without an error the answer is on the disk. Errors: it is not,
  // and may be given again.
  virtual Status append(const StudyRecord& record) = 0;
};

}  // namespace palpate
