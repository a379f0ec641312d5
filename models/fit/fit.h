// The fit of a model to the samples of recordings (`palpate fit`), in two steps, so that plans that differ in the
// method only share the first.
//   prepare_training   features, trend, normalisation, thinned sites, domain, whether the correction is used
//   fit_method         one of the methods of models/correction/methods.h on the prepared sites
// With Base::trend the methods fit the residual of the trend. With Base::force they fit the measured force, as Hoever &
// Harders (2009), and what the paper leaves open is selected by cross-validation (OpenChoices).
// Thread guarantee: slow side.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "models/correction/methods.h"
#include "models/model/fitted_model.h"
#include "models/model/kernels.h"
#include "models/samples/selection.h"
#include "models/trend/trend_estimator.h"

namespace palpate {

// The plan of a model: what is fitted and how. The command line, the C interface, scenes, report and window read,
// compare and print plans here only.
//
// A model is named by what it is:
//   greedy-100         a method of Hoever & Harders (2009) on the measured force
//   trend              the regression alone
//   trend+greedy-100   the trend and a correction of its residual by the method
// Thread guarantee: values and pure functions.

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

// Rows of samples in contact, each with the trend that was fitted without its fold (models/samples/selection.h),
// and what is fitted to them: the choice of the correction and, to folds of whole units, the error bound. Thread
// guarantee: slow side, value types and pure functions.

// In ascending order of their folds.
struct ResidualRows {
  Eigen::MatrixXd points;   // normalised features, one column a row
  Eigen::VectorXd force_N;  // measured
  Eigen::VectorXd depth_m;
  Eigen::VectorXd row_scale;  // factor of the residual: 1 / JND
  Eigen::MatrixXd trend_N;    // rows x folds: column k by the trend fitted without fold k
  std::vector<int> fold;
  std::vector<char> no_force;    // no measured force: the force is not positive
  std::vector<double> distance;  // to the nearest row of another fold; infinite if there is none
  std::vector<int> unit;
  Eigen::VectorXd speed_m_per_s;
  // What is added to the error of a prediction where the recording is taken as recorded: the change of the elastic
  // response by the offset of its position, less its force zero.
  Eigen::VectorXd moved_N;
  KernelKind kernel = KernelKind::cubic;

  int folds() const { return static_cast<int>(trend_N.cols()); }
  // The residual of the trend without that fold. Where no force is measured, a trend below 0 needs no correction.
  Eigen::VectorXd residual_N(int without) const;
  // The force at row `i` from the other folds, as FittedModel computes it but without the upper limit, with this inner
  // radius of the trust. `h`: the correction, N.
  double predicted_N(const ModelData& common, std::size_t i, double inner_radius, double h) const;
  // The sites of a fit without a fold, at most 1000. The targets are the residuals of the trend without that fold.
  Sites sites_without(int without, double smoothing) const;
  // Sets `distance`.
  void find_distances();

