// The rooms are the architecture:
//   rendering -> scenes -> { models, devices } -> engine
// where rendering draws the engine's snapshots but sees no model and no device;
// tests may include anything; nothing includes tests.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace palpate {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

// The rooms that each room may include: those in its row and, transitively, those in
// their rows. Must agree with the top-level CMakeLists.txt.
const std::map<std::string, Names> kRooms = {
    {"engine/base", {}},
    {"engine/json", {"engine/base"}},
    {"engine/recording", {"engine/base"}},
    {"engine/import", {"engine/recording"}},
    {"engine/tick", {"engine/recording"}},
    {"engine/live", {"engine/tick"}},
    {"models/model", {"engine/tick", "engine/json"}},
    {"models/export", {"models/model"}},
    {"models/library", {"models/export", "engine/live"}},
    {"models/linear", {"engine/base"}},
    {"models/training", {"models/model", "models/recordings"}},
    {"models/recordings", {"engine/tick", "models/linear"}},
    {"models/surface", {"models/training"}},
    {"models/check", {"models/surface"}},
    {"models/solve", {"models/training"}},
    {"models/fit", {"models/surface", "models/solve"}},
    {"models/fit_library", {"models/fit", "models/check", "models/library", "engine/import"}},
    {"devices/firmware", {}},
    {"devices/virtual", {"engine/live"}},
    {"devices/link", {"engine/live", "engine/json"}},
    {"devices/hid", {"devices/virtual", "devices/link", "devices/firmware"}},
    {"devices/bridge", {"devices/link", "devices/firmware"}},
    {"devices/registry", {"devices/hid", "devices/bridge"}},
    {"scenes/material", {"devices/virtual"}},
    {"scenes/scene", {"models/fit", "scenes/material"}},
    {"scenes/evaluation", {"models/surface"}},
    {"scenes/plot", {"scenes/scene"}},
    {"scenes/worker", {"scenes/scene", "scenes/evaluation"}},
    {"scenes/live", {"scenes/worker", "scenes/evaluation", "scenes/plot", "devices/registry", "engine/import"}},
    {"scenes/report", {"scenes/plot", "scenes/evaluation"}},
    {"scenes/study", {"scenes/worker", "scenes/evaluation", "devices/registry"}},
    {"scenes/cli", {"models/fit_library", "scenes/report", "scenes/study", "scenes/live"}},
    {"rendering/ui", {"scenes/live"}},
    {"rendering/picture", {"rendering/ui"}},
    {"rendering/panels", {"rendering/picture"}},
    {"rendering/app", {"rendering/panels", "scenes/study"}},
};

// The room of a path such as "models/model/rbf/kernels.h"; empty if there is none.
std::string room_of(const std::string& path) {
  const std::size_t top = path.find('/');
  const std::size_t end = top == std::string::npos ? top : path.find('/', top + 1);
  const std::string room = path.substr(0, end);
  return kRooms.count(room) != 0 ? room : "";
}

bool reaches(const std::string& from, const std::string& to) {
  if (from == to) return true;
  const Names& next = kRooms.at(from);
  return std::any_of(next.begin(), next.end(), [&](const std::string& room) { return reaches(room, to); });
}

// Rendering uses only snapshots and names. It must not include models or devices, although
// its rooms depend on them indirectly.
bool is_hidden_from(const std::string& room, const std::string& included) {
  return room.rfind("rendering/", 0) == 0 && (included.rfind("models/", 0) == 0 || included.rfind("devices/", 0) == 0);
}

// The folders and rooms that may include a third-party library, by the start of the include path.
const std::map<std::string, Names> kOnlyIn = {
    {"GL", {"rendering"}},
    {"GLES", {"rendering"}},
    {"EGL", {"rendering"}},
    {"GLFW", {"rendering"}},
    {"glad", {"rendering"}},
    {"epoxy", {"rendering"}},
    {"imgui", {"rendering"}},
    {"implot", {"rendering"}},
    {"hidapi", {"devices"}},
    {"libudev", {"devices"}},
    {"CLI", {"scenes", "rendering"}},
    {"hwy", {"models"}},
    {"nlohmann", {"engine/json", "models", "devices", "scenes", "rendering"}},
};

