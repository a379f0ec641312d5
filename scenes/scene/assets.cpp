#include "scenes/scene/assets.h"

#include <cstdlib>
#include <filesystem>
#include <vector>

namespace palpate {

namespace fs = std::filesystem;

Result<std::string> find_assets() {
  std::vector<fs::path> places;
  std::error_code error;
  if (const char* named = std::getenv("PALPATE_ASSETS"); named != nullptr && *named != '\0') {
    places = {named};
  } else {
    const fs::path prefix = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
    if (!error) places = {prefix / "share" / "palpate", prefix / "assets"};
    places.emplace_back(PALPATE_SOURCE_ASSETS);
  }
  std::string tried;
  for (const fs::path& place : places) {
    if (fs::is_directory(place / "scenes", error)) return place.string();
    tried += (tried.empty() ? "" : ", ") + place.string();
  }
  return Error{"cannot find the assets folder (with its subfolder scenes); looked at " + tried +
               "; set PALPATE_ASSETS to it"};
}

std::string calibrations_folder() {
  const Result<std::string> assets = find_assets();
  return assets ? *assets + "/devices" : "";
}

}  // namespace palpate
