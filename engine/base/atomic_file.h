// Files that are either whole under their final name or not there at all, or grow there
// by whole pieces.
//
// Thread guarantee: slow side only.
#pragma once

#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace palpate {

// Collects output in a file without a name; `commit` flushes it to disk and names it.
// Destroyed without commit, killed or interrupted, it leaves nothing under the final name,
// and nothing at all where the file system knows files without a name (O_TMPFILE): elsewhere
// it is a hidden file beside `path`, which a program that is killed leaves behind.
class AtomicFile {
 public:
  // Errors: `path` exists and `overwrite` is false ("... exists; pass --force
  // to replace it"), is a folder or a device; the folder is missing or not
  // writable.
  static Result<AtomicFile> create(const std::string& path, bool overwrite);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  ~AtomicFile();

  // Appends; buffered. Errors are kept and reported by commit.
  void write(std::string_view text);
  // Whether the disk has refused something already; commit says what.
  bool failed() const noexcept { return error_number_ != 0; }

  // From now on the file stands under its final name with all that was written, and
  // every further call adds to it: whole pieces of text between two calls, whenever the
  // program is killed. Where the disk refuses a piece, the file keeps those before.
  // Errors: as `commit`.
  Status publish();

  // Errors: anything the disk refused since `create`, e.g. no space left; a
  // file of that name made by someone else meanwhile, unless `overwrite`. Then
  // nothing is left under the final name but what was there before, or was published.
  Status commit();

 private:
  AtomicFile() = default;
  void discard() noexcept;
  std::string path_;
  std::string temporary_path_;  // empty: the file has no name
  Status take_name();
  Status failure(int error_number) const;
  Status closed() const;
  void flush();
  void close_descriptor() noexcept;
  std::string buffer_;
  int descriptor_ = -1;
  int error_number_ = 0;
  bool overwrite_ = false;
  bool published_ = false;
  long long whole_bytes_ = 0;  // published
};

// Makes a new name in the folder of `path` last. Some file systems cannot flush a folder; the
// file is whole under its name either way, so a refusal is not an error.
void flush_folder_of(const std::string& path);

// Writes `text` to `path` in one go; errors as AtomicFile.
Status write_file_atomically(const std::string& path, std::string_view text, bool overwrite);

}  // namespace palpate
