#include "scenes/scene/scene.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <map>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "engine/json/json_fields.h"
#include "models/fit/fit.h"
#include "scenes/material/material.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

// Of the executable; empty if unknown.
fs::path program_folder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

// Creates the folder. Ignores a relative path in the variable, as the specification demands.
Result<std::string> user_folder(const char* variable, const char* below_home) {
  const char* wanted = std::getenv(variable);
  const char* home = std::getenv("HOME");
  fs::path base;
  if (wanted != nullptr && *wanted == '/') {
    base = wanted;
  } else if (home != nullptr && *home == '/') {
    base = fs::path(home) / below_home;
  } else {
    return Error{std::string("found neither ") + variable + " nor HOME, expected one of them to name a folder"};
  }
  base /= "palpate";
  std::error_code problem;
  fs::create_directories(base, problem);
  if (!problem) return base.string();
  return Error{base.string() + ": " + problem.message() + "; set " + variable + " to a folder that can be written"};
}

using Json = nlohmann::json;

constexpr int kNesting = 8;  // at most; the formats need three levels
constexpr double kLongestRelaxation_s = 100.0;
constexpr double kLargestLength_m = 10.0;
constexpr double kLargestJndOffset_N = 100.0;
constexpr double kStrongestPress_N = 20.0;
constexpr const char* kJndAdvice = "; write it again with palpate study analyse";

JndLine jnd_line(JsonFields& fields, const JsonNode& object) {
  const double offset_N = fields.number(object, "offset_N", {0.0, kLargestJndOffset_N, true});
  return {offset_N, fields.number(object, "weber_fraction", {0.0, 1.0})};
}

class SceneReader : private JsonFields {
 public:
  SceneReader(std::string_view text, const std::string& path, const Json& document)
      : JsonFields(text, path, ""), path_(path), top_{&document, ""} {}

  Result<Scene> read() {
    scene_.name = fs::path(path_).stem().string();
    scene_.title = filled_text(top_, "title");
    scene_.description = filled_text(top_, "description");
    read_material();
    read_features();
    read_jnd();
    read_block();
    read_colours();
    if (optional_member(top_, "strongest_press_N").value != nullptr)
      scene_.strongest_press_N = number(top_, "strongest_press_N", {0.0, kStrongestPress_N, true});
    if (optional_member(top_, "shows").value != nullptr) scene_.shows = filled_text(top_, "shows");
    if (optional_member(top_, "order").value != nullptr)
      scene_.order = static_cast<int>(number(top_, "order", {1.0, 100.0}));
    refuse_unknown(top_);
    if (std::optional<Error> wrong = error()) return *wrong;
    return scene_;
  }

 private:
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
    for (std::size_t i = 0; i < node.value->size(); ++i) read_feature(entry(node, i));
    if (std::ranges::count(scene_.features, FeatureKind::depth, &FeatureSpec::kind) == 0)
      complain("/features", "found no feature of kind \"depth\", expected one: every force depends on the depth");
  }

  void read_feature(const JsonNode& node) {
    static const std::vector<std::string> kNames = {"depth", "velocity", "lowpass_velocity"};
    constexpr std::array kKinds = {FeatureKind::depth, FeatureKind::velocity, FeatureKind::lowpass_velocity};
    const auto kind = choice(member(node, "kind", "depth, velocity or lowpass_velocity"), kNames);
    FeatureSpec feature;
    feature.kind = kind ? kKinds[*kind] : FeatureKind::velocity;
    const JsonNode time = optional_member(node, "relaxation_time_s");
    if (feature.kind == FeatureKind::lowpass_velocity) {
      feature.relaxation_time_s = number(node, "relaxation_time_s", {0.0, kLongestRelaxation_s, true});
    } else if (kind && time.value != nullptr) {
      complain(time.pointer, "found a relaxation time, expected none for the kind \"" + kNames[*kind] + "\"");
    }
    const bool again = std::ranges::any_of(scene_.features, [&](const FeatureSpec& other) {
      return other.kind == feature.kind && other.relaxation_time_s == feature.relaxation_time_s;
    });
    if (kind && again) complain(node.pointer, "found the same feature twice, expected each once");
    scene_.features.push_back(feature);
  }

  // "jnd_file" names a file beside the scene, instead of the member "jnd".
  void read_jnd() {
    if (optional_member(top_, "jnd_file").value == nullptr) {
      const std::string expected = "an object with offset_N and weber_fraction, or a \"jnd_file\"";
      scene_.jnd = jnd_line(*this, member(top_, "jnd", expected));
      return;
    }
    const std::string name = filled_text(top_, "jnd_file");
    const JsonNode line = optional_member(top_, "jnd");
    if (line.value != nullptr) complain(line.pointer, "found a \"jnd\" and a \"jnd_file\", expected one of them");
    if (name.empty()) return;
    const Result<JndLine> read = read_jnd_file((fs::path(path_).parent_path() / name).string());
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
    const std::string expected = "a colour such as \"#56B4E9\"";
    const JsonNode node = member(member(top_, "colours", "an object with the colour of the block"), "block", expected);
    if (node.value != nullptr) {
      const std::string code = node.value->is_string() ? node.value->get<std::string>() : "";
      const char* const end = code.data() + code.size();
      if (code.size() != 7 || code[0] != '#' ||
          std::from_chars(code.data() + 1, end, scene_.block_colour, 16).ptr != end)
        complain(node.pointer, found(*node.value) + ", expected " + expected);
    }
    const JsonNode finish = optional_member(top_, "finish");
    if (finish.value == nullptr) return;
    static const std::vector<std::string> kFinishes = {"silicone", "foam", "gel", "rubber", "skin", "dome"};
    if (const auto index = choice(finish, kFinishes)) scene_.finish = static_cast<Finish>(*index);
  }

  const std::string& path_;
  JsonNode top_;
  Scene scene_;
};

