#include "rendering/app/settings.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/base/atomic_file.h"
#include "engine/base/whole_file.h"

namespace palpate {
namespace {

using Json = nlohmann::ordered_json;

template <typename T>
T field(const Json& json, const char* name, T otherwise, T low, T high) {
  const auto found = json.find(name);
  if (found == json.end() || !found->is_number()) return otherwise;
  return std::clamp(found->get<T>(), low, high);
}

}  // namespace

Result<Settings> read_settings(const std::string& path) {
  Settings settings;
  const auto text = read_whole_file(path);
  if (!text) return settings;
  const Json json = Json::parse(*text, nullptr, false);
  if (!json.is_object())
    return Error{path + ": found no JSON object, expected the window's settings; the defaults are used"};
  if (json.value("theme", Json()) == "dark") settings.theme = Theme::dark;
  const auto blocks = field<std::size_t>(json, "blocks", settings.block_count, 1, 4);
  settings.block_count = blocks == 3 ? 4 : blocks;
  if (json.contains("difference") && json["difference"].is_boolean())
    settings.difference = json["difference"].get<bool>();
  settings.text_size = field(json, "text_size", 1.0F, kSmallestText, kLargestText);
  if (json.contains("line_up") && json["line_up"].is_string()) settings.line_up = json["line_up"].get<std::string>();
  for (const Json& one : json.value("recent", Json::array()))
    if (one.is_string()) settings.recent.push_back(one.get<std::string>());
  settings.camera.yaw_rad = field(json, "camera_yaw_rad", 0.0F, -6.3F, 6.3F);
  settings.camera.pitch_rad = field(json, "camera_pitch_rad", 0.0F, -1.5F, 1.5F);
  settings.camera.distance = field(json, "camera_distance", 1.0F, 0.2F, 5.0F);
  return settings;
}

Status write_settings(const std::string& path, const Settings& settings) {
  const Json json = {{"theme", settings.theme == Theme::dark ? "dark" : "light"},
                     {"blocks", settings.block_count},
                     {"difference", settings.difference},
                     {"text_size", settings.text_size},
                     {"line_up", settings.line_up},
                     {"recent", settings.recent},
                     {"camera_yaw_rad", settings.camera.yaw_rad},
                     {"camera_pitch_rad", settings.camera.pitch_rad},
                     {"camera_distance", settings.camera.distance}};
  return write_file_atomically(path, json.dump(2) + "\n", true);
}

}  // namespace palpate
