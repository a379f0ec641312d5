// From the text of a scene file to a Scene, collecting every error on the way.
#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "engine/base/json_message.h"
#include "models/fit/methods.h"
#include "scenes/scene/scene.h"
#include "scenes/scene/jnd_file.h"

namespace palpate {
namespace {

using Json = nlohmann::json;

constexpr double kLongestRelaxation_s = 100.0;
constexpr double kLargestLength_m = 10.0;
constexpr double kLargestJndOffset_N = 100.0;
constexpr double kStrongestPress_N = 20.0;

class SceneReader {
 public:
  SceneReader(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  Result<Scene> read() {
    const Result<Json> document = parse_json_document<Json>(text_, path_);
    if (!document) return document.error();
    read_document(*document);
    if (!errors_.empty()) return Error{errors_};
    return scene_;
  }

 private:
  void complain(const std::string& pointer, const std::string& words) {
    if (!errors_.empty()) errors_ += '\n';
    errors_ += position_prefix(path_, position_of_value(text_, pointer)) + words;
  }

  // The member `key` of the object at `pointer`, or nullptr and a complaint.
  const Json* member(const Json& object, const std::string& pointer, const char* key,
                     const std::string& expected) {
    const auto entry = object.find(key);
    if (entry != object.end()) return &*entry;
    complain(pointer, std::string("found no \"") + key + "\", expected " + expected);
    return nullptr;
  }

  bool is_object(const Json& value, const std::string& pointer, std::initializer_list<const char*> keys) {
    if (!value.is_object()) {
      complain(pointer, found(value) + ", expected an object");
      return false;
    }
    std::string known;
    for (const char* key : keys) known += (known.empty() ? "" : ", ") + std::string(key);
    for (const auto& entry : value.items()) {
      const std::string& key = entry.key();
      const bool listed =
          std::any_of(keys.begin(), keys.end(), [&](const char* name) { return key == name; });
      if (!listed)
        complain(pointer + "/" + key, "found the unknown field \"" + key + "\", expected one of " + known);
    }
    return true;
  }

  std::string text(const Json& object, const std::string& pointer, const char* key) {
    const std::string expected = "a text that is not empty";
    const Json* value = member(object, pointer, key, expected);
    if (value == nullptr) return {};
    if (!value->is_string() || value->get_ref<const std::string&>().empty()) {
      complain(pointer + "/" + key, found(*value) + ", expected " + expected);
      return {};
    }
    return value->get<std::string>();
  }

  double number(const Json& object, const std::string& pointer, const char* key, const NumberRange& range) {
    const std::string expected = range.words();
    const Json* value = member(object, pointer, key, expected);
    if (value == nullptr) return 0.0;
    if (value->is_number() && range.holds(value->get<double>())) return value->get<double>();
    complain(pointer + "/" + key, found(*value) + ", expected " + expected);
    return 0.0;
  }

  Colour colour(const Json& object, const std::string& pointer, const char* key) {
    const std::string expected = "a colour such as \"#56B4E9\"";
    const Json* value = member(object, pointer, key, expected);
    if (value == nullptr) return {};
    const std::string code = value->is_string() ? value->get<std::string>() : "";
    const bool valid = code.size() == 7 && code[0] == '#' &&
                       code.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    if (!valid) {
      complain(pointer + "/" + key, found(*value) + ", expected " + expected);
      return {};
    }
    const auto channel = [&](std::size_t at) {
      return static_cast<std::uint8_t>(std::stoi(code.substr(at, 2), nullptr, 16));
    };
    return {channel(1), channel(3), channel(5)};
  }

  void read_document(const Json& document) {
    if (!is_object(document, "",
                   {"name", "title", "description", "material", "features", "jnd", "jnd_file", "block", "colours",
                    "default_models", "strongest_press_N"}))
      return;
    read_name(document);
    scene_.title = text(document, "", "title");
    scene_.description = text(document, "", "description");
    read_material(document);
    read_features(document);
    read_jnd(document);
    read_block(document);
    read_colours(document);
    read_default_models(document);
    if (document.contains("strongest_press_N")) {
      scene_.strongest_press_N = number(document, "", "strongest_press_N", {0.0, kStrongestPress_N, true});
    }
  }

  void read_name(const Json& document) {
    scene_.name = text(document, "", "name");
    const std::string stem = std::filesystem::path(path_).stem().string();
    if (!scene_.name.empty() && scene_.name != stem) {
      complain("/name", "found \"" + scene_.name + "\", expected \"" + stem + "\", the name of the file");
    }
  }

  void read_material(const Json& document) {
    const Json* value = member(document, "", "material", "the name of a virtual material, or null");
    if (value != nullptr && !value->is_null()) scene_.material = text(document, "", "material");
  }

  void read_features(const Json& document) {
    const std::string expected = "a list of 1 to " + std::to_string(kMaxFeatures) + " features";
    const Json* list = member(document, "", "features", expected);
    if (list == nullptr) return;
    if (!list->is_array() || list->empty() || list->size() > kMaxFeatures) {
      const std::string what =
          list->is_array() ? "found " + std::to_string(list->size()) + " features" : found(*list);
      complain("/features", what + ", expected " + expected);
      return;
    }
    for (std::size_t i = 0; i < list->size(); ++i) read_feature((*list)[i], "/features/" + std::to_string(i));
    const bool has_depth = std::any_of(list->begin(), list->end(), [](const Json& entry) {
      return entry.is_object() && entry.contains("kind") && entry["kind"] == "depth";
    });
    if (!has_depth)
      complain("/features", "found no feature of kind \"depth\", expected one: no force without it");
  }

  void read_feature(const Json& value, const std::string& pointer) {
    if (!is_object(value, pointer, {"kind", "relaxation_time_s"})) return;
    const Json* kind = member(value, pointer, "kind", "depth, velocity or lowpass_velocity");
    if (kind == nullptr) return;
    FeatureSpec feature;
    if (*kind == "lowpass_velocity") {
      feature.kind = FeatureKind::lowpass_velocity;
      feature.relaxation_time_s = number(value, pointer, "relaxation_time_s", {0.0, kLongestRelaxation_s, true});
    } else if (*kind == "depth" || *kind == "velocity") {
      feature.kind = *kind == "depth" ? FeatureKind::depth : FeatureKind::velocity;
      if (value.contains("relaxation_time_s")) {
        complain(pointer + "/relaxation_time_s",
                 "found a relaxation time, expected none for the kind " + kind->dump());
      }
    } else {
      complain(pointer + "/kind", found(*kind) + ", expected depth, velocity or lowpass_velocity");
      return;
    }
    add_feature(feature, pointer);
  }

  void add_feature(const FeatureSpec& feature, const std::string& pointer) {
    const bool again =
        std::any_of(scene_.features.begin(), scene_.features.end(), [&](const FeatureSpec& other) {
          return other.kind == feature.kind && other.relaxation_time_s == feature.relaxation_time_s;
        });
    if (again) complain(pointer, "found the same feature twice, expected each once");
    scene_.features.push_back(feature);
  }

  void read_jnd(const Json& document) {
    if (document.contains("jnd_file")) return read_jnd_file_of(document);
    const Json* value = member(document, "", "jnd", "an object with offset_N and weber_fraction, or a \"jnd_file\"");
    if (value == nullptr || !is_object(*value, "/jnd", {"offset_N", "weber_fraction"})) return;
    scene_.jnd.offset_N = number(*value, "/jnd", "offset_N", {0.0, kLargestJndOffset_N, true});
    scene_.jnd.weber_fraction = number(*value, "/jnd", "weber_fraction", {0.0, 1.0});
  }

  // A JND file beside the scene stands in for its own line.
  void read_jnd_file_of(const Json& document) {
    const std::string name = text(document, "", "jnd_file");
    if (document.contains("jnd")) {
      complain("/jnd_file", "found a \"jnd\" and a \"jnd_file\", expected one of them");
    }
    if (name.empty()) return;
    const Result<JndLine> line = read_jnd_file((std::filesystem::path(path_).parent_path() / name).string());
    if (line) {
      scene_.jnd = *line;
    } else {
      complain("/jnd_file", line.error().message);
    }
  }

  void read_block(const Json& document) {
    const Json* value = member(document, "", "block", "an object with the lengths of the block");
    if (value == nullptr ||
        !is_object(*value, "/block", {"width_m", "length_m", "height_m", "tool_radius_m"}))
      return;
    const auto length = [&](const char* key) {
      return number(*value, "/block", key, {0.0, kLargestLength_m, true});
    };
    scene_.block = {length("width_m"), length("length_m"), length("height_m"), length("tool_radius_m")};
  }

  void read_colours(const Json& document) {
    const Json* value = member(document, "", "colours", "an object with block and tool");
    if (value == nullptr || !is_object(*value, "/colours", {"block", "tool"})) return;
    scene_.block_colour = colour(*value, "/colours", "block");
    scene_.tool_colour = colour(*value, "/colours", "tool");
  }

  void read_default_models(const Json& document) {
    const std::string expected = "a list of methods out of " + method_names();
    const Json* list = member(document, "", "default_models", expected);
    if (list == nullptr) return;
    if (!list->is_array() || list->empty()) {
      complain("/default_models", found(*list) + ", expected " + expected);
      return;
    }
    for (std::size_t i = 0; i < list->size(); ++i) {
      const Json& entry = (*list)[i];
      if (entry.is_string() && find_method(entry.get<std::string>()) != nullptr) {
        scene_.default_models.push_back(entry.get<std::string>());
      } else {
        complain("/default_models/" + std::to_string(i), found(entry) + ", expected one of " + method_names());
      }
    }
  }

  std::string_view text_;
  std::string path_;
  Scene scene_;
  std::string errors_;
};

}  // namespace

Result<Scene> parse_scene(std::string_view text, const std::string& path) {
  try {
    return SceneReader(text, path).read();
  } catch (const std::exception& error) {
    return Error{path + ": " + error.what()};
  }
}

}  // namespace palpate
