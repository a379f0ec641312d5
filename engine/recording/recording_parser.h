// Recordings out of any source of bytes: RecordingReader without the file.
// Internal to engine/recording; tests and the fuzz target use it from memory.
//
// Thread guarantee: slow side only; one thread per object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/csv_scanner.h"
#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "engine/recording/recording_rules.h"

namespace palpate {

// What each column of the file means, in the file's order.
struct RecordingHeader {
  std::vector<ColumnRole> roles;
  bool ends_with_comma = false;  // the last column has no name
};

// Reads the header row. Errors: not UTF-8, a required column missing, a known
// column twice, another separator than the comma.
Result<RecordingHeader> parse_recording_header(const LineScanner& scanner, const CsvLine& line);

// Says what is wrong with a row that `RecordingParser` could not read: one
// sentence with its place. Slow, and only ever called once per file.
Error explain_recording_row(const LineScanner& scanner, const CsvLine& line, const RecordingHeader& header);

// One decimal number with blanks around it, '.' as decimal point, exactly
// rounded. Returns where it ends (at a comma or at `end`), or nullptr if there
// is no finite number.
const char* parse_recording_number(const char* begin, const char* end, double& value);

// The column (from 1) where field `index` of `text` starts; blanks
// before a value are skipped.
std::size_t field_column(std::string_view text, std::size_t index);

class RecordingParser {
 public:
  // Reads comments and the header. `label` names the source in messages.
  static Result<RecordingParser> start(std::unique_ptr<ByteSource> source, std::string label,
                                       std::size_t buffer_bytes = kScannerBufferBytes);

  RecordingColumns columns() const;

  // As RecordingReader::read. After an error every further call repeats it.
  Result<std::size_t> read(RecordingRow* rows, std::size_t capacity);

 private:
  RecordingParser(LineScanner scanner, RecordingHeader header);
  bool next(RecordingRow& row);
  bool parse(std::string_view text, RecordingRow& row) const;
  bool finish();
  bool skip_last_blank_lines(const CsvLine& blank);
  bool fail(Error error);
  bool fail(const RowFault& fault, const CsvLine& line);

  LineScanner scanner_;
  RecordingHeader header_;
  RowRules rules_;
  std::uint64_t first_row_line_ = 0;
  std::size_t first_row_time_column_ = 1;
  std::size_t time_index_ = 0;
  bool ended_ = false;
  std::optional<Error> error_;
};

}  // namespace palpate
