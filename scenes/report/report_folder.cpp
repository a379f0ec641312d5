#include "scenes/report/report_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "engine/base/atomic_file.h"
#include "engine/base/whole_file.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTemporaryName = ".palpate-report-";

// Held by whoever fills the folder, until it ends in whatever way. -1: somebody else does,
// or no folder there, or a file system without locks.
int lock_folder(const fs::path& path) {
  const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0 || flock(folder, LOCK_EX | LOCK_NB) == 0) return folder;
  close(folder);
  return -1;
}

// What runs that were killed have left beside the new report. Earlier reports that they had
// moved aside (".old") are their owner's and stay.
void remove_abandoned(const fs::path& parent) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, error)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(kTemporaryName, 0) != 0 || name.find('.', 1) != std::string::npos) continue;
    const int lock = lock_folder(entry.path());
    if (lock < 0) continue;
    fs::remove_all(entry.path(), error);
    close(lock);
  }
}

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
  remove_abandoned(parent);
  ReportFolder folder;
  folder.path_ = clean.string();
  do {  // again when another run took it for abandoned before it was locked
    if (folder.lock_ >= 0) close(folder.lock_);
    folder.temporary_ = std::make_unique<ScratchFolder>(parent.string(), kTemporaryName);
    if (folder.temporary_->path().empty()) {
      return Error{"cannot write " + clean.string() + ": the folder " + parent.string() + " is not writable (" +
                   std::generic_category().message(errno) + ")"};
    }
    folder.lock_ = lock_folder(folder.temporary_->path());
  } while (folder.lock_ >= 0 && !fs::exists(folder.temporary_->path(), error));
  // As it was made it is the owner's alone.
  fs::permissions(folder.temporary_->path(), static_cast<fs::perms>(0755), error);
  return folder;
}

ReportFolder::ReportFolder(ReportFolder&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::move(other.temporary_)), lock_(std::exchange(other.lock_, -1)) {}

ReportFolder::~ReportFolder() {
  temporary_.reset();
  if (lock_ >= 0) close(lock_);
}

Status ReportFolder::write(const std::string& name, std::string_view text) const {
  std::error_code ignored;
  fs::create_directories(fs::path(path_of(name)).parent_path(), ignored);
  return write_file_atomically(path_of(name), text, true);
}

Result<std::string> ReportFolder::read(const std::string& name) const {
  const std::optional<std::string> text = read_whole_file(path_of(name));
  if (!text || text->empty())
    return Error{"gnuplot wrote no " + name + "; check that it is gnuplot 5.4 or newer (gnuplot-nox)"};
  return *text;
}

Status ReportFolder::commit() {
  std::error_code error;
  // A folder can only replace an empty one: the earlier report steps aside first, and
  // comes back when the rename fails.
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
