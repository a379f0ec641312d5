#include "models/fit_library/fit_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/text.h"
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
    const char* const end = part.data() + part.size();
    if (parse_number(part.data(), end, values.emplace_back()) != end || !(values.back() > 0.0)) return {};
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

std::string found(std::string_view item, const std::string& expected) {
  return "found \"" + std::string(item) + "\", expected " + expected;
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
  if (item == "depth") return {};
  if (item == "velocity" && !has_kind(list.features, FeatureKind::velocity)) {
    list.add(FeatureKind::velocity);
    return {};
  }
  const std::size_t colon = item.find(':');
  const std::string_view rest = colon == std::string_view::npos ? std::string_view() : item.substr(colon + 1);
  for (const ListedKind& one : kListed) {
    const bool again = one.kind != FeatureKind::maxwell_spectrum && has_kind(list.features, one.kind);
    if (item.substr(0, colon) != one.name || again) continue;
    auto values = parse_values(rest, '+', one.unit);
    if (values.empty() || values.size() > kMaxFeatureParts) return Error{found(item, one.expected)};
    for (double& value : values) value *= one.scale;
    list.add(one.kind, values);
    return {};
  }
  return Error{found(item, "depth, velocity, maxwell:, stops: and creep:, where only maxwell: may be repeated")};
}

template <typename Names>
std::size_t index_of(const Names& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

template <typename Names>
std::string check_one_of(const Names& names, const std::string& text) {
  if (index_of(names, text) < names.size()) return "";
  return found(text, "one of " + joined({names.begin(), names.end()}));
}

std::string check_method(const std::string& text) {
  return find_method(text) != nullptr ? "" : found(text, "one of " + method_names());
}

std::optional<std::uint64_t> whole_number(const std::string& text, std::uint64_t least, std::uint64_t most) {
  std::uint64_t value = 0;
  const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && next == text.data() + text.size();
  return whole && value >= least && value <= most ? std::optional(value) : std::nullopt;
}

struct FitOption {
  std::string_view name;
  std::string FitOptions::*value;
  std::string (*check)(const std::string& text);
};
constexpr FitOption kFitOptions[] = {
    {"method", &FitOptions::method, check_method},
    {"centres", &FitOptions::centres, check_centres},
    {"candidates", &FitOptions::candidates, check_candidates},
    {"kernel", &FitOptions::kernel, [](const std::string& text) { return check_one_of(kernel_names(), text); }},
    {"weighting", &FitOptions::weighting, [](const std::string& text) { return check_one_of(kWeightingNames, text); }},
    {"reduction", &FitOptions::reduction, [](const std::string& text) { return check_one_of(kReductionNames, text); }},
    {"recipe", &FitOptions::recipe,
     [](const std::string& text) { return text == kRecipe2009 ? "" : found(text, kRecipe2009); }},
    {"features", &FitOptions::features, check_features},
    {"relaxation", &FitOptions::relaxation, check_relaxation},
    {"surface", &FitOptions::surface,
     [](const std::string& text) {
       return text == "auto" || text == "recorded" ? "" : found(text, "auto, or recorded");
     }},
    {"grid", &FitOptions::grid, check_grid},
    {"seed", &FitOptions::seed, check_seed}};

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

std::string check_features(const std::string& text) {
  if (text == "auto" || text == "scene") return "";
  const auto list = parse_feature_list(text);
  return list ? "" : list.error().message + "; or auto, or scene";
}

std::string check_centres(const std::string& text) {
  const std::string most = std::to_string(kMostFittedCentres);
  return whole_number(text, 1, kMostFittedCentres) ? "" : found(text, "1 to " + most + "; direct uses every site");
}

std::string check_candidates(const std::string& text) {
  const bool valid = text == "all" || whole_number(text, 1, std::numeric_limits<int>::max());
  return valid ? "" : found(text, "a whole number of at least 1, or all");
}

std::string check_relaxation(const std::string& text) {
  const std::size_t count = parse_values(text, ',').size();
  const bool valid = text == "scene" || text == "auto" || (count >= 1 && count <= 6);
  return valid ? "" : found(text, "scene, auto, or one to six times in seconds such as 0.17,1.27");
}

std::string check_grid(const std::string& text) {
  return parse_grid(text).empty() ? found(text, "sizes such as 25x11x11x11") : "";
}

std::string check_seed(const std::string& text) {
  return whole_number(text, 0, std::numeric_limits<std::uint64_t>::max()) ? "" : found(text, "a whole number");
}

Result<FitOptions> parse_fit_options(const std::string& text) {
  FitOptions options;
  for (const std::string_view item : split(text, ' ')) {
    if (item.empty()) continue;
    const std::size_t end = std::min(item.find('='), item.size());
    const auto option = std::ranges::find(kFitOptions, item.substr(0, end), &FitOption::name);
    if (option == std::end(kFitOptions) || end == item.size()) {
      std::vector<std::string> names;
      for (const FitOption& known : kFitOptions) names.emplace_back(known.name);
      return Error{found(item, "NAME=VALUE with a name of " + joined(names))};
    }
    const std::string value(item.substr(end + 1));
    if (const std::string wrong = option->check(value); !wrong.empty())
      return Error{std::string(option->name) + ": " + wrong};
    options.*option->value = value;
  }
  if (!options.relaxation.empty() && options.features != "auto" && options.features != "scene") {
    return Error{"relaxation: found the features \"" + options.features +
                 "\", expected the scene's features; leave one of the two out"};
  }
  return options;
}

TrainingRequest training_request(const FitOptions& options, TrainingRequest scene) {
  TrainingRequest request = std::move(scene);
  request.weighting = static_cast<Weighting>(index_of(kWeightingNames, options.weighting));
  request.reduction = static_cast<Reduction>(index_of(kReductionNames, options.reduction));
  request.surface = options.surface == "recorded" ? Surface::recorded : Surface::automatic;
  // The paper's recipe is requested by its name or by its two options.
  request.kernel = *kernel_from_name(options.kernel);
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
  request.centres = std::stoi(options.centres);
  request.candidates = options.candidates == "all" ? 0 : std::stoi(options.candidates);
  request.grid = parse_grid(options.grid);
  request.seed = std::stoull(options.seed);
  return request;
}

}  // namespace palpate
