#include "scenes/report/page/report_folder.h"

#include <stdlib.h>

#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "engine/base/atomic_file.h"
#include "engine/base/temporary_paths.h"
#include "engine/base/whole_file.h"

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
    return Error{path.string() + " holds files but no report.json, expected an earlier report to replace; name "
                 "another folder"};
  }
  return {};
}

// "a/b/" and "a/b" are one.
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
  std::string pattern = (parent / ".palpate-report-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    return Error{"cannot write " + clean.string() + ": the folder " + parent.string() + " is not writable (" +
                 std::generic_category().message(errno) + ")"};
  }
  // mkdtemp leaves it to the owner alone.
  fs::permissions(pattern, fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec |
                               fs::perms::others_read | fs::perms::others_exec, error);
  ReportFolder folder;
  folder.path_ = clean.string();
  folder.temporary_ = pattern;
  folder.registry_slot_ = register_temporary(pattern);
  return folder;
}

ReportFolder::ReportFolder(ReportFolder&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})),
      registry_slot_(std::exchange(other.registry_slot_, -1)) {}

ReportFolder::~ReportFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  unregister_temporary(registry_slot_);
}

Status ReportFolder::write(const std::string& name, std::string_view text) const {
  std::error_code ignored;
  fs::create_directories(fs::path(path_of(name)).parent_path(), ignored);
  return write_file_atomically(path_of(name), text, true);
}

Result<std::string> ReportFolder::read(const std::string& name) const {
  const std::optional<std::string> text = read_whole_file(path_of(name));
  if (!text || text->empty()) return Error{"gnuplot wrote no " + name + "; check that it is gnuplot 5.4 or newer (gnuplot-nox)"};
  return *text;
}

Status ReportFolder::commit() {
  std::error_code error;
  // A folder can only replace an empty one: the earlier report steps aside first, and
  // comes back when the rename fails.
  const std::string aside = temporary_ + ".old";
  const bool replaces = fs::exists(path_, error);
  if (replaces) {
    fs::rename(path_, aside, error);
    if (error) return Error{"cannot replace " + path_ + ": " + error.message()};
  }
  fs::rename(temporary_, path_, error);
  if (error) {
    std::error_code ignored;
    if (replaces) fs::rename(aside, path_, ignored);
    return Error{"cannot write " + path_ + ": " + error.message()};
  }
  temporary_.clear();
  if (replaces) fs::remove_all(aside, error);
  return {};
}

}  // namespace palpate
