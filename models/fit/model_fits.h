// The fits of several plans to the same recordings. Parts that plans have in common are made once: the preparation of
// the training, what the paper leaves open, and the fit from which another method starts (its base).
// Thread guarantee: slow side; one thread per object; fits start threads.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "engine/base/fit_control.h"
#include "models/fit/fit.h"

namespace palpate {

class ModelFits {
 public:
  ModelFits(std::vector<PreparedRecordingPointer> recordings, TrainingScene scene)
      : recordings_(std::move(recordings)), scene_(std::move(scene)) {}
  ModelFits(SamplesPointer samples, TrainingScene scene) : scene_(std::move(scene)), samples_(std::move(samples)) {}

  // The samples of the recordings. Errors: those of make_samples.
  Result<SamplesPointer> samples(const FitControl& control);
  // The preparation of a plan. Valid while this lives. Errors: those of make_samples and prepare_training.
  Result<const PreparedTraining*> prepare(const ModelPlan& plan, const FitControl& control);

  struct Fit : MethodFit {
    double seconds = 0.0;  // with its base, without the preparation
  };
  // Errors: those of prepare and fit_method.
  Result<Fit> fit(const ModelPlan& plan, const FitControl& control);

 private:
  std::vector<PreparedRecordingPointer> recordings_;
  TrainingScene scene_;
  SamplesPointer samples_;
  std::vector<std::pair<ModelPlan, std::unique_ptr<PreparedTraining>>> prepared_;
  std::vector<std::pair<ModelPlan, Fit>> fits_;  // to start others from
};

}  // namespace palpate
