#include "engine/recording/recording.h"

#include <filesystem>
#include <utility>

#include "engine/base/csv_scanner.h"
#include "engine/base/whole_file.h"
#include "engine/recording/recording_parser.h"

namespace palpate {
namespace {

// Rows returned at a time by read_recording: enough to forget the calls.
constexpr std::size_t kBatchRows = 4096;

std::string name_of(const std::string& path) { return std::filesystem::path(path).stem().string(); }

}  // namespace

struct RecordingReader::State {
  std::string name;
  RecordingParser parser;
};

RecordingReader::RecordingReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
RecordingReader::RecordingReader(RecordingReader&&) noexcept = default;
RecordingReader& RecordingReader::operator=(RecordingReader&&) noexcept = default;
RecordingReader::~RecordingReader() = default;

Result<RecordingReader> RecordingReader::open(const std::string& path) {
  const Result<int> descriptor = open_plain_file(path, "a recording (CSV)");
  if (!descriptor) return descriptor.error();
  auto parser = RecordingParser::start(std::make_unique<DescriptorSource>(*descriptor), path);
  if (!parser) return parser.error();
  return RecordingReader(std::make_unique<State>(State{name_of(path), std::move(*parser)}));
}

const std::string& RecordingReader::name() const { return state_->name; }
RecordingColumns RecordingReader::columns() const { return state_->parser.columns(); }

Result<std::size_t> RecordingReader::read(RecordingRow* rows, std::size_t capacity) {
  return state_->parser.read(rows, capacity);
}

Result<Recording> read_recording(const std::string& path) {
  auto reader = RecordingReader::open(path);
  if (!reader) return reader.error();
  Recording recording{reader->name(), reader->columns(), {}};
  std::vector<RecordingRow> batch(kBatchRows);
  for (;;) {
    const auto count = reader->read(batch.data(), batch.size());
    if (!count) return count.error();
    if (*count == 0) return recording;
    recording.rows.insert(recording.rows.end(), batch.begin(), batch.begin() + static_cast<std::ptrdiff_t>(*count));
  }
}

}  // namespace palpate
