// The folders are the architecture:
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

// What each folder may include of the others, itself included.
const std::map<std::string, Names> kMayInclude = {
    {"engine", {"engine"}},
    {"models", {"models", "engine"}},
    {"devices", {"devices", "engine"}},
    {"scenes", {"scenes", "models", "devices", "engine"}},
    {"rendering", {"rendering", "scenes", "engine"}},
};

// Third parties by the folders that may know them; the start of the path counts.
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
    {"nlohmann", {"models", "devices", "scenes", "rendering"}},
};

// What is wrong with one include in a file of `folder`; empty if nothing is.
std::string judge(const std::string& folder, const std::string& included, bool quoted) {
  const std::string first = included.substr(0, included.find('/'));
  if (first == "tests") return "nothing includes tests";
  if (included.find("..") != std::string::npos) return "write it from the repository root";
  if (kMayInclude.count(first) != 0) {
    return kMayInclude.at(folder).count(first) != 0 ? "" : "against the direction of the folders";
  }
  for (const auto& [start, folders] : kOnlyIn) {
    if (included.rfind(start, 0) == 0 && folders.count(folder) == 0) return start + " does not belong here";
  }
  return quoted && included.find('/') == std::string::npos ? "write it from the repository root" : "";
}

std::vector<std::string> complaints_about(const std::string& folder, const fs::path& file) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*(["<])([^">]+)[">])");
  std::vector<std::string> complaints;
  std::ifstream stream(file);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::smatch match;
    if (!std::regex_search(line, match, kInclude)) continue;
    const std::string words = judge(folder, match[2], match[1] == "\"");
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
  for (const auto& [folder, may_include] : kMayInclude) {
    const fs::path root = fs::path(PALPATE_SOURCE_DIR) / folder;
    if (!fs::is_directory(root)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      ++sources;
      for (const std::string& complaint : complaints_about(folder, entry.path())) ADD_FAILURE() << complaint;
    }
  }
  EXPECT_GT(sources, 5) << "the sources were not found under " << PALPATE_SOURCE_DIR;
}

TEST(IncludeDirection, JudgesEachArrow) {
  EXPECT_EQ(judge("models", "engine/jnd.h", true), "");
  EXPECT_EQ(judge("scenes", "devices/hid.h", true), "");
  EXPECT_EQ(judge("engine", "vector", false), "");
  EXPECT_NE(judge("engine", "models/kernels.h", true), "");
  EXPECT_NE(judge("models", "devices/hid.h", true), "");
  EXPECT_NE(judge("devices", "models/kernels.h", true), "");
  EXPECT_NE(judge("rendering", "models/kernels.h", true), "");
  EXPECT_NE(judge("scenes", "rendering/renderer.h", true), "");
  EXPECT_NE(judge("engine", "tests/support/rt_guard.h", true), "");
  EXPECT_NE(judge("models", "GL/gl.h", false), "");
  EXPECT_NE(judge("models", "imgui.h", false), "");
  EXPECT_NE(judge("scenes", "hidapi/hidapi.h", false), "");
  EXPECT_NE(judge("engine", "jnd.h", true), "");
  EXPECT_NE(judge("engine", "../models/kernels.h", true), "");
}

}  // namespace
}  // namespace palpate
