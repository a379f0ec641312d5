// A folder that appears under its final name only when it is complete.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "scenes/plot/draw.h"

namespace palpate {

// Files are written into a hidden folder beside `path`, which `commit` renames. The destructor removes a folder that
// was not committed.
class ReportFolder {
 public:
  // Errors: `path` exists and `overwrite` is false, or it is not a folder, or it has files but no report.json and so
  // is no earlier report; the parent folder is missing or not writable.
  static Result<ReportFolder> create(const std::string& path, bool overwrite);

  // Writes a whole file and creates its subfolder where necessary.
  Status write(const std::string& name, std::string_view text) const;
  std::string path_of(const std::string& name) const { return temporary_->path() + "/" + name; }

  // Moves the folder to its final name and removes an earlier report there.
  Status commit();

 private:
  ReportFolder() = default;
  std::string path_;
  std::unique_ptr<ScratchFolder> temporary_;
};

}  // namespace palpate
