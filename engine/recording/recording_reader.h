// Reads recordings row by row from a file or another stream.
// Thread guarantee: slow side only; one thread per object.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording.h"

namespace palpate {

// Reads a recording of any length row by row in bounded memory.
class RecordingReader {
 public:
  // Opens the file and reads its header. Errors: no such file, not readable, a folder, a pipe or a device, not text, no
  // header, a missing or duplicate column.
  static Result<RecordingReader> open(const std::string& path);
  // The same for any stream; `label` replaces the path in messages.
  static Result<RecordingReader> from(std::unique_ptr<std::istream> stream, std::string label);

  // The file name without folder and extension.
  const std::string& name() const { return name_; }
  RecordingColumns columns() const;

  // Appends up to `most` rows to `rows`; returns their number, which is smaller only at the end. Errors: a row or
  // recording that breaks a rule (RowRules). After an error each call returns it again.
  Result<std::size_t> read(std::vector<RecordingRow>& rows, std::size_t most);

 private:
  RecordingReader(std::unique_ptr<std::istream> stream, std::string label);
  // Each of these returns false at the end of the file and after an error.
  bool next_line();
  bool read_header();
  bool parse_header();
  bool next(RecordingRow& row);
  bool finish();
  // The beginning of a message about a part of the present line.
  std::string place_of(std::string_view at) const;
  // Sets the error and returns false.
  bool fail(const std::string& message);
  bool fail(const RowFault& fault);
  void split_line();
  bool parse(RecordingRow& row);
  std::size_t index_of(ColumnRole role) const;
  bool has(ColumnRole role) const { return index_of(role) < roles_.size(); }

  std::unique_ptr<std::istream> stream_;
  std::string label_, name_;
  std::vector<char> buffer_;              // holds the present line
  std::string_view line_;                 // without its line end; empty at the end of the file
  std::vector<std::string_view> fields_;  // of the present line
  std::uint64_t line_number_ = 0;
  bool line_has_end_ = false;      // false: the file ends here without a newline
  std::vector<ColumnRole> roles_;  // of the columns of the file, in its order
  bool header_ends_with_comma_ = false;
  RowRules rules_;
  std::string first_time_;  // the place of the first time
  bool ended_ = false;
  std::optional<Error> error_;
};

}  // namespace palpate
