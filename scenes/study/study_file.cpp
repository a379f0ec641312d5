#include "scenes/study/study_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>

#include "engine/base/atomic_file.h"
#include "engine/base/whole_file.h"

namespace palpate {
namespace {

std::string checksum(const std::string& text) {
  std::uint32_t hash = 0x811c9dc5u;  // FNV-1a
  for (const char letter : text) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x01000193u;
  char digits[16];
  std::snprintf(digits, sizeof digits, "%08x", static_cast<unsigned>(hash));
  return digits;
}

constexpr int kAppending = O_RDWR | O_APPEND | O_CLOEXEC;

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

Status check_subjects(const std::vector<StudyData>& files) {
  if (files.empty()) return Error{"found no study file, expected one or more"};
  std::set<std::string> seen;
  for (const StudyData& file : files) {
    const std::string& subject = file.header.subject;
    if (seen.insert(subject).second) continue;
    return Error{"found two files of subject " + subject + ", expected one; leave one of them out"};
  }
  return {};
}

Result<std::unique_ptr<StudyFile>> StudyFile::open(const std::string& path, const StudyHeader& header) {
  std::unique_ptr<StudyFile> file(new StudyFile(path, header));
  file->descriptor_ = ::open(path.c_str(), kAppending);
  if (file->descriptor_ < 0) {
    if (errno != ENOENT) return file->failure(errno);
    return file;
  }
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
  struct stat status {};
  if (fstat(descriptor_, &status) != 0) return failure(errno);
  if (!S_ISREG(status.st_mode)) return Error{path_ + " is not a regular file; name one"};
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return failure(errno);
    return Error{path_ + " is in use by another session; end that one first, or take another subject code"};
  }
  const std::optional<std::string> text = read_whole_file(path_);
  if (!text) return Error{"cannot read " + path_};
  const Result<StudyData> data = parse_study(*text, path_);
  if (!data) return data.error();
  const StudyHeader& found = data->header;
  const std::string procedure = header_.procedure();
  if (found.subject != header_.subject || found.procedure() != procedure) {
    return Error{path_ + ": found a study of subject " + found.subject + ", procedure " + found.procedure() +
                 ", expected subject " + header_.subject + ", procedure " + procedure +
                 "; take another folder or subject code"};
  }
  if (header_.strokes != nullptr && !same_strokes(*found.strokes, *header_.strokes)) {
    return Error{path_ + ": found strokes of \"" + found.strokes->reference + "\" and \"" + found.strokes->comparison +
                 "\" in " + found.strokes->recording + ", expected those of this session, \"" +
                 header_.strokes->reference + "\" and \"" + header_.strokes->comparison + "\" in " +
                 header_.strokes->recording + ", with the same forces; take another folder or subject code"};
  }
  if (data->whole_bytes < text->size() && ftruncate(descriptor_, static_cast<off_t>(data->whole_bytes)) != 0) {
    return failure(errno);
  }
  size_ = data->whole_bytes;
  consented_ = true;
  records_ = data->records;
  return {};
}

Status StudyFile::consent(const std::string& text, const std::string& when) {
  if (consented_) return {};
  std::error_code missing;
  if (std::filesystem::exists(path_, missing)) {
    return Error{path_ + " was made by another session meanwhile; start again to take it up"};
  }
  const std::string consent_line =
      "# consent accepted, text " + checksum(text) + (when.empty() ? "" : ", " + when) + "\n";
  const std::string header = study_header_text(header_) + consent_line + study_columns(header_) + "\n";
  if (const Status written = write_file_atomically(path_, header, false); !written) return written;
  descriptor_ = ::open(path_.c_str(), kAppending);
  return descriptor_ < 0 ? Status{failure(errno)} : take_up();
}

Status StudyFile::append(const StudyRecord& record) {
  if (!consented_) return Error{"cannot write " + path_ + ": there is no consent yet"};
  StudyRecord on_device = record;
  on_device.device = header_.device;
  on_device.rendered = header_.rendered;
  // Removes the rest of a row whose write failed.
  if (ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) return failure(errno);
  const std::string row = study_row(on_device, header_);
  if (const int error_number = write_durably(descriptor_, row); error_number != 0) {
    // If this fails as well, the next append or the next session truncates the file.
    [[maybe_unused]] const int taken_back = ftruncate(descriptor_, static_cast<off_t>(size_));
    return failure(error_number);
  }
  size_ += row.size();
  records_.push_back(on_device);
  return {};
}

}  // namespace palpate
