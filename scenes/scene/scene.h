// A scene: a plain description of what is touched, one JSON file under assets/scenes, whose name is its own.
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

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
};

// The block lies with its undisturbed surface at height 0; the tool is a ball.
struct BlockGeometry {
  double width_m = 0.0;
  double length_m = 0.0;
  double height_m = 0.0;
  double tool_radius_m = 0.0;
};

// What the block is made of to the eye.
enum class Finish { silicone, foam, gel, rubber, skin, dome };

struct Scene {
  std::string name;
  std::string title;
  std::string description;
  std::optional<std::string> material;  // virtual material; none: recordings only
  std::vector<std::string> recordings;  // in its place, of a session: the files that are the material
  std::vector<FeatureSpec> features;    // 1 to 8, the depth among them; low-passes for memory
  JndLine jnd;
  BlockGeometry block;
  Colour block_colour;
  Colour tool_colour;
  Finish finish = Finish::silicone;
  std::vector<std::string> default_models;  // names of methods (models/fit/methods.h)
  // A hand that explores by itself aims at most for this force.
  double strongest_press_N = 5.0;

  // Whether there is something to fit models to.
  bool has_material() const { return material.has_value() || !recordings.empty(); }
};

// The features in words: "depth, velocity, relaxation 0.17 s".
std::string describe_features(const Scene& scene);

// Reads a scene from the text of its file; `path` gives the name. A "jnd_file", in place of "jnd", names a JND
// file (scenes/scene/jnd_file.h) relative to the scene's own folder; it is read too. Errors: all that is
// wrong, one per line, each as "path:line:column: found ..., expected ...".
Result<Scene> parse_scene(std::string_view text, const std::string& path);

// The names of all scenes in `folder`, sorted; empty: the assets' own. Errors: no such folder.
Result<std::vector<std::string>> scene_names(const std::string& folder = {});

// The scene of that name. Errors: unknown (lists the known ones), file broken.
Result<Scene> load_scene(const std::string& name, const std::string& folder = {});

// 0xRRGGBB of a row of models/fit/methods.h, or of "position", the model that knows the depth alone. 0, black
// on white and white on black: methods without a hue, and what is not known.
std::uint32_t method_rgb(std::string_view method);

}  // namespace palpate
