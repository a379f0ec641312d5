#include "models/fit/fit.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/text.h"

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

std::string found(std::string_view item, const std::string& expected) {
  return "found \"" + std::string(item) + "\", expected " + expected;
}

// A kind of feature with one to eight values after its colon, in multiples of `scale`.
struct ListedKind {
  FeatureKind kind;
  std::string_view name, unit;
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

std::optional<std::uint64_t> whole_number(const std::string& text, std::uint64_t least, std::uint64_t most) {
  std::uint64_t value = 0;
  const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && next == text.data() + text.size();
  return whole && value >= least && value <= most ? std::optional(value) : std::nullopt;
}

Status set_centres(ModelPlan& plan, const std::string& text) {
  const auto number = whole_number(text, 1, kMostFittedCentres);
  if (!number) return Error{found(text, "1 to " + std::to_string(kMostFittedCentres) + "; direct uses every site")};
  plan.centres = static_cast<int>(*number);
  return {};
}

}  // namespace

bool ModelPlan::selects_centres() const { return method->can_take(kTakesCentres); }

bool same_preparation(const ModelPlan& one, const ModelPlan& other) {
  const bool same_kernel = one.base == Base::force || one.kernel == other.kernel;
  return one.base == other.base && same_kernel && one.thins() == other.thins() && one.features == other.features &&
         one.list == other.list;
}

std::string family_name(const ModelPlan& plan) {
  const bool plain = plan.base == Base::force || plan.method == &kTrendMethod;
  return (plain ? "" : std::string(kTrendMethod.name) + "+") + plan.method->name;
}

std::string plan_name(const ModelPlan& plan) {
  return family_name(plan) + (plan.selects_centres() ? "-" + std::to_string(plan.centres) : "");
}

std::uint32_t colour_of(const ModelPlan& plan) {
  return plan.base == Base::trend && plan.method == &kGreedyMethod ? kTrendMethod.colour : plan.method->colour;
}

const std::vector<ModelPlan>& all_plans() {
  static const std::vector<ModelPlan> plans = [] {
    std::vector<ModelPlan> all;
    for (const Base base : {Base::force, Base::trend}) {
      for (const Method* method : methods()) {
        if (base == Base::force && method == &kTrendMethod) continue;
        all.push_back({.base = base, .method = method});
      }
    }
    return all;
  }();
  return plans;
}

std::string family_names(unsigned option) {
  std::vector<std::string> names;
  for (const ModelPlan& plan : all_plans())
    if ((plan.method->takes & option) == option) names.push_back(family_name(plan));
  return joined(names);
}

Result<ModelPlan> parse_plan(std::string_view name) {
  const std::size_t dash = name.rfind('-');
  for (const ModelPlan& known : all_plans()) {
    ModelPlan plan = known;
    if (name == family_name(plan)) return plan;
    if (!plan.selects_centres() || name.substr(0, dash) != family_name(plan)) continue;
    if (const Status status = set_centres(plan, std::string(name.substr(dash + 1))); !status)
      return Error{found(name, "a number of centres of 1 to " + std::to_string(kMostFittedCentres))};
    return plan;
  }
  return Error{found(name, "one of " + family_names() + ", where a number of centres may follow: greedy-40")};
}

