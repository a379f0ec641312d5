// The plan of a model: what is fitted and how. The command line, the C interface, scenes, report and window read,
// compare and print plans here only.
//
// A model is named by what it is:
//   greedy-100         a method of Hoever & Harders (2009) on the measured force
//   trend              the regression alone
//   trend+greedy-100   the trend and a correction of its residual by the method
// Thread guarantee: values and pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "models/correction/methods.h"
#include "models/model/kernels.h"
#include "models/trend/trend_estimator.h"

namespace palpate {

// What the method is fitted to: the measured force, or the residual of the trend.
enum class Base : std::uint8_t { force, trend };

// The features: automatic (with the trend, those of the dictionary of models/trend/trend_estimator.h that the
// regression weights; with the force, the scene's with two identified relaxation times), those of the scene, or a list.
enum class FeatureChoice : std::uint8_t { automatic, scene, given };

// The time to select centres grows with the square of their number, to half a minute at this limit. The method
// `direct`, with every site as a centre, hardly has more.
inline constexpr int kMostFittedCentres = 2000;

struct ModelPlan {
  Base base = Base::trend;
  const Method* method = &kGreedyMethod;  // kTrendMethod: no correction, with Base::trend only
  int centres = 100;                      // of methods that select centres
  int candidates = 100;                   // per greedy step; 0: every site
  std::vector<int> grid{};                // nodes per feature; empty: the default of the method
  std::uint64_t seed = 1;
  std::optional<KernelKind> kernel{};  // none: cubic with the trend, selected by cross-validation with the force
  std::optional<Thinning> thinning{};  // none: coverage with the trend, force with the force
  FeatureChoice features = FeatureChoice::automatic;
  FeatureList list{};  // for FeatureChoice::given

  Thinning thins() const { return thinning.value_or(base == Base::trend ? Thinning::coverage : Thinning::force); }
  bool selects_centres() const;
  bool operator==(const ModelPlan&) const = default;
};

// Whether both plans have the same samples, trend and sites, so that one preparation serves both.
bool same_preparation(const ModelPlan& one, const ModelPlan& other);
// "trend+greedy": the name without a number.
std::string family_name(const ModelPlan& plan);
// "trend+greedy-100", "voxel".
std::string plan_name(const ModelPlan& plan);
// 0xRRGGBB, the same in all figures. The trend and the default, which corrects it, have the same.
std::uint32_t colour_of(const ModelPlan& plan);
// Reads "trend+greedy" or "trend+greedy-40". Errors: found ..., expected ... with the known names.
Result<ModelPlan> parse_plan(std::string_view name);
// One of each family with default options, in the order of lists: direct, voxel, random, kdtree, greedy, trend,
// trend+direct, ...
const std::vector<ModelPlan>& all_plans();
// The names of those families that use this option (MethodOption flags); 0: all.
std::string family_names(unsigned option = 0);

// An option of a fit as text, for the command line and the C interface.
struct PlanOption {
  std::string name;          // "centres"
  std::string values;        // "1 - 2000", for --help
  std::string help;          // what it sets
  const char* default_text;  // "100"; may be empty
  unsigned takes = 0;        // MethodOption flag: used by these methods only
  // Errors: "found ..., expected ...".
  Status (*set)(ModelPlan& plan, const std::string& text) = nullptr;
};
// The method first.
const std::vector<PlanOption>& plan_options();
// Checks the text of one option by itself: empty, or "found ..., expected ...".
std::string option_error(std::string_view name, const std::string& text);

// The text of an option.
struct OptionText {
  std::string name, value;
};
// The plan with these options. Errors: an unknown name; a value that is not allowed: "name: found ..., expected ...";
// options that exclude each other, or that the method does not take.
Result<ModelPlan> plan_of(std::vector<OptionText> texts);
// The same from "method=random centres=40": pairs separated by blanks.
Result<ModelPlan> parse_plan_options(const std::string& text);

// A list of features, in any order, each except maxwell at most once; depth is always included. maxwell and creep have
// times in s, stops have thresholds. Errors: the item, the value found and the value expected.
inline constexpr const char* kFeatureListExample =
    "depth,velocity,maxwell:0.17,maxwell:0.4+1.27,stops:0.1mm,creep:0.1+1";
Result<FeatureList> parse_feature_list(const std::string& text);

}  // namespace palpate
