// A folder that is either whole under its final name or not there at all.
//
// Thread guarantee: slow side (does I/O).
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "scenes/plot/draw.h"

namespace palpate {

// Files collect in a hidden folder beside `path`; `commit` renames it. Destroyed
// without commit it leaves nothing.
class ReportFolder {
 public:
  // Errors: `path` exists and `overwrite` is false, or is not a folder; the folder
  // above is missing or not writable; `path` exists and is no earlier report (has
  // files but no report.json): it is never removed.
  static Result<ReportFolder> create(const std::string& path, bool overwrite);

  // The whole of a file; its folder, one level deep, is made when missing.
  Status write(const std::string& name, std::string_view text) const;
  std::string path_of(const std::string& name) const { return temporary_->path() + "/" + name; }

  // Under the final name now; an earlier report there is gone.
  Status commit();

 private:
  ReportFolder() = default;
  std::string path_;
  std::unique_ptr<ScratchFolder> temporary_;
};

}  // namespace palpate
