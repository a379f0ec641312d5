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
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

// The rooms that each room may include directly: those to which CMakeLists.txt links it by
//   palpate_room(NAME FOLDER [LIBRARY...])
std::map<std::string, Names> read_rooms() {
  std::map<std::string, Names> rooms;
  std::map<std::string, std::string> folder_of;
  const std::string text = test::read_text(PALPATE_SOURCE_DIR "/CMakeLists.txt");
  static const std::regex kRoom(R"(\n *palpate_room\((\w+) (\S+)([^)]*)\))");
  for (std::sregex_iterator room(text.begin(), text.end(), kRoom), end; room != end; ++room) {
    const std::string folder = (*room)[2];
    folder_of[(*room)[1]] = folder;
    Names& included = rooms[folder];
    std::istringstream libraries((*room)[3]);
    for (std::string library; libraries >> library;)
      if (folder_of.count(library) != 0) included.insert(folder_of[library]);
  }
  // Headers only, without a target.
  rooms["devices/firmware"] = {};
  for (const char* room : {"devices/hid", "devices/bridge"}) rooms[room].insert("devices/firmware");
  return rooms;
}

const std::map<std::string, Names>& rooms() {
  static const std::map<std::string, Names> all = read_rooms();
  return all;
}

// The room of a path such as "models/model/file/model_io.h"; empty if there is none.
std::string room_of(const std::string& path) {
  const std::size_t top = path.find('/');
  const std::size_t end = top == std::string::npos ? top : path.find('/', top + 1);
  const std::string room = path.substr(0, end);
  return rooms().count(room) != 0 ? room : "";
}

bool reaches(const std::string& from, const std::string& to) {
  if (from == to) return true;
  const Names& next = rooms().at(from);
  return std::any_of(next.begin(), next.end(), [&](const std::string& room) { return reaches(room, to); });
}

// The folders that each folder may include. Rendering uses only snapshots and names, although its rooms are linked to
// models and devices.
const std::map<std::string, Names> kFolders = {{"engine", {"engine"}},
                                               {"models", {"engine", "models"}},
                                               {"devices", {"engine", "devices"}},
                                               {"scenes", {"engine", "models", "devices", "scenes"}},
                                               {"rendering", {"engine", "scenes", "rendering"}}};

// The folders and rooms that may include a third-party library, by the start of the include path.
const std::map<std::string, Names> kOnlyIn = {
    {"GL", {"rendering"}},
    {"EGL", {"rendering"}},
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
  const std::string folder = room.substr(0, room.find('/'));
  if (const std::string other = room_of(included); !other.empty()) {
    const bool allowed = kFolders.at(folder).count(first) != 0 && reaches(room, other);
    return allowed ? "" : "against the direction of the rooms";
  }
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
  for (const auto& [top, allowed] : kFolders) {
    const fs::path root = fs::path(PALPATE_SOURCE_DIR) / top;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      ++sources;
      const std::string room = room_of(fs::relative(entry.path(), PALPATE_SOURCE_DIR).string());
      if (room.empty()) {
        ADD_FAILURE() << entry.path() << " lies in no room; CMakeLists.txt lists the rooms";
        continue;
      }
      for (const std::string& complaint : complaints_about(room, entry.path())) ADD_FAILURE() << complaint;
    }
  }
  EXPECT_GT(sources, 200) << "the sources were not found under " << PALPATE_SOURCE_DIR;
}

TEST(IncludeDirection, FindsTheFaultOfEachArrow) {
  EXPECT_EQ(find_fault("models/model", "engine/tick/jnd.h", true), "");
  EXPECT_EQ(find_fault("models/fit", "models/model/fitted_model.h", true), "");
  EXPECT_EQ(find_fault("scenes/live", "devices/link/device_link.h", true), "");
  EXPECT_EQ(find_fault("engine/tick", "vector", false), "");
  EXPECT_NE(find_fault("engine/tick", "engine/live/pacer.h", true), "");
  EXPECT_NE(find_fault("engine/live", "models/model/fitted_model.h", true), "");
  EXPECT_NE(find_fault("models/model", "models/linear/lapack.h", true), "");
  EXPECT_NE(find_fault("models/model", "models/correction/methods.h", true), "");
  EXPECT_NE(find_fault("models/model", "devices/link/device_link.h", true), "");
  EXPECT_NE(find_fault("scenes/report", "scenes/live/live_session.h", true), "");
  EXPECT_NE(find_fault("scenes/study", "scenes/live/live_session.h", true), "");
  EXPECT_NE(find_fault("engine/live", "devices/link/device_link.h", true), "");
  EXPECT_NE(find_fault("devices/hid", "models/model/fitted_model.h", true), "");
  EXPECT_NE(find_fault("rendering/ui", "models/model/fitted_model.h", true), "");
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
