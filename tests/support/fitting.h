// Short helpers for tests of fitted models: recordings of the virtual rig, fits
// and error figures.
//
// Every helper throws std::runtime_error with the message of an error. That
// fails the calling test.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "models/correction/methods.h"
#include "models/fit/fit.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/material/rig.h"
#include "tests/support/message_parts.h"

namespace palpate::test {

using RecordingPtr = std::shared_ptr<const Recording>;
using ModelPtr = std::shared_ptr<const FittedModel>;

// The usual training recording (seed 1, 41.499 s) and test recording (45.272 s,
// another seed) of a material.
RigSettings train_settings(const std::string& material);
RigSettings test_settings(const std::string& material);

RecordingPtr rig_recording(const RigSettings& settings);
// The recordings by these settings, made once per process.
RecordingPtr train_recording(const std::string& material);
RecordingPtr test_recording(const std::string& material);
// Removes the acceleration column, so that only the encoder is left.
RecordingPtr encoder_only(const RecordingPtr& recording);

// Real recordings, from ../shared/data beside the sources.
std::filesystem::path real_data();
RecordingPtr real_recording(const std::string& file);
// `kind`: "train" or "test".
std::vector<RecordingPtr> skin_recordings(const std::string& kind, const std::vector<std::string>& forces_mN);

// What a scene and a plan give to a fit.
struct FitRequest {
  TrainingScene scene;
  ModelPlan plan{};
};
// `palpate fit --scene SCENE`, without and with `--features scene`.
FitRequest default_request(const std::string& scene);
FitRequest scene_request(const std::string& scene);
// A model with the depth as its only feature.
FitRequest position_request();
// The same with the methods on the measured force.
FitRequest on_the_force(FitRequest setup);

SamplesPointer samples_of(const std::vector<RecordingPtr>& recordings, const JndLine& jnd = {});
PreparedTraining prepare(const std::vector<RecordingPtr>& recordings, const FitRequest& setup);
ModelPtr fit(const PreparedTraining& prepared, const Method* method, std::uint64_t seed = 1);
// One of each method, in the order of methods(); on the measured force without the trend.
std::vector<ModelPtr> fit_all(const PreparedTraining& prepared);

// The errors over the samples in contact, as recorded.
ErrorSummary judge(const Recording& recording, const ModelPtr& model);
// The same, with the surface of the recording moved to that of the model.
ErrorSummary judge_moved(const Recording& recording, const ModelPtr& model);

// The worst of (mean + standard deviation) / JND over the bins that begin at
// `from_N` or above and hold at least 100 samples.
double worst_bin_over_jnd(const ErrorSummary& summary, double from_N = 0.0);

// One line of error figures for the log.
std::string figures(const std::string& name, const ErrorSummary& summary);

}  // namespace palpate::test
