// The effect of each choice of the fit: greedy-100 with one change at a time, on six
// materials. `cross_validated` is the error of cross-validation on the training
// recordings, on which a choice may be based. `within_JND`, `rms_mN` and `worst_JND`
// are measured on a test recording. Also the error over the number of centres, from 0
// (the trend alone).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/support/fitting.h"

namespace palpate::bench {
namespace {

using test::RecordingPtr;

struct Material {
  std::string scene;
  std::vector<RecordingPtr> train;
  std::vector<RecordingPtr> test;
};

Material make_material(const std::string& name) {
  if (name == "skin")
    return {"skin", test::skin_recordings("train", {"250", "600", "1000"}),
            test::skin_recordings("test", {"400", "800", "900"})};
  if (name == "press")
    return {"silicone_block",
            {test::real_recording("ur3e_press_mit/train_cycle1.csv")},
            {test::real_recording("ur3e_press_mit/test_cycle2.csv")}};
  const std::map<std::string, std::string> scenes{
      {"silicone", "silicone_block"}, {"foam", "foam_block"}, {"gel", "silicone_block"}, {"stiff", "stiff_block"}};
  return {scenes.at(name), {test::train_recording(name)}, {test::test_recording(name)}};
}

const Material& material(const std::string& name) {
  static std::map<std::string, Material> made;
  if (const auto found = made.find(name); found != made.end()) return found->second;
  return made.emplace(name, make_material(name)).first->second;
}

// The folds of cross-validation. Of several recordings each is a fold. One recording is cut
// into a dozen pieces in free air, which are assigned to three folds in turn, so that each
// fold has every kind of motion. Empty if the tool is never in the air in between.
using Fold = std::vector<RecordingPtr>;
std::vector<Fold> folds_of(const std::vector<RecordingPtr>& recordings) {
  constexpr std::size_t kPieces = 12;
  constexpr std::size_t kFolds = 3;
  std::vector<Fold> folds;
  if (recordings.size() > 1) {
    for (const RecordingPtr& recording : recordings) folds.push_back({recording});
    return folds;
  }
  const Recording& whole = *recordings[0];
  std::vector<std::size_t> cuts{0};
  for (std::size_t k = 1; k < kPieces; ++k) {
    std::size_t cut = std::max(cuts.back() + 1000, k * whole.rows.size() / kPieces);
    while (cut < whole.rows.size() && whole.rows[cut].position_m > 0.0) ++cut;
    if (cut + 1000 < whole.rows.size()) cuts.push_back(cut);
  }
  if (cuts.size() < 2 * kFolds) return folds;
  cuts.push_back(whole.rows.size());
  folds.resize(kFolds);
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    Recording piece{whole.name, whole.columns, {}};
    piece.rows.assign(whole.rows.begin() + static_cast<std::ptrdiff_t>(cuts[k]),
                      whole.rows.begin() + static_cast<std::ptrdiff_t>(cuts[k + 1]));
    folds[k % kFolds].push_back(std::make_shared<const Recording>(std::move(piece)));
  }
  return folds;
}

struct Figures {
  double samples = 0.0;
  double squares = 0.0;  // sum of squared errors, N^2
  double within = 0.0;   // samples within the JND
  double worst_over_jnd = 0.0;

