#include "models/fit_library/fit_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "models/model/rbf/kernels.h"

namespace palpate {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

// Parses "0.17+1.27": positive numbers, each followed by `unit`. Empty if the text is anything else.
std::vector<double> parse_values(std::string_view text, char separator, std::string_view unit = "") {
  std::vector<double> values;
  for (std::string_view part : split(text, separator)) {
    if (!part.ends_with(unit)) return {};
    part.remove_suffix(unit.size());
    double value = 0.0;
    const auto [next, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || next != part.data() + part.size() || !(value > 0.0) || !std::isfinite(value)) return {};
    values.push_back(value);
  }
  return values;
}

// Parses "25x11x11x11": whole numbers of at least 2. Empty if the text is anything else.
std::vector<int> parse_grid(const std::string& text) {
  std::vector<int> sizes;
  for (const double value : parse_values(text, 'x')) {
    if (value < 2.0 || value > 1e6 || value != std::floor(value)) return {};
    sizes.push_back(static_cast<int>(value));
  }
  return sizes;
}

Error wrong(std::string_view item, const std::string& expected) {
  return Error{"found \"" + std::string(item) + "\", expected " + expected};
}

// A kind of feature with one to eight values after its colon, in multiples of `scale`.
struct ListedKind {
  FeatureKind kind;
  std::string_view name;
  std::string_view unit;
  double scale;
  const char* expected;
};
constexpr ListedKind kListed[] = {
    {FeatureKind::maxwell_spectrum, "maxwell", "", 1.0,
     "maxwell: with one to eight times in seconds such as maxwell:0.4+1.27"},
    {FeatureKind::stops, "stops", "mm", 1e-3, "stops: with one to eight thresholds such as stops:0.05mm+0.1mm"},
    {FeatureKind::creep, "creep", "", 1.0, "creep: with one to eight times in seconds such as creep:0.1+1"}};

Status add_item(std::string_view item, FeatureList& list) {
  const std::size_t colon = item.find(':');
  const std::string_view rest = colon == std::string_view::npos ? std::string_view() : item.substr(colon + 1);
  if (item == "depth") return {};
  if (item == "velocity" && !has_kind(list.features, FeatureKind::velocity)) {
    list.add(FeatureKind::velocity);
    return {};
  }
  for (const ListedKind& one : kListed) {
    const bool again = one.kind != FeatureKind::maxwell_spectrum && has_kind(list.features, one.kind);
    if (item.substr(0, colon) != one.name || again) continue;
    auto values = parse_values(rest, '+', one.unit);
    if (values.empty() || values.size() > kMaxFeatureParts) return wrong(item, one.expected);
    for (double& value : values) value *= one.scale;
    list.add(one.kind, values);
    return {};
  }
  return wrong(item, "depth, velocity, maxwell:, stops: and creep:, where only maxwell: may be repeated");
}

template <typename Names>
std::size_t index_of(const Names& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

template <typename Names>
std::string check_one_of(const Names& names, const std::string& text) {
  if (index_of(names, text) < names.size()) return "";
  std::string known;
  for (const auto& name : names) known += (known.empty() ? "" : ", ") + std::string(name);
  return "found \"" + text + "\", expected one of " + known;
}

const std::vector<std::string> kSurfaces = {"auto", "recorded"};

}  // namespace

Result<FeatureList> parse_feature_list(const std::string& text) {
  FeatureList list;
  for (const std::string_view item : split(text, ',')) {
    if (const Status status = add_item(item, list); !status) return status.error();
  }
  if (list.features.size() > kMaxFeatures) {
    return Error{"found " + std::to_string(list.features.size()) + " features, expected at most " +
                 std::to_string(kMaxFeatures) + "; join relaxation times with +"};
  }
  return list;
}

Result<std::vector<FeatureSpec>> parse_scene_features(const std::string& text) {
  constexpr std::string_view kLowPass = "lowpass_velocity:";
  std::vector<FeatureSpec> features;
  bool has_depth = false;
  for (const std::string_view item : split(text, ',')) {
    FeatureSpec& spec = features.emplace_back();
    if (item == "velocity") {
      spec.kind = FeatureKind::velocity;
    } else if (item.starts_with(kLowPass)) {
      const std::vector<double> times = parse_values(item.substr(kLowPass.size()), '+');
      if (times.size() != 1) return wrong(item, "one time in seconds such as lowpass_velocity:0.17");
      spec.kind = FeatureKind::lowpass_velocity;
      spec.relaxation_time_s = times.front();
    } else if (item != "depth") {
      return wrong(item, "depth, velocity and lowpass_velocity:");
    }
    has_depth = has_depth || item == "depth";
  }
  if (has_depth && features.size() <= kMaxFeatures) return features;
  return wrong(text, "at most " + std::to_string(kMaxFeatures) + " features, depth among them");
}

std::string check_features(const std::string& text) {
  if (text == "auto" || text == "scene") return "";
  const auto list = parse_feature_list(text);
  return list ? "" : list.error().message + "; or auto, or scene";
}

std::string check_candidates(const std::string& text) {
  int value = 0;
  const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc() && next == text.data() + text.size() && value >= 1;
  return number || text == "all" ? "" : "found \"" + text + "\", expected a whole number of at least 1, or all";
}

std::string check_relaxation(const std::string& text) {
  if (text == "scene" || text == "auto") return "";
  const std::size_t count = parse_values(text, ',').size();
  if (count >= 1 && count <= 6) return "";
  return "found \"" + text + "\", expected scene, auto, or one to six times in seconds such as 0.17,1.27";
}

std::string check_grid(const std::string& text) {
  return parse_grid(text).empty() ? "found \"" + text + "\", expected sizes such as 25x11x11x11" : "";
}

Status check_fit_options(const FitOptions& options) {
  std::vector<std::string> names;
  for (const Method* method : methods()) names.emplace_back(method->name);
  const std::string centres = options.centres >= 1 && options.centres <= kMostFittedCentres
                                  ? ""
                                  : "found " + std::to_string(options.centres) + ", expected 1 to " +
                                        std::to_string(kMostFittedCentres) + "; direct uses every site";
  const std::pair<const char*, std::string> checks[] = {
      {"method", check_one_of(names, options.method)},
      {"centres", centres},
      {"candidates", check_candidates(options.candidates)},
      {"kernel", check_one_of(kernel_names(), options.kernel)},
      {"weighting", check_one_of(kWeightingNames, options.weighting)},
      {"reduction", check_one_of(kReductionNames, options.reduction)},
      {"recipe", options.recipe.empty() ? "" : check_one_of(std::vector<std::string>{kRecipe2009}, options.recipe)},
      {"features", check_features(options.features)},
      {"relaxation", options.relaxation.empty() ? "" : check_relaxation(options.relaxation)},
      {"surface", check_one_of(kSurfaces, options.surface)},
      {"grid", options.grid.empty() ? "" : check_grid(options.grid)}};
  for (const auto& [name, wrong] : checks) {
    if (!wrong.empty()) return Error{std::string(name) + ": " + wrong};
  }
  if (!options.relaxation.empty() && options.features != "auto" && options.features != "scene") {
    return Error{"relaxation: found the features \"" + options.features +
                 "\", expected the scene's features; leave one of the two out"};
  }
  return {};
}

TrainingRequest training_request(const FitOptions& options, TrainingRequest scene) {
  TrainingRequest request = std::move(scene);
  request.weighting = static_cast<Weighting>(index_of(kWeightingNames, options.weighting));
  request.reduction = static_cast<Reduction>(index_of(kReductionNames, options.reduction));
  request.surface = options.surface == "recorded" ? Surface::recorded : Surface::automatic;
  // The paper's recipe is requested by its name or by its two options.
  const bool papers = options.recipe == kRecipe2009 ||
                      (request.reduction == Reduction::force && request.weighting == Weighting::relative);
  if (papers) request = recipe_2009_request(std::move(request));
  // Relaxation times are an option of the scene's features, which the paper's recipe uses, too.
  if (!options.relaxation.empty() || papers || options.features == "scene") {
    request.choice = FeatureChoice::scene;
  } else if (options.features == "auto") {
    request.choice = FeatureChoice::automatic;
  } else {
    request.choice = FeatureChoice::given;
    request.list = *parse_feature_list(options.features);
  }
  if (options.relaxation == "auto") {
    request.relaxation = Relaxation::automatic;
  } else if (options.relaxation == "scene") {
    request.relaxation = Relaxation::scene;
  } else if (!options.relaxation.empty()) {
    request.relaxation = Relaxation::given;
    request.relaxation_times_s = parse_values(options.relaxation, ',');
  }
  return request;
}

MethodRequest method_request(const FitOptions& options) {
  MethodRequest request;
  request.method = find_method(options.method);
  request.centres = options.centres;
  request.candidates = options.candidates == "all" ? 0 : std::stoi(options.candidates);
  request.kernel = *kernel_from_name(options.kernel);
  request.grid = parse_grid(options.grid);
  request.seed = options.seed;
  return request;
}

}  // namespace palpate
