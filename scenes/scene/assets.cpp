#include "scenes/scene/assets.h"

#include <cstdlib>
#include <filesystem>

namespace palpate {

namespace fs = std::filesystem;

Result<std::string> first_assets_folder(const std::vector<std::string>& places) {
  std::string tried;
  for (const std::string& place : places) {
    std::error_code ignored;
    if (fs::is_directory(fs::path(place) / "scenes", ignored)) return place;
    tried += (tried.empty() ? "" : ", ") + place;
  }
  return Error{"cannot find the assets folder (with its subfolder scenes); looked at " + tried +
               "; set PALPATE_ASSETS to it"};
}

Result<std::string> find_assets() {
  if (const char* named = std::getenv("PALPATE_ASSETS"); named != nullptr && *named != '\0') {
    return first_assets_folder({named});
  }
  std::vector<std::string> places;
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path prefix = executable.parent_path().parent_path();
    places.push_back((prefix / "share" / "palpate").string());
    places.push_back((prefix / "assets").string());
  }
  places.emplace_back(PALPATE_SOURCE_ASSETS);
  return first_assets_folder(places);
}

}  // namespace palpate
