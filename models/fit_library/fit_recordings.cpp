#include "models/fit_library/fit_recordings.h"

#include <cmath>
#include <utility>

namespace palpate {
namespace {

// The approximate time of the preparation, to compare with the expected time of the method.
constexpr double kPreparation_s = 0.5;

nlohmann::ordered_json offsets_json(const Provenance& provenance) {
  auto list = nlohmann::ordered_json::array();
  for (const RecordingOffset& one : provenance.offsets) {
    list.push_back({{"name", one.name},
                    {"surface_offset_m", one.offset_m},
                    {"standard_error_m", one.standard_error_m},  // not finite: null
                    {"identified", std::isfinite(one.standard_error_m)},
                    {"force_zero_N", one.force_zero_N}});
  }
  return list;
}

}  // namespace

Result<RecordingsFit> fit_recordings(std::vector<CheckedFile> recordings, const TrainingScene& scene,
                                     const ModelPlan& plan, std::chrono::steady_clock::time_point began,
                                     const std::function<bool(double)>& progress) {
  ModelFits fits(training_recordings(std::move(recordings)), scene);
  const FitControl control{progress};
  const double prepared_at = kPreparation_s / (kPreparation_s + expected_seconds(*plan.method));
  const auto prepared = fits.prepare(plan, control.part(0.0, prepared_at));
  if (!prepared) return prepared.error();
  auto fit = fits.fit(plan, control.part(prepared_at, 1.0));
  if (!fit) return fit.error();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return RecordingsFit{(*prepared)->gains, (*prepared)->correction, std::move(*fit), seconds};
}

nlohmann::ordered_json fit_json(const RecordingsFit& fitted) {
  const MethodFit& fit = fitted.fit;
  const ModelData& data = fit.data;
  nlohmann::ordered_json features = nlohmann::ordered_json::array();
  for (const FeatureSpec& spec : data.features) features.push_back(feature_name(spec));
  return {{"name", data.name},
          {"method", data.method},
          {"centres", data.centre_count()},
          {"kernel", kernel_name(fit.kernel)},
          {"weighting", data.provenance.weighting},
          {"samples", data.provenance.samples},
          {"samples_after_reduction", data.provenance.samples_after_reduction},
          {"rank", fit.rank},
          {"condition_number", fit.condition_number},
          {"fit_seconds", fitted.seconds},
          {"training_within_jnd", data.provenance.training_within_jnd},
          {"features", features},
          {"recordings", offsets_json(data.provenance)},
          {"notes", fit.notes}};
}

}  // namespace palpate