  void add(const ErrorSummary& summary) {
    const auto n = static_cast<double>(summary.samples);
    samples += n;
    squares += n * summary.rms_error_N * summary.rms_error_N;
    within += n * summary.within_jnd;
    worst_over_jnd = std::max(worst_over_jnd, summary.max_error_over_jnd);
  }
  double rms_mN() const { return 1e3 * std::sqrt(squares / samples); }
  double within_percent() const { return 100.0 * within / samples; }
};

struct Choice {
  std::string name;
  std::function<void(TrainingRequest&, MethodRequest&)> change;
};

Figures judged(const Material& on, const Choice& choice, const std::vector<RecordingPtr>& train,
               const std::vector<RecordingPtr>& test) {
  TrainingRequest training = test::scene_request(on.scene);
  MethodRequest method;
  choice.change(training, method);
  const PreparedTraining prepared = test::prepare(train, training);
  const auto model = std::make_shared<const FittedModel>(test::must(fit_method(prepared, method)).data);
  Figures figures;
  for (const RecordingPtr& recording : test) figures.add(test::judge(*recording, model));
  return figures;
}

double cross_validated_mN(const Material& on, const Choice& choice, const std::vector<Fold>& folds) {
  Figures figures;
  for (std::size_t left_out = 0; left_out < folds.size(); ++left_out) {
    std::vector<RecordingPtr> rest;
    for (std::size_t k = 0; k < folds.size(); ++k)
      if (k != left_out) rest.insert(rest.end(), folds[k].begin(), folds[k].end());
    const Figures one = judged(on, choice, rest, folds[left_out]);
    figures.samples += one.samples;
    figures.squares += one.squares;
  }
  return figures.rms_mN();
}

void run(benchmark::State& state, const std::string& name, const Choice& choice, bool validate) {
  try {
    const Material& on = material(name);
    for (auto _ : state) {
      const Figures held_out = judged(on, choice, on.train, on.test);
      state.counters["rms_mN"] = held_out.rms_mN();
      state.counters["within_JND_percent"] = held_out.within_percent();
      state.counters["worst_JND"] = held_out.worst_over_jnd;
      const std::vector<Fold> folds = folds_of(on.train);
      if (validate && !folds.empty()) state.counters["cross_validated_mN"] = cross_validated_mN(on, choice, folds);
    }
  } catch (const std::runtime_error& error) {
    state.SkipWithError(error.what());
  }
}

void add(const std::string& group, const std::string& name, const Choice& choice) {
  benchmark::RegisterBenchmark(
      (group + "/" + name + "/" + choice.name).c_str(),
      [name, choice, group](benchmark::State& state) { run(state, name, choice, group == "choice"); })
      ->Iterations(1)
      ->UseRealTime()
      ->Unit(benchmark::kSecond);
}

const std::vector<Choice>& choices() {
  static const std::vector<Choice> all{
      {"default", [](TrainingRequest&, MethodRequest&) {}},
      {"relaxation_identified", [](TrainingRequest& t, MethodRequest&) { t.relaxation = Relaxation::automatic; }},
      {"kernel_linear", [](TrainingRequest&, MethodRequest& m) { m.kernel = KernelKind::linear; }},
      {"kernel_thin_plate", [](TrainingRequest&, MethodRequest& m) { m.kernel = KernelKind::thin_plate; }},
      {"kernel_quintic", [](TrainingRequest&, MethodRequest& m) { m.kernel = KernelKind::quintic; }},
      {"weights_relative", [](TrainingRequest& t, MethodRequest&) { t.weighting = Weighting::relative; }},
      {"weights_none", [](TrainingRequest& t, MethodRequest&) { t.weighting = Weighting::none; }},
      {"every_50_mN", [](TrainingRequest& t, MethodRequest&) { t.reduction = Reduction::force; }},
      {"papers_recipe", [](TrainingRequest& t, MethodRequest&) { test::use_papers_recipe(t); }},
      {"candidates_all", [](TrainingRequest&, MethodRequest& m) { m.candidates = 0; }},
      {"direct", [](TrainingRequest&, MethodRequest& m) { m.method = &kDirectMethod; }},
  };
  return all;
}

const int registered = [] {
  std::vector<std::string> materials{"silicone", "foam", "gel", "stiff"};
  if (std::filesystem::exists(test::real_data())) materials.insert(materials.end(), {"skin", "press"});
  for (const std::string& name : materials) {
    for (const Choice& choice : choices()) {
      // The stiff block has no filter features.
      if (name == "stiff" && (choice.name.starts_with("filters") || choice.name.starts_with("relaxation"))) continue;
      add("choice", name, choice);
    }
    for (const int centres : {0, 1, 2, 5, 10, 20, 50, 100, 200}) {
      add("centres", name, {std::to_string(centres), [centres, name](TrainingRequest& t, MethodRequest& m) {
                              m.centres = centres;
                              if (name == "gel") t.relaxation = Relaxation::automatic;
                            }});
      add("centres_papers_recipe", name, {std::to_string(centres), [centres](TrainingRequest& t, MethodRequest& m) {
                                            test::use_papers_recipe(t);
                                            m.centres = centres;
                                          }});
    }
  }
  return 0;
}();

}  // namespace
}  // namespace palpate::bench
