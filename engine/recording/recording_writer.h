// Writes a recording file of any length row by row in bounded memory. The file appears under its name at `commit`, or
// partially at `publish`.
// Thread guarantee: slow side only; one thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/atomic_file.h"
#include "engine/base/result.h"
#include "engine/recording/recording.h"

namespace palpate {

class RecordingWriter {
 public:
  // `comments` become '#' lines, one for each line of text. Errors: those of AtomicFile::create; another writer, of any
  // program on this machine, is writing a recording of this name.
  static Result<RecordingWriter> create(const std::string& path, RecordingColumns columns,
                                        const std::vector<std::string>& comments, bool overwrite);

  // Buffered. Errors: a row that breaks a rule (engine/recording/recording.h); it is not written.
  Status add(const RecordingRow& row);

  // Adds a comment, which `commit` writes above the others.
  void note(const std::string& comment);

  std::uint64_t rows() const { return rules_.rows(); }
  // Whether an input/output error has occurred, which `commit` will return.
  bool failed() const noexcept { return file_.failed(); }

  // Makes the rows written so far available under the file's name, in whole rows even if the program is killed
  // (AtomicFile::publish). Does nothing before row 1,000, at which the rate is checked. Errors: as `commit`.
  Status publish();

  // The number of rows that `publish` has made available.
  std::uint64_t published_rows() const noexcept { return published_rows_; }

  // The file gets its notes when it is complete; without room on the disk for a copy it is left without them. Errors:
  // those of AtomicFile::commit; fewer than 10 rows, or a rate outside the reader's range. Then only the
  // published file, if any, is left.
  Status commit();

 private:
  RecordingWriter(std::shared_ptr<void> claim, AtomicFile file, std::string path, RecordingColumns columns)
      : claim_(std::move(claim)), file_(std::move(file)), path_(std::move(path)), columns_(columns) {}

  std::shared_ptr<void> claim_;  // reserves the name of a file that has none yet
  AtomicFile file_;
  std::string path_;
  RecordingColumns columns_;
  RowRules rules_;
  std::string notes_;  // '#' lines
  std::uint64_t noted_ = 0, published_rows_ = 0;
};

}  // namespace palpate