// The fault of an include in a file of `room`; empty if it is allowed.
std::string find_fault(const std::string& room, const std::string& included, bool quoted) {
  const std::string first = included.substr(0, included.find('/'));
  if (first == "tests") return "nothing includes tests";
  if (included.find("..") != std::string::npos) return "write it from the repository root";
  if (const std::string other = room_of(included); !other.empty()) {
    if (is_hidden_from(room, included)) return "drawing sees neither models nor devices";
    return reaches(room, other) ? "" : "against the direction of the rooms";
  }
  const std::string folder = room.substr(0, room.find('/'));
  for (const auto& [start, folders] : kOnlyIn) {
    if (included.rfind(start, 0) == 0 && folders.count(folder) == 0 && folders.count(room) == 0) {
      return start + " does not belong here";
    }
  }
  return quoted && included.find('/') == std::string::npos ? "write it from the repository root" : "";
}

std::vector<std::string> complaints_about(const std::string& room, const fs::path& file) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*(["<])([^">]+)[">])");
  std::vector<std::string> complaints;
  std::ifstream stream(file);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::smatch match;
    if (!std::regex_search(line, match, kInclude)) continue;
    const std::string words = find_fault(room, match[2], match[1] == "\"");
    if (words.empty()) continue;
    complaints.push_back(file.string() + ":" + std::to_string(number) + ": " + match[2].str() + ": " + words);
  }
  return complaints;
}

bool is_source(const fs::path& path) {
  const std::string ending = path.extension().string();
  return ending == ".cpp" || ending == ".h" || ending == ".hpp" || ending == ".c";
}

TEST(IncludeDirection, NoSourceIncludesAgainstIt) {
  int sources = 0;
  for (const std::string top : {"engine", "models", "devices", "scenes", "rendering"}) {
    const fs::path root = fs::path(PALPATE_SOURCE_DIR) / top;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      ++sources;
      const std::string room = room_of(fs::relative(entry.path(), PALPATE_SOURCE_DIR).string());
      if (room.empty()) {
        ADD_FAILURE() << entry.path() << " lies in no room; the rooms are listed in this test";
        continue;
      }
      for (const std::string& complaint : complaints_about(room, entry.path())) ADD_FAILURE() << complaint;
    }
  }
  EXPECT_GT(sources, 200) << "the sources were not found under " << PALPATE_SOURCE_DIR;
}

TEST(IncludeDirection, FindsTheFaultOfEachArrow) {
  EXPECT_EQ(find_fault("models/model", "engine/tick/jnd.h", true), "");
  EXPECT_EQ(find_fault("models/fit", "models/model/trend.h", true), "");
  EXPECT_EQ(find_fault("scenes/live", "devices/link/device_link.h", true), "");
  EXPECT_EQ(find_fault("engine/tick", "vector", false), "");
  EXPECT_NE(find_fault("engine/tick", "engine/live/pacer.h", true), "");
  EXPECT_NE(find_fault("engine/live", "models/model/trend.h", true), "");
  EXPECT_NE(find_fault("models/model", "models/linear/lapack.h", true), "");
  EXPECT_NE(find_fault("models/model", "models/training/sites.h", true), "");
  EXPECT_NE(find_fault("models/model", "devices/link/device_link.h", true), "");
  EXPECT_NE(find_fault("scenes/report", "scenes/live/live_session.h", true), "");
  EXPECT_NE(find_fault("scenes/study", "scenes/live/live_session.h", true), "");
  EXPECT_NE(find_fault("engine/live", "devices/link/device_link.h", true), "");
  EXPECT_NE(find_fault("devices/hid", "models/model/trend.h", true), "");
  EXPECT_NE(find_fault("rendering/ui", "models/model/trend.h", true), "");
  EXPECT_NE(find_fault("scenes/live", "rendering/ui/plot.h", true), "");
  EXPECT_NE(find_fault("engine/base", "tests/support/rt_guard.h", true), "");
  EXPECT_NE(find_fault("models/model", "GL/gl.h", false), "");
  EXPECT_NE(find_fault("models/model", "imgui.h", false), "");
  EXPECT_NE(find_fault("scenes/live", "hidapi/hidapi.h", false), "");
  EXPECT_NE(find_fault("engine/tick", "jnd.h", true), "");
  EXPECT_NE(find_fault("engine/tick", "../models/kernels.h", true), "");
}

}  // namespace
}  // namespace palpate
