#include "scenes/scene/assets.h"

#include <cstdlib>
#include <filesystem>
#include <vector>

namespace palpate {

namespace fs = std::filesystem;

Result<std::string> find_assets() {
  std::vector<fs::path> folders;
  std::error_code error;
  if (const char* named = std::getenv("PALPATE_ASSETS"); named != nullptr && *named != '\0') {
    folders = {named};
  } else {
    const fs::path prefix = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
    if (!error) folders = {prefix / "share" / "palpate", prefix / "assets"};
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

std::string calibrations_folder() {
  const Result<std::string> assets = find_assets();
  return assets ? *assets + "/devices" : "";
}

}  // namespace palpate
