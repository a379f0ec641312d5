#include "tests/stability/hard_methods.h"

#include <utility>

#include "engine/tick/replay.h"

namespace palpate {
namespace {

HardCaseResult begin_result(const std::string& name, const Method& method, const FitReport& report) {
  HardCaseResult result;
  result.name = name;
  result.method = method.name;
  result.condition = report.condition;
  result.residual = report.residual_rms;
  result.smoothing = report.smoothing;
  return result;
}

}  // namespace

TrainingRequest clean_request() {
  TrainingRequest request;
  request.scene = "hard case";
  request.surface = Surface::recorded;
  request.features = {
      {FeatureKind::depth, 0.0, {}}, {FeatureKind::velocity, 0.0, {}}, {FeatureKind::lowpass_velocity, 0.17, {}}};
  return request;
}

std::vector<HardCaseResult> FittedMethods::finish(const std::vector<OutcomeCounter>& counters) const {
  std::vector<HardCaseResult> finished = results;
  for (std::size_t i = 0; i < models.size(); ++i) finished[at[i]] = counters[i].finish(std::move(finished[at[i]]));
  return finished;
}

FittedMethods fit_methods(const std::string& name, const Recording& recording, const TrainingRequest& request) {
  MotionSource source({{"", prepare_recording(recording)}});
  const Result<PreparedTraining> prepared = prepare_training(source, request);
  FittedMethods all;
  for (const Method* method : methods()) {
    MethodRequest what;
    what.method = method;
    const Result<MethodFit> fitted = prepared ? fit_method(*prepared, what) : Result<MethodFit>(prepared.error());
    if (!fitted) {
      all.results.push_back(refused(begin_result(name, *method, {}), fitted.error().message));
      continue;
    }
    all.at.push_back(all.results.size());
    all.results.push_back(begin_result(name, *method, fitted->report));
    all.models.push_back(std::make_shared<const FittedModel>(fitted->data));
  }
  return all;
}

void evaluate_press(const Press& press, const std::vector<std::shared_ptr<const FittedModel>>& models,
                    std::vector<OutcomeCounter>& counters) {
  std::size_t row = 0;
  replay(press.recording, ForceModels(models.begin(), models.end()),
         [&](const RecordingRow&, const TickSnapshot& snapshot, const HapticsTick&) {
           const double truth_N = press.true_N[row++];
           if (!snapshot.in_contact) return;
           for (std::size_t i = 0; i < models.size(); ++i)
             counters[i].add(snapshot.force_N[i], truth_N, 0.0, kForceMargin * models[i]->data().largest_force_N);
         });
}

}  // namespace palpate
