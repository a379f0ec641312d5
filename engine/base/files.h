// Files: written so that they appear under their final name only when they are complete, and read whole.
// Thread guarantee: slow side only (does I/O).
#pragma once

#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace palpate {

// Collects output in a file without a name; `commit` flushes it to disk and names it. If the object is destroyed or the
// program is killed before that, no file is left. On a file system without unnamed files (O_TMPFILE), a program that is
// killed leaves a hidden file in the folder of `path`.
class AtomicFile {
 public:
  // For output that takes minutes to collect: it is in `path`.part, where each `flush` adds complete pieces, and stays
  // there if the program is killed or a write fails.
  static std::string part_of(const std::string& path) { return path + ".part"; }
  // Errors: `path` exists and `overwrite` is false, is a folder or a device; the folder is missing or not writable.
  static Result<AtomicFile> create(const std::string& path, bool overwrite);
  // Errors: also, another program writes that part; it is left from a program that was killed, and `overwrite` is
  // false.
  static Result<AtomicFile> create_in_part(const std::string& path, bool overwrite);

  AtomicFile(AtomicFile&& other) noexcept;
  ~AtomicFile();

  // Appends; buffered. Errors are stored and returned by `commit`.
  void write(std::string_view text);
  // Whether an input/output error has occurred, which `commit` will return.
  bool failed() const noexcept { return error_number_ != 0; }

  // Adds what was written to the part: all of it or nothing, even if the disk is full. Errors: as `commit`.
  Status flush_part();

  // Errors: any input/output error since `create`, e.g. no space left; another file was created under the name in the
  // meantime, unless `overwrite`. Then the earlier file, if any, is unchanged.
  Status commit();

 private:
  AtomicFile() = default;
  static Result<AtomicFile> prepare(const std::string& path, bool overwrite);
  Error refused_folder() const;  // by errno
  void discard() noexcept;
  Status take_name();
  Error failure() const;  // why nothing can be written any more
  void flush();
  void close_descriptor() noexcept;

  std::string path_;
  std::string temporary_path_;  // empty: the file has no name
  std::string buffer_;
  int descriptor_ = -1, error_number_ = 0;
  bool overwrite_ = false, in_part_ = false;
  long long whole_bytes_ = 0;  // length without the text of a failed write
};

// Writes `text` to `path` atomically. Errors: those of AtomicFile.
Status write_file_atomically(const std::string& path, std::string_view text, bool overwrite);

// Opens a regular file for reading; a pipe or a device could block or never end.
// `expected`: "a model file", for messages; `or_else`: further advice if there is no such file, ", or ...". Errors: no
// such file, a folder, a pipe or a device, no permission.
Result<std::unique_ptr<std::istream>> open_plain_file(const std::string& path, const std::string& expected,
                                                      const std::string& or_else = "");
// The error of a stream that cannot be read, by errno.
Error unreadable(const std::string& path);
// The limit for all files except models and recordings.
inline constexpr std::size_t kSmallFileBytes = std::size_t{64} << 20;
// Reads all bytes. Errors: as above, a file that cannot be read, and a file beyond `most_bytes`.
Result<std::string> read_plain_file(const std::string& path, const std::string& expected,
                                    const std::string& or_else = "", std::size_t most_bytes = kSmallFileBytes);
// Reads all bytes; none if the file cannot be read for any reason.
std::optional<std::string> read_whole_file(const std::string& path);

}  // namespace palpate
