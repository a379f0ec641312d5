#include "engine/base/files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

namespace palpate {
namespace {

constexpr std::size_t kFlushBytes = std::size_t{1} << 18;

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

// The temporary file is in the folder of the final one, so that the rename cannot cross disks.
std::string temporary_name_in(const std::string& folder) {
  std::uint64_t random = 0;
  static_cast<void>(getentropy(&random, sizeof random));  // so few bytes are always there
  return folder + "/.palpate-" + std::to_string(random) + ".tmp";
}

std::string words_for(int error_number) { return std::generic_category().message(error_number); }

Error already_exists(const std::string& path) {
  return Error{path + " exists; choose another name, or pass --force to replace it"};
}

// Checks whether something that exists under the final name forbids writing.
Status check_target(const std::string& path, bool overwrite) {
  if (path.empty()) return Error{"the name of the output file is empty"};
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return {};
  if (S_ISDIR(status.st_mode)) return Error{"cannot write " + path + ": it is a folder; name a file"};
  if (!S_ISREG(status.st_mode) && !S_ISLNK(status.st_mode))
    return Error{"cannot write " + path + ": it is not a regular file; name one"};
  if (!overwrite) return already_exists(path);
  return {};
}

// Renames without replacing, atomically, so that a file that appears in the last moment survives. On file systems
// without the flag a hard link is used, which also refuses an existing name. Returns an errno, 0 if done.
int rename_without_replacing(const char* from, const char* to) {
  if (renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  if (link(from, to) != 0) return errno;
  unlink(from);
  return 0;
}

// The path of an open file in /proc, the only path of a file without a name.
std::string link_to(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }

// Flushes the folder of `path`, so that a new name in it survives a power cut; does nothing where the file system
// cannot.
void flush_folder_of(const std::string& path) {
  const int descriptor = open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

// A file that replaces another has its permissions.
void copy_mode(const std::string& path, int descriptor) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode)) fchmod(descriptor, status.st_mode & 0777);
}

}  // namespace

Result<AtomicFile> AtomicFile::prepare(const std::string& path, bool overwrite) {
  if (path == "-")
    return Error{"found - as the file to write, expected a name: standard output has the results; ./- is a file"};
  if (const Status target = check_target(path, overwrite); !target) return target.error();
  AtomicFile file;
  file.path_ = path;
  file.overwrite_ = overwrite;
  return file;
}

Error AtomicFile::refused_folder() const {
  const std::string why =
      errno == ENOENT ? " does not exist; create it first" : " takes no new file: " + words_for(errno);
  return Error{"cannot write " + path_ + ": the folder " + folder_of(path_) + why};
}

Result<AtomicFile> AtomicFile::create(const std::string& path, bool overwrite) {
  Result<AtomicFile> prepared = prepare(path, overwrite);
  if (!prepared) return prepared;
  AtomicFile& file = *prepared;
  const std::string folder = folder_of(path);
  file.descriptor_ = open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
  copy_mode(path, file.descriptor_);
  if (file.descriptor_ >= 0 && access(link_to(file.descriptor_).c_str(), F_OK) == 0) return prepared;
  file.close_descriptor();
  file.temporary_path_ = temporary_name_in(folder);
  file.descriptor_ = open(file.temporary_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file.descriptor_ < 0) return file.refused_folder();
  copy_mode(path, file.descriptor_);
  return prepared;
}

