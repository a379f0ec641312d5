// Writes a recording file of any length row by row in bounded memory. It gets its name at `commit`; the rows of a
// recording that is being made are in NAME.part until then (AtomicFile).
// Thread guarantee: slow side only; one thread at a time.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/atomic_file.h"
#include "engine/base/result.h"
#include "engine/recording/recording.h"

namespace palpate {

class RecordingWriter {
 public:
  // `comments` become '#' lines, one for each line of text. Errors: those of AtomicFile.
  static Result<RecordingWriter> create(const std::string& path, RecordingColumns columns,
                                        const std::vector<std::string>& comments, bool overwrite, bool in_part = false);

  // Buffered. Errors: a row that breaks a rule (engine/recording/recording.h); it is not written.
  Status add(const RecordingRow& row);

  // Adds a comment, which `commit` writes above the others; for a writer with a part.
  void note(const std::string& comment);

  std::uint64_t rows() const { return rules_.rows(); }
  // Whether an input/output error has occurred, which `commit` will return.
  bool failed() const noexcept { return file_.failed(); }

  // Adds the rows written so far to the part. Errors: as `commit`.
  Status flush();
  // The number of rows that `flush` has added.
  std::uint64_t flushed_rows() const noexcept { return flushed_rows_; }

  // The file gets its notes when it is complete; without room on the disk for a copy it is left without them. Errors:
  // those of AtomicFile::commit; fewer than 10 rows, or a rate outside the reader's range, which leave no file.
  Status commit();

 private:
  RecordingWriter(AtomicFile file, std::string path, RecordingColumns columns, bool overwrite)
      : file_(std::move(file)), path_(std::move(path)), columns_(columns), overwrite_(overwrite) {}

  AtomicFile file_;
  std::string path_;
  RecordingColumns columns_;
  bool overwrite_;
  RowRules rules_;
  std::string notes_;  // '#' lines
  std::uint64_t noted_ = 0, flushed_rows_ = 0;
};

}  // namespace palpate
