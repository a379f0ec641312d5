#include "scenes/scene/folders.h"

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <vector>

namespace palpate {
namespace {

namespace fs = std::filesystem;

// Of the executable; empty if unknown.
fs::path program_folder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

// Creates the folder. Ignores a relative path in the variable, as the specification demands.
Result<std::string> user_folder(const char* variable, const char* below_home) {
  const char* wanted = std::getenv(variable);
  const char* home = std::getenv("HOME");
  fs::path base;
  if (wanted != nullptr && *wanted == '/') {
    base = wanted;
  } else if (home != nullptr && *home == '/') {
    base = fs::path(home) / below_home;
  } else {
    return Error{std::string("found neither ") + variable + " nor HOME, expected one of them to name a folder"};
  }
  base /= "palpate";
  std::error_code problem;
  fs::create_directories(base, problem);
  if (!problem) return base.string();
  return Error{base.string() + ": " + problem.message() + "; set " + variable + " to a folder that can be written"};
}

}  // namespace

Result<std::string> find_assets() {
  std::vector<fs::path> folders;
  std::error_code error;
  if (const char* named = std::getenv("PALPATE_ASSETS"); named != nullptr && *named != '\0') {
    folders = {named};
  } else {
    const fs::path prefix = program_folder().parent_path();
    if (!prefix.empty()) folders = {prefix / "share" / "palpate", prefix / "assets"};
    folders.emplace_back(PALPATE_SOURCE_ASSETS);
  }
  std::string tried;
  for (const fs::path& folder : folders) {
    if (fs::is_directory(folder / "scenes", error)) return folder.string();
    tried += (tried.empty() ? "" : ", ") + folder.string();
  }
  return Error{"cannot find the assets folder (with its subfolder scenes); looked at " + tried +
               "; set PALPATE_ASSETS to it"};
}

std::string ready_models_folder() {
  const fs::path program = program_folder();
  std::error_code error;
  for (const fs::path& folder : {program.parent_path() / "share" / "palpate" / "ready", program / "ready"})
    if (fs::is_directory(folder, error)) return folder.string();
  return "";
}

std::string calibrations_folder() {
  const Result<std::string> assets = find_assets();
  return assets ? *assets + "/devices" : "";
}

Result<std::string> config_folder() { return user_folder("XDG_CONFIG_HOME", ".config"); }
Result<std::string> data_folder() { return user_folder("XDG_DATA_HOME", ".local/share"); }

std::string local_time_text(const char* format) {
  const std::time_t time = std::time(nullptr);
  std::tm local{};
  localtime_r(&time, &local);
  char text[64] = {};
  std::strftime(text, sizeof text, format, &local);
  return text;
}

}  // namespace palpate