// The lock of the part, which the system removes with the process, tells a part that is being written from one that was
// left.
Result<AtomicFile> AtomicFile::create_in_part(const std::string& path, bool overwrite) {
  Result<AtomicFile> prepared = prepare(path, overwrite);
  if (!prepared) return prepared;
  const std::string part = part_of(path);
  AtomicFile& file = *prepared;
  file.descriptor_ = open(part.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (file.descriptor_ < 0) return file.refused_folder();
  if (flock(file.descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    return Error{part + ": another program is writing it; choose another name, or end that program"};
  struct stat status {};
  if (fstat(file.descriptor_, &status) == 0 && status.st_size > 0 && !overwrite)
    return Error{part + " is left from a program that was killed; rename it to keep it, or delete it"};
  if (ftruncate(file.descriptor_, 0) != 0) return file.refused_folder();
  copy_mode(path, file.descriptor_);
  file.temporary_path_ = part;
  file.in_part_ = true;
  return prepared;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_path_(std::move(other.temporary_path_)),
      buffer_(std::move(other.buffer_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      error_number_(other.error_number_),
      overwrite_(other.overwrite_),
      in_part_(other.in_part_),
      whole_bytes_(other.whole_bytes_) {}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::close_descriptor() noexcept {
  if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
}

void AtomicFile::discard() noexcept {
  const bool keeps_part = in_part_ && error_number_ != 0 && whole_bytes_ > 0;
  if (descriptor_ >= 0 && !temporary_path_.empty() && !keeps_part) unlink(temporary_path_.c_str());
  close_descriptor();
}

void AtomicFile::flush() {
  const char* next = buffer_.data();
  std::size_t left = buffer_.size();
  while (left > 0 && error_number_ == 0) {
    const ssize_t written = ::write(descriptor_, next, left);
    if (written < 0) {
      if (errno != EINTR) error_number_ = errno;
      continue;
    }
    next += written;
    left -= static_cast<std::size_t>(written);
  }
  buffer_.clear();
  if (error_number_ == 0)
    whole_bytes_ = lseek(descriptor_, 0, SEEK_END);
  else if (in_part_ && ftruncate(descriptor_, whole_bytes_) != 0)
    error_number_ = errno;
}

void AtomicFile::write(std::string_view text) {
  if (descriptor_ < 0 || error_number_ != 0) return;
  buffer_.append(text);
  // A part has complete pieces only, which `flush_part` and `commit` write.
  if (buffer_.size() >= kFlushBytes && !in_part_) flush();
}

Error AtomicFile::failure() const {
  if (error_number_ == 0) return Error{"cannot write " + path_ + ": it is closed already"};
  if (error_number_ == EEXIST) return already_exists(path_);
  return Error{"cannot write " + path_ + ": " + words_for(error_number_)};
}

Status AtomicFile::take_name() {
  if (error_number_ == 0 && temporary_path_.empty()) {
    temporary_path_ = temporary_name_in(folder_of(path_));
    const std::string link = link_to(descriptor_);
    if (linkat(AT_FDCWD, link.c_str(), AT_FDCWD, temporary_path_.c_str(), AT_SYMLINK_FOLLOW) != 0)
      error_number_ = errno;
  }
  if (error_number_ == 0) {
    error_number_ = overwrite_ ? (rename(temporary_path_.c_str(), path_.c_str()) == 0 ? 0 : errno)
                               : rename_without_replacing(temporary_path_.c_str(), path_.c_str());
  }
  if (error_number_ == 0) return {};
  discard();
  return failure();
}

Status AtomicFile::flush_part() {
  if (descriptor_ < 0) return failure();
  flush();
  return error_number_ == 0 ? Status() : failure();
}

Status AtomicFile::commit() {
  if (descriptor_ < 0) return failure();
  flush();
  if (error_number_ == 0 && fsync(descriptor_) != 0) error_number_ = errno;
  if (const Status taken = take_name(); !taken) return taken;
  close_descriptor();
  flush_folder_of(path_);
  return {};
}

Status write_file_atomically(const std::string& path, std::string_view text, bool overwrite) {
  Result<AtomicFile> file = AtomicFile::create(path, overwrite);
  if (!file) return file.error();
  file->write(text);
  return file->commit();
}

Result<std::unique_ptr<std::istream>> open_plain_file(const std::string& path, const std::string& expected,
                                                      const std::string& or_else) {
  const auto wrong = [&](const std::string& found, const std::string& advice) {
    return Error{path + ": found " + found + ", expected " + expected + "; " + advice};
  };
  struct stat status {};
  // stat comes first, because opening can block and can affect a device.
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return wrong("a folder", "name a file in it");
  if (exists && !S_ISREG(status.st_mode)) return wrong("a pipe or a device", "save it to a file first");
  if (exists) {
    auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
    if (*file) return Result<std::unique_ptr<std::istream>>(std::move(file));
  }
  if (errno == ENOENT || errno == ENOTDIR) return wrong("no such file", "check the path" + or_else);
  if (errno == EACCES || errno == EPERM) return wrong("no permission to read it", "change its permissions (chmod u+r)");
  return Error{path + ": the file cannot be opened (" + std::strerror(errno) + "); check the path"};
}

Error unreadable(const std::string& path) {
  return Error{path + ": the file cannot be read (" + std::strerror(errno) +
               "); check the disk or copy the file elsewhere"};
}

Result<std::string> read_plain_file(const std::string& path, const std::string& expected, const std::string& or_else,
                                    std::size_t most_bytes) {
  const auto file = open_plain_file(path, expected, or_else);
  if (!file) return file.error();
  std::string text;
  std::string chunk(std::size_t{1} << 18, '\0');
  while (**file) {
    (*file)->read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    if ((*file)->bad()) return unreadable(path);
    text.append(chunk, 0, static_cast<std::size_t>((*file)->gcount()));
    if (text.size() > most_bytes)
      return Error{path + ": found more than " + std::to_string(most_bytes >> 20) + " MiB, expected " + expected +
                   "; split the file or name another one"};
  }
  return text;
}

std::optional<std::string> read_whole_file(const std::string& path) {
  Result<std::string> text = read_plain_file(path, "a small file");
  if (!text) return std::nullopt;
  return std::move(*text);
}

}  // namespace palpate
