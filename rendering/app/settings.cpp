#include "rendering/app/settings.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/base/atomic_file.h"
#include "engine/base/whole_file.h"

namespace palpate {
namespace {

using Json = nlohmann::ordered_json;

// The field, if it has the type of the default, else the default.
template <typename T>
T field(const Json& json, const char* name, const T& otherwise) {
  try {
    return json.value(name, otherwise);
  } catch (const Json::type_error&) {
    return otherwise;
  }
}

}  // namespace

Result<Settings> read_settings(const std::string& path) {
  Settings settings;
  const auto text = read_whole_file(path);
  if (!text) return settings;
  const Json json = Json::parse(*text, nullptr, false);
  if (!json.is_object())
    return Error{path + ": found no JSON object, expected the window's settings; the defaults are used"};
  if (field<std::string>(json, "theme", "") == "dark") settings.theme = Theme::dark;
  const double blocks = field(json, "blocks", 4.0);
  settings.block_count = blocks == 1.0 ? 1 : blocks == 2.0 ? 2 : 4;
  settings.difference = field(json, "difference", settings.difference);
  settings.text_size = std::clamp(field(json, "text_size", 1.0F), kSmallestText, kLargestText);
  settings.line_up = field(json, "line_up", settings.line_up);
  settings.recent = field(json, "recent", settings.recent);
  // The camera limits pitch and distance itself.
  settings.camera = {std::clamp(field(json, "camera_yaw_rad", 0.0F), -6.3F, 6.3F),
                     field(json, "camera_pitch_rad", 0.0F), field(json, "camera_distance", 1.0F)};
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
