#include "scenes/scene/user_folders.h"

#include <cstdlib>
#include <ctime>
#include <filesystem>

namespace palpate {
namespace {

// Ignores a relative path in the variable, as the XDG Base Directory specification demands.
Result<std::string> folder(const char* variable, const char* below_home) {
  std::filesystem::path base;
  const char* wanted = std::getenv(variable);
  const char* home = std::getenv("HOME");
  if (wanted != nullptr && *wanted == '/') {
    base = wanted;
  } else if (home != nullptr && *home == '/') {
    base = std::filesystem::path(home) / below_home;
  } else {
    return Error{std::string("found neither ") + variable + " nor HOME, expected one of them to name a folder"};
  }
  base /= "palpate";
  std::error_code problem;
  std::filesystem::create_directories(base, problem);
  if (problem)
    return Error{base.string() + ": " + problem.message() + "; set " + variable + " to a folder that can be written"};
  return base.string();
}

}  // namespace

Result<std::string> config_folder() { return folder("XDG_CONFIG_HOME", ".config"); }
Result<std::string> data_folder() { return folder("XDG_DATA_HOME", ".local/share"); }

std::string local_time_text(const char* format) {
  const std::time_t time = std::time(nullptr);
  std::tm local{};
  localtime_r(&time, &local);
  char text[64] = {};
  std::strftime(text, sizeof text, format, &local);
  return text;
}

}  // namespace palpate