 private:
  // The indices of the rows of the other folds.
  std::vector<Eigen::Index> outside(int without) const;
};

// Rows of the regression of the trend, at most 2500 of them. `common`: with the normalisation and the JND. `features`:
// at the samples in contact, SI. `left_out_trends`: columns x folds, the weights of the trends fitted without each
// fold.
ResidualRows residual_rows(const ModelData& common, const TrendColumns& columns, const Eigen::MatrixXd& features,
                           const Eigen::MatrixXd& left_out_trends);

// The prediction of a row, as recorded, by a model that was fitted without its fold, and how much it exceeds the
// measured force. `beyond`: its distance to the nearest row of another fold, beyond the inner radius.
struct Prediction {
  double error_N = 0.0, predicted_N = 0.0, beyond = 0.0;
  int unit = 0;
  double depth_m = 0.0, speed_m_per_s = 0.0;
};
// Of all rows that have another fold, those of a unit in order of time. `corrections`: fitted to the sites without each
// fold; empty: none, the errors are those of the trend.
std::vector<Prediction> predictions_of(const ResidualRows& rows, const ModelData& common,
                                       const std::vector<CorrectionPtr>& corrections);
// Fits the error bound of a model (models/METHOD.md, Bound). `common`: with the trend, the JND, the largest force and
// the offsets of the recordings, which are the units where there are several. None with fewer than 50 predictions or
// two units: one does not show how the next one differs.
std::optional<ErrorBound> fit_bound(const std::vector<Prediction>& predictions, const ModelData& common);

struct CorrectionChoice {
  bool used = false;
  double smoothing = 0.0, inner_radius = 0.0;
  double trend_error_over_jnd = 0.0;  // cross-validated (FoldErrors::rms_at_mean_score), without the correction
  double error_over_jnd = 0.0;        // the same, with the correction
};

// Selects by cross-validation whether a model has a correction, how smooth it is, and how far from the data it is
// trusted (models/METHOD.md, Correction; Wahba 1990; Craven & Wahba 1979). One smoothing serves every method: with more
// centres each approaches the smoothing spline. `common`: needs the JND, the limits of correction and force, and a
// cover with every site inside, whose inner radius is the smallest candidate.
CorrectionChoice choose_correction(const ResidualRows& rows, const ModelData& common);

using SamplesPointer = std::shared_ptr<const Samples>;

// What a scene gives to a fit.
struct TrainingScene {
  std::string name;
  std::vector<FeatureSpec> features;  // depth, velocity, lowpass_velocity
  JndLine jnd;
};

// What Hoever & Harders (2009) leave open for a fit to the measured force is selected by cross-validation
// (models/METHOD.md, Methods on the measured force): the order of the polyharmonic kernel, the normalisation of the
// features, feature k divided by range_k^a (4 sigma_k)^(1 - a), and the regularisation.
struct OpenChoices {
  KernelKind kernel = KernelKind::cubic;
  double range_exponent = 0.5;  // a
  double truncation = 0.0;      // of methods that select centres
  double smoothing = 0.0;       // of the direct interpolation
  double error_over_jnd = 0.0;  // cross-validated (FoldErrors::rms_at_mean_score)
};

// "cubic kernel, normalised by ...": what was selected, for the user.
std::string choices_text(const OpenChoices& choices, bool has_kernel = true);
// `features`: at the samples in contact, SI. `sites`: of the same samples, with targets. `common`: with the limits of
// the force. `centres`: of the method, 0: the direct interpolation. `kernel`: that of the plan, none: selected. Errors:
// interrupted.
Result<OpenChoices> select_open_choices(const Samples& samples, const Eigen::MatrixXd& features,
                                        const Normalisation& normalisation, const Sites& sites, const ModelData& common,
                                        int centres, std::optional<KernelKind> kernel, const FitControl& control);

struct PreparedTraining {
  SamplesPointer samples;
  Eigen::MatrixXd features;                    // at the samples in contact, one column each, SI
  Sites sites;                                 // target: the residual of the trend, or the force
  double thinning_force_N = 0.0;               // the step of Thinning::force
  ModelData common;                            // the parts of the model that all methods have in common
  std::vector<PartGain> gains;                 // of each term of the dictionary; empty unless the features are selected
  std::optional<CorrectionChoice> correction;  // of the residual of the trend; none with Base::force
  std::optional<ResidualRows> left_out;        // by units; none of a single one, or with Base::force

  // False if cross-validation rejected the correction; every method then returns the trend.
  bool corrects() const { return !correction || correction->used; }
};

struct MethodFit {
  std::shared_ptr<const FittedModel> model;
  std::vector<std::string> notes{};      // sentences for the user
  std::optional<KernelKind> kernel{};    // of a method that takes one
  std::optional<OpenChoices> choices{};  // with Base::force
  double error_over_jnd = 0.0;           // cross-validated: of the choices, or of the rows that were left out
  Eigen::Index rank = 0;                 // as in FittedCorrection
  double condition_number = 0.0;
  double seconds = 0.0;  // of ModelFits::fit: with its base, without the preparation
};

// Errors: the plan does not suit the scene; interrupted.
Result<PreparedTraining> prepare_training(SamplesPointer samples, const TrainingScene& scene, const ModelPlan& plan,
                                          const FitControl& control = {});
// Fits the method of a plan with this preparation. Deterministic. `base`: a fit with the same preparation by the base
// of the method (methods.h), which is then not repeated. `choices`: those of a fit with this preparation and number of
// centres. Errors: the method cannot be fitted to these sites (says why); the forces of the model are not finite;
// interrupted.
Result<MethodFit> fit_method(const PreparedTraining& prepared, const ModelPlan& plan, const FitControl& control = {},
                             const MethodFit* base = nullptr, const OpenChoices* choices = nullptr);

// The JSON object that `palpate fit --json` prints.
nlohmann::ordered_json fit_json(const MethodFit& fit, double seconds);

// The fits of several plans to the same recordings: what plans have in common is done once.
class ModelFits {
 public:
  ModelFits(std::vector<PreparedRecordingPointer> recordings, TrainingScene scene)
      : recordings_(std::move(recordings)), scene_(std::move(scene)) {}
  ModelFits(SamplesPointer samples, TrainingScene scene) : scene_(std::move(scene)), samples_(std::move(samples)) {}

  // The samples of the recordings. Errors: those of make_samples.
  Result<SamplesPointer> samples(const FitControl& control);
  // The preparation of a plan. Valid while this lives. Errors: those of make_samples and prepare_training.
  Result<const PreparedTraining*> prepare(const ModelPlan& plan, const FitControl& control);

  // Prepares the plan, if that has not been done, and fits its method. Errors: those of prepare and fit_method.
  Result<MethodFit> fit(const ModelPlan& plan, const FitControl& control);

 private:
  const PreparedTraining* prepared_for(const ModelPlan& plan) const;  // null: not prepared

  std::vector<PreparedRecordingPointer> recordings_;
  TrainingScene scene_;
  SamplesPointer samples_;
  std::vector<std::pair<ModelPlan, std::unique_ptr<PreparedTraining>>> prepared_;
  std::vector<std::pair<ModelPlan, MethodFit>> fits_;  // to start others from
};

}  // namespace palpate
