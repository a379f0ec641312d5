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
// The procedure discriminate has a line `# strokes {...}` after the timing, a StrokePair without its forces as JSON.
// Its rows have two more columns before the device, reminder_rendered_N and worst_N; their forces are the means of the
// strokes.
//
// The consent line has a checksum of the text (FNV-1a) and the time that the caller gives. No file exists before the
// consent. A row is appended and synced to the disk before its answer counts; a row that fails is removed. A last row
// without its line end, left by a power failure, was never confirmed: it is ignored and removed. While a StudyFile has
// a file open, a second StudyFile is refused (flock).
// Thread guarantee: one thread; slow side (does I/O).
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/study/study_store.h"

namespace palpate {

struct StudyData {
  StudyHeader header;
  std::string consent;  // "text 8c1f2a9d, 2024-05-06 10:20"
  std::vector<StudyRecord> records;
  std::size_t whole_bytes = 0;  // up to the end of the last complete row
};

// Errors: the first deviation from this format, as "path:line:column: found ..., expected ...".
Result<StudyData> parse_study(std::string_view text, const std::string& path);
// Errors: the file is not readable; those of parse_study.
Result<StudyData> read_study(const std::string& path);

// The lines above the consent; the names of the columns; one row with its line end.
std::string study_header_text(const StudyHeader& header);
std::string study_columns(const StudyHeader& header);
std::string study_row(const StudyRecord& record, const StudyHeader& header);
// Errors: no file; two files of one subject.
Status check_subjects(const std::vector<StudyData>& files);

class StudyFile final : public StudyStore {
 public:
  // Resumes `path` if it exists; else `consent` creates it. Errors: another session has it open; it is not a study
  // file, or of another subject, procedure or strokes; it is not readable.
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
  Error failure(int error_number) const;

  std::string path_;
  StudyHeader header_;
  int descriptor_ = -1;
  std::size_t size_ = 0;  // bytes of confirmed rows
  bool consented_ = false;
  std::vector<StudyRecord> records_;
};

}  // namespace palpate
