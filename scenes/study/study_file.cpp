#include "scenes/study/study_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>
#include <type_traits>
#include <utility>

#include "engine/base/atomic_file.h"
#include "engine/base/csv_scanner.h"
#include "engine/base/whole_file.h"
#include "engine/json/json_position.h"

namespace palpate {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(JndLine, offset_N, weber_fraction)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StrokePair, reference, comparison, recording, from_s, checksum, jnd, mean_over_jnd,
                                   max_over_jnd, reference_mean_N, comparison_mean_N)

namespace {

constexpr int kAppending = O_RDWR | O_APPEND | O_CLOEXEC;

// The values that a column may have: two words, or numbers from `least` to `most`.
struct Allowed {
  const char* expected = "";
  double least = 0.0;
  double most = 0.0;
  const char* no = "0";
  const char* yes = "1";
};
constexpr Allowed kFlag{"0 or 1"};
constexpr Allowed kPlanned{"a force above 0 and up to 10 N", 1e-3, 10.0};
constexpr Allowed kRendered{"a force from 0 to 10 N", 0.0, 10.0};

// Calls `column` with the name, the value and the allowed values of every column of a row, in order.
template <typename Record, typename Column>
void each_column(Record& record, const StudyHeader& header, Column&& column) {
  column("part", record.trial.training, Allowed{"training or study", 0.0, 0.0, "study", "training"});
  column("trial", record.number, Allowed{"a whole number above 0", 1.0, 1e9});
  column("reference_N", record.trial.reference_N, kPlanned);
  column("comparison_N", record.trial.comparison_N, kPlanned);
  column("comparison_first", record.trial.comparison_first, kFlag);
  column("first_rendered_N", record.first_rendered_N, kRendered);
  column("second_rendered_N", record.second_rendered_N, kRendered);
  column("limited", record.limited, kFlag);
  column("answer", record.answered_second, Allowed{"first or second", 0.0, 0.0, "first", "second"});
  column("response_ms", record.response_ms, Allowed{"a whole number of ms", 0.0, 4294967295.0});
  if (header.strokes != nullptr) {
    column("reminder_rendered_N", record.reminder_rendered_N, kRendered);
    column("worst_N", record.worst_N, kRendered);
  }
  column("device", record.device, Allowed{"the name of a device"});
  column("rendered", record.rendered, Allowed{"true or false", 0.0, 0.0, "false", "true"});
}

template <typename T>
std::string text_of(const T& value, const Allowed& allowed) {
  if constexpr (std::is_same_v<T, bool>) return value ? allowed.yes : allowed.no;
  if constexpr (std::is_same_v<T, std::string>) return value;
  if constexpr (std::is_floating_point_v<T>) return shortest(value);
  if constexpr (std::is_integral_v<T>) return std::to_string(value);
}

template <typename T>
bool read_value(std::string_view text, T& value, const Allowed& allowed) {
  if constexpr (std::is_same_v<T, bool>) {
    value = text == allowed.yes;
    return value || text == allowed.no;
  } else if constexpr (std::is_same_v<T, std::string>) {
    value = text;
    return !text.empty();
  } else {
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    const double number = static_cast<double>(value);  // NaN is refused
    return read.ec == std::errc() && read.ptr == text.data() + text.size() && number >= allowed.least &&
           number <= allowed.most;
  }
}

std::string columns_of(const StudyHeader& header) {
  std::string columns;
  const StudyRecord any;
  each_column(any, header, [&](const char* name, const auto&, const Allowed&) {
    columns += (columns.empty() ? "" : ",") + std::string(name);
  });
  return columns;
}

const char* procedure_of(const StudyHeader& header) { return header.strokes != nullptr ? "discriminate" : "constant"; }

// The header line with the timing of a presentation.
std::string timing_line() {
  return "# timing_ms lead_in " + std::to_string(kLeadIn_ticks) + " ramp " + std::to_string(kRamp_ticks) + " hold " +
         std::to_string(kHold_ticks) + " pause " + std::to_string(kPause_ticks);
}

// A study file is text: a header, then rows. Every field is checked.
class StudyReader {
 public:
  StudyReader(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  Result<StudyData> read() {
    if (!next_line("# palpate-study 1").empty() || failed_)
      return refuse(line_, "the first line of a study file, \"# palpate-study 1\"");
    data_.header.subject = next_line("# subject ");
    if (!check_subject_code(data_.header.subject)) return refuse(line_, "\"# subject \" and a code such as S01");
    const std::string procedure = next_line("# procedure ");
    if (procedure != "constant" && procedure != "discriminate")
      return refuse(line_, "\"# procedure \" and constant or discriminate");
    if (!next_line(timing_line()).empty() || failed_) return refuse(line_, '"' + timing_line() + '"');
    if (procedure == "discriminate" && !read_strokes(next_line("# strokes ")))
      return refuse(line_, "\"# strokes \" and which, as JSON");
    next_line("# consent accepted");
    if (failed_) return refuse(line_, "\"# consent accepted\"");
    const std::string columns = columns_of(data_.header);
    if (!next_line(columns).empty() || failed_) return refuse(line_, "the columns " + columns);
    data_.whole_bytes = next_;
    while (text_.find('\n', next_) != std::string_view::npos) {
      if (const Status row = read_row(std::count(columns.begin(), columns.end(), ',')); !row) return row.error();
      data_.whole_bytes = next_;
    }
    return data_;
  }

 private:
  // Reads the next line, which must begin with `start`, and returns the rest of it.
  std::string next_line(std::string_view start) {
    const std::size_t end = text_.find('\n', next_);
    line_ = text_.substr(next_, end == std::string_view::npos ? end : end - next_);
    failed_ = end == std::string_view::npos || line_.substr(0, start.size()) != start;
    if (failed_) return "";
    next_ = end + 1;
    return std::string(line_.substr(start.size()));
  }

  // `part`: a view into the text of the file.
  Error refuse(std::string_view part, const std::string& expected) const {
    const auto offset = static_cast<std::size_t>(part.data() - text_.data());
    return Error{position_prefix(path_, position_of_offset(text_, offset)) + "found \"" + printable(part, 60) +
                 "\", expected " + expected};
  }

  bool read_strokes(const std::string& text) {
    try {
      data_.header.strokes = std::make_shared<const StrokePair>(nlohmann::json::parse(text).get<StrokePair>());
      return true;
    } catch (const nlohmann::json::exception&) {
      return false;
    }
  }

  Status read_row(std::ptrdiff_t commas) {
    next_line("");
    if (std::count(line_.begin(), line_.end(), ',') != commas)
      return refuse(line_, "a row of " + std::to_string(commas + 1) + " fields");
    StudyRecord record;
    std::optional<Error> wrong;
    std::string_view rest = line_;
    each_column(record, data_.header, [&](const char*, auto& value, const Allowed& allowed) {
      const std::string_view field = rest.substr(0, rest.find(','));
      rest.remove_prefix(std::min(rest.size(), field.size() + 1));
      if (!read_value(field, value, allowed) && !wrong) wrong = refuse(field, allowed.expected);
    });
    if (wrong) return *wrong;
    data_.records.push_back(std::move(record));
    return {};
  }

  std::string_view text_;
  const std::string& path_;
  StudyData data_;
  std::size_t next_ = 0;
  std::string_view line_;
  bool failed_ = false;
};

// "subject S01, constant stimuli".
std::string description(const StudyHeader& header) {
  const std::string subject = "subject " + header.subject + ", ";
  if (header.strokes == nullptr) return subject + "constant stimuli";
  return subject + "strokes of \"" + header.strokes->reference + "\" and \"" + header.strokes->comparison + "\" in " +
         header.strokes->recording;
}

// Whether both have the same procedure and, with strokes, the same forces and names.
bool same_procedure(const StudyHeader& one, const StudyHeader& other) {
  if (one.strokes == nullptr || other.strokes == nullptr) return one.strokes == other.strokes;
  const StrokePair &a = *one.strokes, &b = *other.strokes;
  return a.checksum == b.checksum && a.reference == b.reference && a.comparison == b.comparison &&
         a.recording == b.recording;
}

// Appends the text and flushes it to the disk. Returns 0 or errno.
int write_durably(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : EIO;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return fsync(descriptor) == 0 ? 0 : errno;
}

}  // namespace

double StudyRecord::rendered_difference() const noexcept {
  const double reference_N = reference_rendered_N();
  return (first_rendered_N + second_rendered_N - 2.0 * reference_N) / reference_N;
}

std::string study_header_text(const StudyHeader& header, const std::string& consent) {
  std::string text = "# palpate-study 1\n# subject " + header.subject + "\n# procedure " + procedure_of(header) + "\n" +
                     timing_line() + "\n";
  if (header.strokes != nullptr) text += "# strokes " + nlohmann::json(*header.strokes).dump() + "\n";
  return text + "# consent accepted, " + consent + "\n" + columns_of(header) + "\n";
}

std::string study_row(const StudyRecord& record, const StudyHeader& header) {
  std::string row;
  each_column(record, header, [&](const char*, const auto& value, const Allowed& allowed) {
    row += (row.empty() ? "" : ",") + text_of(value, allowed);
  });
  return row + "\n";
}

Result<StudyData> parse_study(const std::string& text, const std::string& path) {
  return StudyReader(text, path).read();
}

Result<StudyData> read_study(const std::string& path) {
  const Result<std::string> text = read_plain_file(path, "a study file");
  if (!text) return text.error();
  return parse_study(*text, path);
}

Status check_study_files(const std::vector<StudyData>& files) {
  if (files.empty()) return Error{"found no study file, expected one or more"};
  std::set<std::string> seen;
  for (const StudyData& file : files) {
    if (!seen.insert(file.header.subject).second)
      return Error{"found two files of subject " + file.header.subject + ", expected one; leave one of them out"};
    if (!same_procedure(file.header, files.front().header)) {
      return Error{"found a file of " + description(file.header) + " with a file of " +
                   description(files.front().header) +
                   ", expected the same procedure and forces; analyse them in separate commands"};
    }
  }
  return {};
}

Result<std::unique_ptr<StudyFile>> StudyFile::open(const std::string& path, const StudyHeader& header) {
  std::unique_ptr<StudyFile> file(new StudyFile(path, header));
  file->descriptor_ = ::open(path.c_str(), kAppending);
  if (file->descriptor_ < 0 && errno != ENOENT) return file->failure(errno);
  if (file->descriptor_ < 0) return file;
  if (const Status taken = file->take_up(); !taken) return taken.error();
  return file;
}

StudyFile::~StudyFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

Error StudyFile::failure(int error_number) const {
  return Error{"cannot write " + path_ + ": " + std::generic_category().message(error_number)};
}

// Locks and reads the file of an earlier session, or the one that `consent` has just written.
Status StudyFile::take_up() {
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return failure(errno);
    return Error{path_ + " is in use by another session; end that one first, or take another subject code"};
  }
  const Result<StudyData> data = read_study(path_);
  if (!data) return data.error();
  if (data->header.subject != header_.subject || !same_procedure(data->header, header_)) {
    return Error{path_ + ": found a study of " + description(data->header) + ", expected " + description(header_) +
                 ", with the same forces; take another folder or subject code"};
  }
  // Removes a last row that was never confirmed.
  if (ftruncate(descriptor_, static_cast<off_t>(data->whole_bytes)) != 0) return failure(errno);
  size_ = data->whole_bytes;
  consented_ = true;
  records_ = data->records;
  return {};
}

Status StudyFile::consent(const std::string& when) {
  if (consented_) return {};
  std::error_code missing;
  if (std::filesystem::exists(path_, missing))
    return Error{path_ + " was made by another session in the meantime; start again to resume it"};
  const Status written = write_file_atomically(path_, study_header_text(header_, when), false);
  if (!written) return written;
  descriptor_ = ::open(path_.c_str(), kAppending);
  return descriptor_ < 0 ? Status{failure(errno)} : take_up();
}

Status StudyFile::append(StudyRecord record) {
  if (!consented_) return Error{"cannot write " + path_ + ": there is no consent yet"};
  record.device = header_.device;
  record.rendered = header_.rendered;
  const std::string row = study_row(record, header_);
  // A row whose write failed is removed at once, or, if that fails as well, before the next row.
  const auto remove_rest = [&] { return ftruncate(descriptor_, static_cast<off_t>(size_)) == 0; };
  if (!remove_rest()) return failure(errno);
  if (const int error_number = write_durably(descriptor_, row); error_number != 0) {
    remove_rest();
    return failure(error_number);
  }
  size_ += row.size();
  records_.push_back(std::move(record));
  return {};
}

}  // namespace palpate
