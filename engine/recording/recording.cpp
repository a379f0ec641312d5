#include "engine/recording/recording.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "engine/base/csv_scanner.h"
#include "engine/recording/recording_parser.h"

namespace palpate {
namespace {

// Rows returned at a time by read_recording: enough to forget the calls.
constexpr std::size_t kBatchRows = 4096;

std::string name_of(const std::string& path) { return std::filesystem::path(path).stem().string(); }

Error cannot_open(const std::string& path, int error_number) {
  if (error_number == ENOENT || error_number == ENOTDIR) {
    return Error{path + ": found no such file, expected a recording (CSV); check the path"};
  }
  if (error_number == EACCES || error_number == EPERM) {
    return Error{path +
                 ": found no permission to read it, expected a readable recording; "
                 "change its permissions (chmod u+r)"};
  }
  return Error{path + ": the file cannot be opened (" + std::strerror(error_number) + "); check the path"};
}

// A pipe or a device could block for ever or never end, so only plain files
// are read; the question comes before the opening, which can do things to a
// device.
Status check_is_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return cannot_open(path, errno);
  if (S_ISREG(status.st_mode)) return {};
  if (S_ISDIR(status.st_mode)) {
    return Error{path + ": found a folder, expected a recording (CSV); name a file in it"};
  }
  return Error{path +
               ": found a pipe or a device, expected a recording (CSV); save it to a file "
               "first"};
}

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
  if (const Status file = check_is_file(path); !file) return file.error();
  // Non-blocking, should a pipe have taken the file's place meanwhile.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return cannot_open(path, errno);
  auto parser = RecordingParser::start(std::make_unique<DescriptorSource>(descriptor), path);
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
