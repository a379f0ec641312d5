// The answers of one subject in a CSV file, one row per trial. A session has no other copy of them.
//
//   # palpate-study 1
//   # subject S01
//   # procedure constant
//   # timing_ms lead_in 400 ramp 100 hold 900 pause 500
//   # consent accepted, 2024-05-06 10:20
//   part,trial,reference_N,comparison_N,comparison_first,first_rendered_N,second_rendered_N,limited,answer,response_ms,device,rendered
//   training,1,0.3,0.18,1,0.18,0.3,0,second,731,paddle,true
//
// The procedure discriminate has a line `# strokes {...}` after the timing, a StrokePair without its forces as JSON.
// Its rows have two more columns before the device, reminder_rendered_N and worst_N; their forces are the means of the
// strokes. The first five columns are those of the subject's plan.
//
// No file exists before the consent. With each answer the file is replaced atomically; the answer counts once the file
// is on the disk. A last row without its line end is ignored.
// Thread guarantee: one thread; slow side (does I/O).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/study/study_plan.h"

namespace palpate {

struct StudyHeader {
  std::string subject;
  std::shared_ptr<const StrokePair> strokes = nullptr;  // null: constant stimuli
  // The device of new answers, and whether it renders force. Both are stored with each answer, because a study may be
  // resumed with another device.
  std::string device = "unknown";
  bool rendered = true;
};

struct StudyRecord {
  StudyTrial trial;
  double first_rendered_N = 0.0;  // mean between the ramps; forces are rounded to 0.1 mN
  double second_rendered_N = 0.0;
  bool limited = false;
  bool answered_second = false;      // "the second was larger", or "the second was like the reminder"
  std::uint32_t response_ms = 0;     // from the end of the second force
  double reminder_rendered_N = 0.0;  // this and worst_N: with strokes only
  double worst_N = 0.0;              // largest |rendered - commanded force| at any tick
  std::string device = "unknown";
  bool rendered = true;  // false: a rehearsal on a device without force

  bool comparison_judged_larger() const noexcept { return answered_second != trial.comparison_first; }
  bool found_larger() const noexcept { return answered_second == (trial.second_N() > trial.first_N()); }
  bool found_reference() const noexcept { return answered_second == trial.comparison_first; }
  double reference_rendered_N() const noexcept { return trial.comparison_first ? second_rendered_N : first_rendered_N; }
  // The rendered difference relative to the rendered reference.
  double rendered_difference() const noexcept;
  bool operator==(const StudyRecord&) const = default;
};

struct StudyData {
  StudyHeader header;
  std::vector<StudyRecord> records;
};

// Errors: the first place where the text is not in this format, or not of the subject's plan, as "path:line:column:
// found ..., expected ...".
Result<StudyData> parse_study(const std::string& text, const std::string& path);
// Errors: the file is not readable; those of parse_study.
Result<StudyData> read_study(const std::string& path);
// The lines above the rows. One row with its line end; `strokes`: with the two columns of that procedure.
std::string study_header_text(const StudyHeader& header, const std::string& consent);
std::string study_row(const StudyRecord& record, bool strokes);

// Whether the files can be analysed together. Errors: two files of one subject; files of different procedures or
// strokes.
Status check_study_files(const std::vector<StudyData>& files);

class StudyFile {
 public:
  // Resumes `path` if it exists; else `consent` creates it. Errors: an invalid subject code; the file is not a study
  // file, or of another subject, procedure or strokes; it is not readable.
  static Result<StudyFile> open(const std::string& path, const StudyHeader& header);

  const StudyHeader& header() const noexcept { return header_; }
  // Whether the subject has consented, now or in an earlier session.
  bool consented() const noexcept { return !text_.empty(); }
  // Answers of earlier sessions and of this one, in order.
  const std::vector<StudyRecord>& records() const noexcept { return records_; }

  // Creates the file. `when`: any text without a line break. Errors: it could not be written; another session has
  // changed it.
  Status consent(const std::string& when);
  // Stores an answer on the disk, with the device of the header. Errors: as consent; the call may be repeated.
  Status append(StudyRecord record);

 private:
  StudyFile(const std::string& path, const StudyHeader& header) : path_(path), header_(header) {}
  Status replace(const std::string& text);

  std::string path_;
  StudyHeader header_;
  std::string text_;  // of the file; empty: there is none
  std::vector<StudyRecord> records_;
};

}  // namespace palpate
