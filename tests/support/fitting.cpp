#include "tests/support/fitting.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include "scenes/evaluation/evaluate.h"
#include "scenes/scene/scene.h"

namespace palpate::test {
namespace {

constexpr double kTestSeconds = 45.272;
constexpr std::uint64_t kTestSeed = 2;
// Bins with fewer samples are ignored, because their deviation is unreliable.
constexpr std::uint64_t kFullBin = 100;

// `settings`: train_settings or test_settings of a material.
RecordingPtr made_once(const RigSettings& settings) {
  static std::map<std::pair<std::string, std::uint64_t>, RecordingPtr> made;
  RecordingPtr& recording = made[{settings.material, settings.seed}];
  if (recording == nullptr) recording = rig_recording(settings);
  return recording;
}

}  // namespace

RigSettings train_settings(const std::string& material) {
  RigSettings settings;
  settings.material = material;
  return settings;
}

RigSettings test_settings(const std::string& material) {
  RigSettings settings;
  settings.material = material;
  settings.seed = kTestSeed;
  settings.seconds = kTestSeconds;
  return settings;
}

RecordingPtr rig_recording(const RigSettings& settings) {
  return std::make_shared<const Recording>(must(record_sensors(settings)));
}

RecordingPtr train_recording(const std::string& material) { return made_once(train_settings(material)); }

RecordingPtr test_recording(const std::string& material) { return made_once(test_settings(material)); }

RecordingPtr encoder_only(const RecordingPtr& recording) {
  auto copy = std::make_shared<Recording>(*recording);
  copy->columns.acceleration = false;
  for (RecordingRow& row : copy->rows) row.acceleration_m_per_s2 = 0.0;
  return copy;
}

std::filesystem::path real_data() { return std::filesystem::path(PALPATE_SOURCE_DIR) / "../shared/data"; }

RecordingPtr real_recording(const std::string& file) {
  return std::make_shared<const Recording>(must(read_recording((real_data() / file).string())));
}

std::vector<RecordingPtr> skin_recordings(const std::string& kind, const std::vector<std::string>& forces_mN) {
  std::vector<RecordingPtr> recordings;
  for (const std::string& force : forces_mN)
    recordings.push_back(real_recording("aurora_skin/" + kind + "_" + force + "mN.csv"));
  return recordings;
}

FitRequest default_request(const std::string& scene) { return {training_scene(must(load_scene(scene)))}; }

FitRequest scene_request(const std::string& scene) {
  FitRequest setup = default_request(scene);
  setup.plan.features = FeatureChoice::scene;
  return setup;
}

FitRequest position_request() { return scene_request("elastic_block"); }

FitRequest on_the_force(FitRequest setup) {
  setup.plan.base = Base::force;
  return setup;
}

SamplesPointer samples_of(const std::vector<RecordingPtr>& recordings, const JndLine& jnd) {
  std::vector<PreparedRecordingPointer> prepared;
  for (const RecordingPtr& recording : recordings) prepared.push_back(prepare_recording(*recording));
  return std::make_shared<const Samples>(must(make_samples(std::move(prepared), jnd)));
}

PreparedTraining prepare(const std::vector<RecordingPtr>& recordings, const FitRequest& setup) {
  return must(prepare_training(samples_of(recordings, setup.scene.jnd), setup.scene, setup.plan));
}

ModelPtr fit(const PreparedTraining& prepared, const Method* method, std::uint64_t seed) {
  const ModelPlan plan{.base = prepared.correction ? Base::trend : Base::force, .method = method, .seed = seed};
  return must(fit_method(prepared, plan)).model;
}

std::vector<ModelPtr> fit_all(const PreparedTraining& prepared) {
  std::vector<ModelPtr> models;
  for (const Method* method : methods()) {
    if (prepared.correction || method != &kTrendMethod) models.push_back(fit(prepared, method));
  }
  return models;
}

ErrorSummary judge(const Recording& recording, const ModelPtr& model) {
  EvaluationRequest request;
  request.move_surface = false;
  return must(evaluate(recording, {{model, model->data().jnd}}, request)).models.front().as_recorded.summary();
}

ErrorSummary judge_moved(const Recording& recording, const ModelPtr& model) {
  return must(evaluate(recording, {{model, model->data().jnd}})).models.front().surface_moved.summary();
}

double worst_bin_over_jnd(const ErrorSummary& summary, double from_N) {
  double worst = 0.0;
  for (const ForceBin& bin : summary.bins) {
    if (bin.force_from_N < from_N || bin.force_N.count() < kFullBin) continue;
    worst = std::max(worst, (bin.error_N.mean() + bin.error_N.deviation()) / bin.jnd_N);
  }
  return worst;
}

std::string figures(const std::string& name, const ErrorSummary& summary) {
  char line[256];
  std::snprintf(line, sizeof line,
                "%-12s RMS %6.1f mN, within JND %7.3f %%, worst %6.2f JND, worst bin %5.2f JND, out of domain %.1f %%",
                name.c_str(), 1e3 * summary.rms_error_N, 100.0 * summary.within_jnd, summary.max_error_over_jnd,
                worst_bin_over_jnd(summary),
                100.0 * static_cast<double>(summary.out_of_domain_samples) /
                    static_cast<double>(std::max<std::uint64_t>(summary.samples, 1)));
  return line;
}

}  // namespace palpate::test
