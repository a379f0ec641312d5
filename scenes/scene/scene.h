// A scene: the description of a touched object and of its models, read from assets/scenes/NAME.json.
// Thread guarantee: values; reading them is slow side only (does I/O).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "engine/tick/jnd.h"

namespace palpate {

// The folders of the program: the assets (scenes, calibrations, shaders, templates), and the user's settings and data.
// If the environment variable PALPATE_ASSETS is set, only that folder is tried for the assets. Otherwise these are
// tried in this order: `../share/palpate` (an installed program) and `../assets` (a build folder), relative to the
// folder of the executable; the source tree.
// Source of the user's folders: XDG Base Directory Specification 0.8.

// Errors: none of these folders has a subfolder `scenes`; the message lists the folders.
Result<std::string> find_assets();

// The folder of the models that the build has fitted (scenes/worker/model_worker.h): `../share/palpate/ready` or
// `ready`, relative to the folder of the executable; empty where there is none.
std::string ready_models_folder();

// The folder of the devices' calibrations; empty where there are no assets.
std::string calibrations_folder();

// $XDG_CONFIG_HOME/palpate, else ~/.config/palpate. Creates the folder. Errors: neither the variable nor HOME is set;
// the folder cannot be created.
Result<std::string> config_folder();

// $XDG_DATA_HOME/palpate, else ~/.local/share/palpate: recordings, figures, fault files. Creates it. Errors: the same.
Result<std::string> data_folder();

// The local time for a file name, formatted by strftime with `format`; empty if it is longer than 63 bytes.
std::string local_time_text(const char* format);

struct TrainingScene;

// The undisturbed surface of the block is at height 0. The tool is a ball.
struct BlockGeometry {
  double width_m = 0.0, length_m = 0.0, height_m = 0.0, tool_radius_m = 0.0;
};

enum class Finish { silicone, foam, gel, rubber, skin, dome };

struct Scene {
  std::string name;  // of its file
  std::string title, description;
  std::string shows;                    // in a few words; may be empty
  int order = 0;                        // place in the list of scenes, from 1; 0: not in it
  std::optional<std::string> material;  // name of the virtual material; empty: models need recordings
  std::vector<std::string> recordings;  // files that a session uses instead of the virtual material
  std::vector<FeatureSpec> features;    // 1 to 8: always the depth; velocity, low-pass velocities
  JndLine jnd;
  BlockGeometry block;
  std::uint32_t block_colour = 0;  // 0xRRGGBB
  Finish finish = Finish::silicone;
  // Largest target force of the simulated hand that moves the tool.
  double strongest_press_N = 5.0;

  // Whether models can be fitted: there is a virtual material, or there are recordings.
  bool has_material() const { return material.has_value() || !recordings.empty(); }
};

// The features in words: "depth, velocity, relaxation 0.17 s"; the time is that of a low-pass velocity.
std::string describe_features(const Scene& scene);

// Parses the text of a scene file. Instead of "jnd", "jnd_file" can name a JND file relative to the scene's folder,
// which is then read. Errors: all errors of the file, one per line, each as "path:line:column: found ..., expected
// ...".
Result<Scene> parse_scene(std::string_view text, const std::string& path);

// Reads the JND line from the result file of a JND study (scenes/study/study_analysis.h).
// JSON: "format": "palpate-jnd", "version": 1, "offset_N" (above 0, up to 100) and "weber_fraction" (0 to 1) of the
// conservative line. "criterion", "subjects", "fitted" and "points" are allowed and ignored.
// Errors: as parse_scene; another format or version. read_jnd_file: also a file that is not readable.
Result<JndLine> parse_jnd_file(std::string_view text, const std::string& path);
Result<JndLine> read_jnd_file(const std::string& path);

// The names of all scenes in the assets, sorted. Errors: no such folder.
Result<std::vector<std::string>> scene_names();

// Errors: unknown scene (lists the known ones); those of parse_scene; the file is not readable.
Result<Scene> load_scene(const std::string& name);

// What the scene gives to a fit (models/fit/fit.h).
TrainingScene training_scene(const Scene& scene);

// The colour 0xRRGGBB of a family of models by its name (models/fit/fit.h). 0, the ink colour of the page, for
// methods without a hue and unknown names.
std::uint32_t method_rgb(std::string_view family);

}  // namespace palpate
