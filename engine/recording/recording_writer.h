// A recording file written row by row in bounded memory, whatever its length;
// whole under its name after `commit`, or not there at all.
// Thread guarantee: slow side only; one thread at a time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/atomic_file.h"
#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "engine/recording/recording_rules.h"

namespace palpate {

class RecordingWriter {
 public:
  // `comments` become '#' lines, one for each line of text. Errors: as
  // AtomicFile::create; a comment too long for a line.
  static Result<RecordingWriter> create(const std::string& path, RecordingColumns columns,
                                        const std::vector<std::string>& comments, bool overwrite);

  // Buffered. Errors: the reader would refuse the row (engine/recording/recording.h has the
  // rules), which is left out.
  Status add(const RecordingRow& row);

  std::uint64_t rows() const { return rules_.rows(); }
  // Whether the disk has refused something already; commit says what.
  bool failed() const noexcept { return file_.failed(); }

  // What was added so far is on the disk under its name, whole rows whenever the program is
  // killed (AtomicFile::publish); a file that the reader would still refuse waits. Errors:
  // as `commit`.
  Status publish();

  // Rows that are under the final name whatever happens.
  std::uint64_t published_rows() const noexcept { return published_rows_; }

  // Errors: as AtomicFile::commit; fewer than 10 rows, or a rate outside the
  // reader's range. Then no file is left but what was published.
  Status commit();

 private:
  RecordingWriter(AtomicFile file, RecordingColumns columns);
  void flush();

  AtomicFile file_;
  RecordingColumns columns_;
  RowRules rules_;
  std::string path_;
  std::string piece_;
  std::uint64_t published_rows_ = 0;
};

}  // namespace palpate
