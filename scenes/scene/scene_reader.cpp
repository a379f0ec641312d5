// Reads a Scene from the text of a scene file, and collects all errors.
#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/json/json_fields.h"
#include "models/fit/methods.h"
#include "scenes/material/material.h"
#include "scenes/scene/jnd_file.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

using Json = nlohmann::json;

// The largest depth of nesting; the format needs three levels.
constexpr int kSceneNesting = 8;
constexpr double kLongestRelaxation_s = 100.0;
constexpr double kLargestLength_m = 10.0;
constexpr double kLargestJndOffset_N = 100.0;
constexpr double kStrongestPress_N = 20.0;

class SceneReader : private JsonFields {
 public:
  SceneReader(std::string_view text, const std::string& path, const Json& document)
      : JsonFields(text, path, ""), path_(path), top_{&document, ""} {}

  Result<Scene> read() {
    read_name();
    scene_.title = filled_text(top_, "title");
    scene_.description = filled_text(top_, "description");
    read_material();
    read_features();
    read_jnd();
    read_block();
    read_colours();
    read_default_models();
    if (optional_member(top_, "strongest_press_N").value != nullptr) {
      scene_.strongest_press_N = number(top_, "strongest_press_N", {0.0, kStrongestPress_N, true});
    }
    refuse_unknown(top_);
    if (std::optional<Error> wrong = error()) return *wrong;
    return scene_;
  }

 private:
  Colour colour(const JsonNode& object, const char* key) {
    const std::string expected = "a colour such as \"#56B4E9\"";
    const JsonNode node = member(object, key, expected);
    if (node.value == nullptr) return {};
    const std::string code = node.value->is_string() ? node.value->get<std::string>() : "";
    const bool valid =
        code.size() == 7 && code[0] == '#' && code.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    if (!valid) {
      complain(node.pointer, found(*node.value) + ", expected " + expected);
      return {};
    }
    const auto channel = [&](std::size_t at) {
      return static_cast<std::uint8_t>(std::stoi(code.substr(at, 2), nullptr, 16));
    };
    return {channel(1), channel(3), channel(5)};
  }

  void read_name() {
    scene_.name = filled_text(top_, "name");
    const std::string stem = std::filesystem::path(path_).stem().string();
    if (scene_.name != stem) {
      complain("/name", "found \"" + scene_.name + "\", expected \"" + stem + "\", the name of the file");
    }
  }

  void read_material() {
    const JsonNode node = member(top_, "material", "the name of a virtual material, or null");
    if (node.value == nullptr || node.value->is_null()) return;
    std::vector<std::string> names;
    for (const Material& material : materials()) names.emplace_back(material.name);
    if (const auto index = choice(node, names)) scene_.material = names[*index];
  }

  void read_features() {
    const std::string expected = "a list of 1 to " + std::to_string(kMaxFeatures) + " features";
    const JsonNode node = list(top_, "features", expected);
    if (node.value == nullptr) return;
    if (node.value->empty() || node.value->size() > kMaxFeatures) {
      complain(node.pointer, found(*node.value) + ", expected " + expected);
      return;
    }
    bool has_depth = false;
    for (std::size_t i = 0; i < node.value->size(); ++i) {
      read_feature(entry(node, i));
      has_depth = has_depth || scene_.features.back().kind == FeatureKind::depth;
    }
    if (!has_depth) {
      complain("/features", "found no feature of kind \"depth\", expected one: every force depends on the depth");
    }
  }

  void read_feature(const JsonNode& node) {
    static const std::vector<std::string> kKinds = {"depth", "velocity", "lowpass_velocity"};
    constexpr std::array kValues = {FeatureKind::depth, FeatureKind::velocity, FeatureKind::lowpass_velocity};
    FeatureSpec feature;
    const auto kind = choice(member(node, "kind", "depth, velocity or lowpass_velocity"), kKinds);
    feature.kind = kind ? kValues[*kind] : FeatureKind::velocity;
    const JsonNode time = optional_member(node, "relaxation_time_s");
    if (feature.kind == FeatureKind::lowpass_velocity) {
      feature.relaxation_time_s = number(node, "relaxation_time_s", {0.0, kLongestRelaxation_s, true});
    } else if (kind && time.value != nullptr) {
      complain(time.pointer, "found a relaxation time, expected none for the kind \"" + kKinds[*kind] + "\"");
    }
    const bool again = std::any_of(scene_.features.begin(), scene_.features.end(), [&](const FeatureSpec& other) {
      return other.kind == feature.kind && other.relaxation_time_s == feature.relaxation_time_s;
    });
    if (kind && again) complain(node.pointer, "found the same feature twice, expected each once");
    scene_.features.push_back(feature);
  }

  void read_jnd() {
    if (optional_member(top_, "jnd_file").value != nullptr) return read_jnd_file_of_scene();
    const JsonNode node = member(top_, "jnd", "an object with offset_N and weber_fraction, or a \"jnd_file\"");
    scene_.jnd.offset_N = number(node, "offset_N", {0.0, kLargestJndOffset_N, true});
    scene_.jnd.weber_fraction = number(node, "weber_fraction", {0.0, 1.0});
  }

  // Reads the JND line from a file beside the scene, instead of the member "jnd".
  void read_jnd_file_of_scene() {
    const std::string name = filled_text(top_, "jnd_file");
    const JsonNode line = optional_member(top_, "jnd");
    if (line.value != nullptr) complain(line.pointer, "found a \"jnd\" and a \"jnd_file\", expected one of them");
    if (name.empty()) return;
    const Result<JndLine> read = read_jnd_file((std::filesystem::path(path_).parent_path() / name).string());
    if (read) {
      scene_.jnd = *read;
    } else {
      complain("/jnd_file", read.error().message);
    }
  }

  void read_block() {
    const JsonNode node = member(top_, "block", "an object with the lengths of the block");
    const auto length = [&](const char* key) { return number(node, key, {0.0, kLargestLength_m, true}); };
    scene_.block = {length("width_m"), length("length_m"), length("height_m"), length("tool_radius_m")};
  }

  void read_colours() {
    const JsonNode node = member(top_, "colours", "an object with block and tool");
    scene_.block_colour = colour(node, "block");
    scene_.tool_colour = colour(node, "tool");
    const JsonNode finish = optional_member(top_, "finish");
    if (finish.value == nullptr) return;
    static const std::vector<std::string> kFinishes = {"silicone", "foam", "gel", "rubber", "skin", "dome"};
    if (const auto index = choice(finish, kFinishes)) scene_.finish = static_cast<Finish>(*index);
  }

  void read_default_models() {
    const std::string expected = "a list of methods out of " + method_names();
    std::vector<std::string> names;
    for (const Method* method : methods()) names.emplace_back(method->name);
    const JsonNode node = list(top_, "default_models", expected);
    if (node.value == nullptr) return;
    if (node.value->empty()) complain(node.pointer, found(*node.value) + ", expected " + expected);
    for (std::size_t i = 0; i < node.value->size(); ++i) {
      if (const auto index = choice(entry(node, i), names)) scene_.default_models.push_back(names[*index]);
    }
  }

  const std::string& path_;
  JsonNode top_;
  Scene scene_;
};

}  // namespace

Result<Scene> parse_scene(std::string_view text, const std::string& path) {
  const Result<Json> document = parse_json(text, path, kSceneNesting, {});
  if (!document) return document.error();
  return SceneReader(text, path, *document).read();
}

}  // namespace palpate
