#include "models/fit/model_fits.h"

#include <algorithm>
#include <chrono>

#include "models/correction/methods.h"

namespace palpate {

Result<SamplesPointer> ModelFits::samples(const FitControl& control) {
  if (samples_ == nullptr) {
    auto made = make_samples(recordings_, scene_.jnd, control);
    if (!made) return made.error();
    samples_ = std::make_shared<const Samples>(std::move(*made));
  }
  return samples_;
}

Result<const PreparedTraining*> ModelFits::prepare(const ModelPlan& plan, const FitControl& control) {
  for (const auto& [other, prepared] : prepared_) {
    if (same_preparation(plan, other)) return prepared.get();
  }
  const auto table = samples(control.at(0.0));
  if (!table) return table.error();
  auto made = prepare_training(*table, scene_, plan, control);
  if (!made) return made.error();
  prepared_.emplace_back(plan, std::make_unique<PreparedTraining>(std::move(*made)));
  return prepared_.back().second.get();
}

Result<ModelFits::Fit> ModelFits::fit(const ModelPlan& plan, const FitControl& control) {
  const auto prepared = prepare(plan, control);
  if (!prepared) return prepared.error();
  const MethodFit* base = nullptr;
  const OpenChoices* choices = nullptr;
  double seconds = 0.0;
  for (const auto& [other, fit] : fits_) {
    if (!same_preparation(plan, other) || plan.kernel != other.kernel) continue;
    const bool same_size =
        plan.selects_centres() == other.selects_centres() && (!plan.selects_centres() || plan.centres == other.centres);
    if (fit.choices && same_size) choices = &*fit.choices;
    if (plan.method->base != other.method) continue;
    base = &fit;
    seconds = fit.seconds;
  }
  const auto start = std::chrono::steady_clock::now();
  auto made = fit_method(**prepared, plan, control, base, choices);
  if (!made) return made.error();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  Fit fit{std::move(*made), elapsed.count() + seconds};
  const bool starts_others =
      std::ranges::any_of(methods(), [&](const Method* one) { return one->base == plan.method; });
  const bool has_choices = fit.choices && choices == nullptr;
  if (starts_others || has_choices) fits_.emplace_back(plan, fit);
  return fit;
}

}  // namespace palpate
