// Files that appear under their final name only when they are complete, or grow there by complete pieces.
// Thread guarantee: slow side only.
#pragma once

#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace palpate {

// Collects output in a file without a name; `commit` flushes it to disk and names it. If the object is destroyed or the
// program is killed before that, no file is left but a published one. On a file system without unnamed files
// (O_TMPFILE), a program that is killed leaves a hidden file in the folder of `path`.
class AtomicFile {
 public:
  // Errors: `path` exists and `overwrite` is false, is a folder or a device; the folder is missing or not writable.
  static Result<AtomicFile> create(const std::string& path, bool overwrite);

  AtomicFile(AtomicFile&& other) noexcept;
  ~AtomicFile();

  // Appends; buffered. Errors are stored and returned by `commit`.
  void write(std::string_view text);
  // Whether an input/output error has occurred, which `commit` will return.
  bool failed() const noexcept { return error_number_ != 0; }

  // Gives the file its final name with all that was written. Each further call appends the text since the last one: all
  // of it or nothing, even if the program is killed. Errors: as `commit`.
  Status publish();

  // Errors: any input/output error since `create`, e.g. no space left; another file was created under the name in the
  // meantime, unless `overwrite`. Then the earlier or the published file, if any, is unchanged.
  Status commit();

 private:
  AtomicFile() = default;
  void discard() noexcept;
  Status take_name();
  Error failure() const;  // why nothing can be written any more
  void flush();
  void close_descriptor() noexcept;

  std::string path_;
  std::string temporary_path_;  // empty: the file has no name
  std::string buffer_;
  int descriptor_ = -1, error_number_ = 0;
  bool overwrite_ = false, published_ = false;
  long long whole_bytes_ = 0;  // length without the text of a failed write
};

// Writes `text` to `path` atomically. Errors: those of AtomicFile.
Status write_file_atomically(const std::string& path, std::string_view text, bool overwrite);

}  // namespace palpate
