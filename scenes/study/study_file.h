// The answers of one subject in a CSV file, one row per trial.
//
//   # palpate-study 1
//   # subject S01
//   # procedure constant
//   # timing_ms lead_in 400 ramp 100 hold 900 pause 500
//   # consent accepted, text 8c1f2a9d, 2024-05-06 10:20
//   part,trial,reference_N,comparison_N,comparison_first,first_rendered_N,second_rendered_N,limited,answer,response_ms,device,rendered
//   training,1,0.3,0.18,1,0.18,0.3,0,second,731,paddle,true
//
// With strokes (procedure discriminate) five more lines stand behind the timing and two
// more columns at the end; the forces and which is which:
//   # reference recorded force
//   # comparison greedy-100
//   # stroke from_s 12.3 to_s 14.1 of silicone_2
//   # forces reference_mean_N 1.2 comparison_mean_N 1.21 checksum 2350029213
//   # predicted mean_over_jnd 0.1 max_over_jnd 0.6 jnd_offset_N 0.065 jnd_weber_fraction 0.0633
//   part,...,response_ms,reminder_rendered_N,worst_N,device,rendered
//
// The consent's text is named by a checksum (FNV-1a), the time is the caller's word.
// Nothing is written before the consent. A row is appended in one go and flushed to
// the disk before the answer counts; a refused row is taken back. A last row without
// its line end, from a power cut, was never confirmed: it is ignored and cut off.
// While one StudyFile holds a file, a second is refused (flock).
// Thread guarantee: one thread; slow side (does I/O).
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/study/study_store.h"

namespace palpate {

inline constexpr std::string_view kStudyColumns =
    "part,trial,reference_N,comparison_N,comparison_first,first_rendered_N,second_rendered_N,limited,answer,"
    "response_ms";
inline constexpr std::string_view kStrokeColumns = ",reminder_rendered_N,worst_N";
inline constexpr std::string_view kDeviceColumns = ",device,rendered";

struct StudyData {
  StudyHeader header;
  std::string consent;  // "text 8c1f2a9d, 2024-05-06 10:20"
  std::vector<StudyRecord> records;
  std::size_t whole_bytes = 0;  // up to the end of the last whole row
};

// Errors: anything unlike the above, as "path:line:column: found ..., expected ...".
Result<StudyData> parse_study(std::string_view text, const std::string& path);
Result<StudyData> read_study(const std::string& path);

// The lines above the consent, and the columns' names.
std::string study_header_text(const StudyHeader& header);
std::string study_columns(ProcedureKind procedure);
// One row of the table, with its line end.
std::string study_row(const StudyRecord& record, ProcedureKind procedure);
// Errors: no file; two of one subject.
Status check_subjects(const std::vector<StudyData>& files);

// Takes out the answers that nobody could feel; returns how many.
std::size_t remove_rehearsals(StudyData& data);

class StudyFile final : public StudyStore {
 public:
  // Takes up `path`, or makes it once there is consent. Errors: another session has
  // it; not a study file, or of another subject, procedure or timing; not readable.
  static Result<std::unique_ptr<StudyFile>> open(const std::string& path, const StudyHeader& header);

  StudyFile(const StudyFile&) = delete;
  StudyFile& operator=(const StudyFile&) = delete;
  ~StudyFile() override;

  bool consented() const noexcept override { return consented_; }
  const std::vector<StudyRecord>& records() const noexcept override { return records_; }
  Status consent(const std::string& text, const std::string& when) override;
  Status append(const StudyRecord& record) override;

 private:
  StudyFile(const std::string& path, const StudyHeader& header) : path_(path), header_(header) {}
  Status take_up();
  Status lock();
  Status write_whole(const std::string& text);
  Error failure(int error_number) const;

  std::string path_;
  StudyHeader header_;
  int descriptor_ = -1;
  std::size_t size_ = 0;  // of what is confirmed
  bool consented_ = false;
  std::vector<StudyRecord> records_;
};

}  // namespace palpate