const std::vector<PlanOption>& plan_options() {
  static const std::vector<PlanOption> options{
      {"method", "NAME",
       "Name of the model: a method on the measured force (direct, voxel, random, kdtree, greedy), the trend, or "
       "trend+ and a method that corrects it",
       "trend+greedy", 0,
       [](ModelPlan& plan, const std::string& text) {
         const auto parsed = parse_plan(text);
         if (!parsed) return Status(parsed.error());
         plan.base = parsed->base;
         plan.method = parsed->method;
         plan.centres = parsed->centres;
         return Status();
       }},
      {"centres", "1 - " + std::to_string(kMostFittedCentres), "Number of centres", "100", kTakesCentres, set_centres},
      {"candidates", "N|all", "Candidate sites per step, a number or all", "100", kTakesCandidates,
       [](ModelPlan& plan, const std::string& text) {
         const auto number = whole_number(text, 1, std::numeric_limits<int>::max());
         plan.candidates = static_cast<int>(number.value_or(0));
         return number || text == "all" ? Status() : Status(Error{found(text, "a whole number of at least 1, or all")});
       }},
      {"features", "auto|scene|LIST",
       std::string("Features of the force: auto (those that the recordings support), scene (the scene's), or a list "
                   "such as ") +
           kFeatureListExample,
       "auto", 0,
       [](ModelPlan& plan, const std::string& text) {
         plan.features = text == "auto" ? FeatureChoice::automatic : FeatureChoice::scene;
         if (text == "auto" || text == "scene") return Status();
         auto list = parse_feature_list(text);
         if (!list) return Status(Error{list.error().message + "; or auto, or scene"});
         plan.features = FeatureChoice::given;
         plan.list = std::move(*list);
         return Status();
       }},
      {"kernel", "auto|cubic|linear|thin-plate",
       "Kernel; auto: cubic with the trend, selected by cross-validation with the force", "auto", kTakesKernel,
       [](ModelPlan& plan, const std::string& text) {
         plan.kernel = kernel_from_name(text);
         return plan.kernel || text == "auto" ? Status()
                                              : Status(Error{found(text, "auto, or one of " + joined(kernel_names()))});
       }},
      {"grid", "NxN", "Nodes of the grid along each feature [25x11x11x11]", "", kTakesGrid,
       [](ModelPlan& plan, const std::string& text) {
         const std::vector<double> sizes = parse_values(text, 'x');
         const auto is_size = [](double size) { return size >= 2.0 && size <= 1e6 && size == std::floor(size); };
         if (sizes.empty() || !std::ranges::all_of(sizes, is_size))
           return Status(Error{found(text, "sizes such as 25x11x11x11")});
         plan.grid.assign(sizes.begin(), sizes.end());
         return Status();
       }},
      {"seed", "N", "Seed of the random numbers", "1", kTakesSeed, [](ModelPlan& plan, const std::string& text) {
         const auto number = whole_number(text, 0, std::numeric_limits<std::uint64_t>::max());
         plan.seed = number.value_or(plan.seed);
         return number ? Status() : Status(Error{found(text, "a whole number")});
       }}};
  return options;
}

std::string option_error(std::string_view name, const std::string& text) {
  ModelPlan plan;
  const Status status = std::ranges::find(plan_options(), name, &PlanOption::name)->set(plan, text);
  return status ? std::string() : status.error().message;
}

Result<ModelPlan> plan_of(std::vector<OptionText> texts) {
  ModelPlan plan;
  const auto& options = plan_options();
  const auto option_of = [&](const OptionText& one) { return std::ranges::find(options, one.name, &PlanOption::name); };
  std::ranges::stable_sort(texts, {}, option_of);
  bool numbered = false;  // the name of the method has a number of centres
  for (const OptionText& one : texts) {
    const auto option = option_of(one);
    if (option == options.end()) {
      std::vector<std::string> names;
      for (const PlanOption& known : options) names.push_back(known.name);
      return Error{found(one.name, "NAME=VALUE with a name of " + joined(names))};
    }
    if ((plan.method->takes & option->takes) != option->takes) {
      return Error{one.name + ": " + family_name(plan) + " does not take this option, only " +
                   family_names(option->takes) + "; leave it out"};
    }
    const int named = plan.centres;
    if (const Status status = option->set(plan, one.value); !status)
      return Error{one.name + ": " + status.error().message};
    if (one.name == "method") numbered = one.value != family_name(plan);
    if (one.name == "centres" && numbered && named != plan.centres)
      return Error{"centres: " + found(one.value, std::to_string(named) + ", the number in the name of the method")};
  }
  const bool bristles = std::ranges::any_of(plan.list.features, &is_bristle, &FeatureSpec::kind);
  if (plan.base == Base::force && bristles)
    return Error{
        "features: found stops or creep, expected depth, velocity and maxwell: with a method on the measured "
        "force; use trend+" +
        std::string(plan.method->name)};
  return plan;
}

Result<ModelPlan> parse_plan_options(const std::string& text) {
  std::vector<OptionText> texts;
  for (const std::string_view item : split(text, ' ')) {
    if (item.empty()) continue;
    const std::size_t end = item.find('=');
    // Without a value the item is refused as an unknown name.
    const bool whole = end == std::string_view::npos;
    texts.push_back({std::string(item.substr(0, end)), whole ? "" : std::string(item.substr(end + 1))});
  }
  return plan_of(std::move(texts));
}

Result<FeatureList> parse_feature_list(const std::string& text) {
  FeatureList list;
  const auto items = split(text, ',');
  for (const std::string_view item : items) {
    if (std::ranges::count(items, item) > 1) return Error{found(item, "each feature once")};
    if (const Status status = add_item(item, list); !status) return status.error();
  }
  if (list.features.size() > kMaxFeatures) {
    return Error{"found " + std::to_string(list.features.size()) + " features, expected at most " +
                 std::to_string(kMaxFeatures) + "; join relaxation times with +"};
  }
  return list;
}

}  // namespace palpate
