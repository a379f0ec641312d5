#include "scenes/report/report_folder.h"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "engine/base/atomic_file.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

Status check_target(const fs::path& path, bool overwrite) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (!fs::exists(status)) return {};
  if (!fs::is_directory(status)) {
    return Error{"cannot write " + path.string() + ": it is not a folder; name a new one for --out"};
  }
  if (!overwrite) return Error{path.string() + " exists; pass --force to replace it"};
  if (!fs::is_empty(path, error) && !fs::exists(path / "report.json", error)) {
    return Error{path.string() +
                 " holds files but no report.json, expected an earlier report to replace; name "
                 "another folder"};
  }
  return {};
}

// Removes the slash at the end of "a/b/".
fs::path without_slash(const std::string& path) {
  fs::path clean = fs::path(path).lexically_normal();
  if (!clean.has_filename()) clean = clean.parent_path();
  return clean;
}

}  // namespace

Result<ReportFolder> ReportFolder::create(const std::string& path, bool overwrite) {
  const fs::path clean = without_slash(path);
  if (path.empty() || path == "-" || clean.filename() == "." || clean.filename() == "..") {
    return Error{"cannot write a report to \"" + path + "\": it is no name of a new folder; name one for --out"};
  }
  if (const Status target = check_target(clean, overwrite); !target) return target.error();
  const fs::path parent = clean.has_parent_path() ? clean.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(parent, error)) {
    return Error{"cannot write " + clean.string() + ": the folder " + parent.string() +
                 " does not exist; create it first"};
  }
  ReportFolder folder;
  folder.path_ = clean.string();
  folder.temporary_ = std::make_unique<ScratchFolder>(parent.string(), ".palpate-report-");
  if (folder.temporary_->path().empty()) {
    return Error{"cannot write " + clean.string() + ": the folder " + parent.string() + " is not writable (" +
                 std::generic_category().message(errno) + ")"};
  }
  // Only the owner can read a new scratch folder.
  fs::permissions(folder.temporary_->path(), static_cast<fs::perms>(0755), error);
  return folder;
}

Status ReportFolder::write(const std::string& name, std::string_view text) const {
  std::error_code ignored;
  fs::create_directories(fs::path(path_of(name)).parent_path(), ignored);
  return write_file_atomically(path_of(name), text, true);
}

Status ReportFolder::commit() {
  std::error_code error;
  // A rename cannot replace a folder with files: the earlier report is moved aside first, and moved back when the
  // rename fails.
  const std::string made = temporary_->path();
  const std::string aside = made + ".old";
  const bool replaces = fs::exists(path_, error);
  if (replaces) {
    fs::rename(path_, aside, error);
    if (error) return Error{"cannot replace " + path_ + ": " + error.message()};
  }
  fs::rename(made, path_, error);
  if (error) {
    std::error_code ignored;
    if (replaces) fs::rename(aside, path_, ignored);
    return Error{"cannot write " + path_ + ": " + error.message()};
  }
  if (replaces) fs::remove_all(aside, error);
  return {};
}

}  // namespace palpate
