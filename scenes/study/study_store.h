// Interface of the storage of answers. A session has no other copy of them.
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

// Common data of all trials of one subject.
struct StudyHeader {
  std::string subject;
  std::shared_ptr<const StrokePair> strokes = nullptr;  // null: constant stimuli
  // The device of new answers, and whether it renders force. Both are stored with each answer, because a study may be
  // resumed with another device.
  std::string device = "unknown";
  bool rendered = true;

  // The name of the procedure in study files.
  const char* procedure() const noexcept { return strokes != nullptr ? "discriminate" : "constant"; }
};

struct StudyRecord {
  bool training = false;
  std::size_t number = 1;  // from 1, counted separately for training and study
  StudyTrial trial;
  double first_rendered_N = 0.0;  // mean between the ramps, rounded to 0.1 mN
  double second_rendered_N = 0.0;
  bool limited = false;
  bool answered_second = false;      // "the second was larger", or "the second was like the reminder"
  std::uint32_t response_ms = 0;     // from the end of the second force
  double reminder_rendered_N = 0.0;  // this and worst_N: with strokes only
  double worst_N = 0.0;              // largest deviation of the rendered force at any tick, rounded to 0.1 mN

  std::string device = "unknown";
  bool rendered = true;  // false: a rehearsal on a device without force

  bool comparison_judged_larger() const noexcept { return answered_second != trial.comparison_first; }
  bool found_larger() const noexcept { return answered_second == (trial.second_N() > trial.first_N()); }
  bool found_reference() const noexcept { return answered_second == trial.comparison_first; }
  // The rendered difference relative to the rendered reference.
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

  // Records the consent once. `text`: the text that was shown; `when`: any text without a line break, may be empty.
  // Errors: it could not be written.
  virtual Status consent(const std::string& text, const std::string& when) = 0;
  // Stores an answer durably. Errors: it could not be written; the call may be repeated.
  virtual Status append(const StudyRecord& record) = 0;
};

}  // namespace palpate