Result<std::string> scenes_folder() {
  const Result<std::string> assets = find_assets();
  return assets ? *assets + "/scenes" : assets;
}

}  // namespace

Result<std::string> find_assets() {
  std::vector<fs::path> folders;
  std::error_code error;
  if (const char* named = std::getenv("PALPATE_ASSETS"); named != nullptr && *named != '\0') {
    folders = {named};
  } else {
    const fs::path prefix = program_folder().parent_path();
    if (!prefix.empty()) folders = {prefix / "share" / "palpate", prefix / "assets"};
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

std::string ready_models_folder() {
  const fs::path program = program_folder();
  std::error_code error;
  for (const fs::path& folder : {program.parent_path() / "share" / "palpate" / "ready", program / "ready"})
    if (fs::is_directory(folder, error)) return folder.string();
  return "";
}

std::string calibrations_folder() {
  const Result<std::string> assets = find_assets();
  return assets ? *assets + "/devices" : "";
}

Result<std::string> config_folder() { return user_folder("XDG_CONFIG_HOME", ".config"); }
Result<std::string> data_folder() { return user_folder("XDG_DATA_HOME", ".local/share"); }

std::string local_time_text(const char* format) {
  const std::time_t time = std::time(nullptr);
  std::tm local{};
  localtime_r(&time, &local);
  char text[64] = {};
  std::strftime(text, sizeof text, format, &local);
  return text;
}

Result<JndLine> parse_jnd_file(std::string_view text, const std::string& path) {
  const Result<Json> document = parse_json(text, path, kNesting, {kJndAdvice, kJndAdvice});
  if (!document) return document.error();
  JsonFields fields(text, path, kJndAdvice);
  const JsonNode top{&*document, ""};
  const JsonNode format = fields.optional_member(top, "format");
  if (format.value == nullptr || *format.value != "palpate-jnd") {
    fields.complain("", "found no \"format\": \"palpate-jnd\", expected a JND file");
    return *fields.error();
  }
  const JsonNode version = fields.member(top, "version", "1");
  if (version.value != nullptr && *version.value != 1) {
    fields.complain(version.pointer, found(*version.value) + ", expected version 1");
    return *fields.error();
  }
  const JndLine line = jnd_line(fields, top);
  for (const char* ignored : {"criterion", "subjects", "fitted", "points"}) fields.optional_member(top, ignored);
  fields.refuse_unknown(top);
  if (const std::optional<Error> error = fields.error()) return *error;
  return line;
}

Result<JndLine> read_jnd_file(const std::string& path) {
  const Result<std::string> text = read_plain_file(path, "a JND file", ", or make one with palpate study analyse");
  if (!text) return text.error();
  return parse_jnd_file(*text, path);
}

Result<Scene> parse_scene(std::string_view text, const std::string& path) {
  const Result<Json> document = parse_json(text, path, kNesting, {});
  if (!document) return document.error();
  return SceneReader(text, path, *document).read();
}

Result<std::vector<std::string>> scene_names() {
  const Result<std::string> folder = scenes_folder();
  if (!folder) return folder.error();
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(*folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == ".json") names.push_back(entry->path().stem().string());
  if (error) return Error{"cannot list the scenes in " + *folder + ": " + error.message()};
  std::ranges::sort(names);
  return names;
}

Result<Scene> load_scene(const std::string& name) {
  const Result<std::vector<std::string>> names = scene_names();
  if (!names) return names.error();
  if (std::ranges::count(*names, name) == 0)
    return Error{"unknown scene \"" + name + "\"; known scenes: " + joined(*names)};
  const std::string path = *scenes_folder() + "/" + name + ".json";
  const Result<std::string> text = read_plain_file(path, "a scene");
  if (!text) return text.error();
  return parse_scene(*text, path);
}

// Scenes have no other kinds of features; fits identify the others.
std::string describe_features(const Scene& scene) {
  std::vector<std::string> words;
  for (const FeatureSpec& feature : scene.features) {
    words.push_back(feature.kind == FeatureKind::depth ? "depth"
                    : feature.kind == FeatureKind::velocity
                        ? "velocity"
                        : "relaxation " + general(feature.relaxation_time_s, 6) + " s");
  }
  return joined(words);
}

TrainingScene training_scene(const Scene& scene) { return {scene.name, scene.features, scene.jnd}; }

std::uint32_t method_rgb(std::string_view family) {
  static const auto hues = [] {
    std::map<std::string, std::uint32_t, std::less<>> all;
    for (const ModelPlan& plan : all_plans()) all[family_name(plan)] = colour_of(plan);
    return all;
  }();
  const auto hue = hues.find(family);
  return hue != hues.end() ? hue->second : kNeutralColour;
}

}  // namespace palpate
