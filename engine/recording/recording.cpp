#include "engine/recording/recording.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <system_error>

#include "engine/recording/recording_reader.h"
#include "engine/recording/recording_writer.h"

namespace palpate {
namespace {

// Rows that read_recording reads at a time, few enough for the cache.
constexpr std::size_t kBatchRows = 4096;
// The largest number of rows for which memory is reserved: untouched memory costs nothing, and a growing vector would
// have its rows twice at times.
constexpr std::size_t kMostExpected = 6000000;
constexpr std::size_t kShortestRow = 6;  // bytes of "0,0,0" and a line end

}  // namespace

std::uint64_t content_hash(const Recording& recording) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const RecordingRow& row : recording.rows) {
    for (const double value : column_values(row)) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001B3ULL;
      hash ^= hash >> 29;
    }
  }
  return hash;
}

Result<Recording> read_recording(const std::string& path, std::size_t most_rows) {
  auto reader = RecordingReader::open(path);
  if (!reader) return reader.error();
  Recording recording{reader->name(), reader->columns(), {}};
  std::error_code unknown;  // then the size is the largest number
  recording.rows.reserve(
      std::min<std::size_t>(std::filesystem::file_size(path, unknown) / kShortestRow, kMostExpected));
  std::vector<RecordingRow> batch(kBatchRows);
  while (recording.rows.size() < most_rows) {
    const auto count = reader->read(batch.data(), std::min(batch.size(), most_rows - recording.rows.size()));
    if (!count) return count.error();
    if (*count == 0) break;
    recording.rows.insert(recording.rows.end(), batch.begin(), batch.begin() + static_cast<std::ptrdiff_t>(*count));
  }
  return recording;
}

Status write_recording(const std::string& path, const Recording& recording, const std::vector<std::string>& comments,
                       bool overwrite) {
  auto writer = RecordingWriter::create(path, recording.columns, comments, overwrite);
  if (!writer) return writer.error();
  for (const RecordingRow& row : recording.rows) {
    if (Status added = writer->add(row); !added) return added;
  }
  return writer->commit();
}

}  // namespace palpate
