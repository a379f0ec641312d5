#include "scenes/study/study_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "engine/base/text.h"
#include "engine/tick/haptics_tick.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/material/rig.h"
#include "scenes/scene/scene.h"
#include "scenes/worker/model_worker.h"

namespace palpate {
namespace {

constexpr std::uint64_t kTrainingSeed = 1;  // the same as in the window
constexpr std::uint64_t kTestSeed = 2;
constexpr std::size_t kSmoothing_ticks = 10;  // half width of the Hann window
constexpr std::size_t kBetweenPieces_ticks = 100;
// Below the limits of the presenter, so that its limiter does not act.
constexpr double kLargestStroke_N = 0.95 * kLargestStudyForce_N;
constexpr double kFastestStroke_N_per_s = 0.9 * kFastestStudyForce_N_per_s;
constexpr double kStrongestStroke_N = 2.5;  // root mean square; with the pauses 2 N, see assets/devices
constexpr std::size_t kLongestName = 200;
constexpr double kLongestRecording_s = 3600.0;  // bounds the memory: one value per ms

using Model = std::shared_ptr<const ForceModel>;

// Forces over time: after the tick of each row, or with one value per ms.
struct Trace {
  double time_s = 0.0, reference_N = 0.0, comparison_N = 0.0;
  bool contact = false;
};
using Traces = std::vector<Trace>;

Traces forces_of(const Recording& recording, const Model& reference, const Model& comparison) {
  ForceModels models{comparison};
  if (reference != nullptr) models.push_back(reference);
  Traces rows;
  replay(recording, models, [&](const RecordingRow& row, const TickSnapshot& tick, const HapticsTick&) {
    rows.push_back(
        {row.time_s, reference != nullptr ? tick.force_N[1] : row.force_N, tick.force_N[0], tick.in_contact});
  });
  return rows;
}

// One value per ms, interpolated linearly between the rows.
Traces resampled(const Traces& rows) {
  Traces traces;
  const double from_s = rows.front().time_s;
  const double seconds = std::min(rows.back().time_s - from_s, kLongestRecording_s);
  std::size_t row = 0;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(seconds / kHapticTick_s); ++i) {
    const double time_s = from_s + kHapticTick_s * static_cast<double>(i);
    while (row + 2 < rows.size() && rows[row + 1].time_s <= time_s) ++row;
    const Trace &a = rows[row], &b = rows[row + 1];
    const double share = std::clamp((time_s - a.time_s) / (b.time_s - a.time_s), 0.0, 1.0);
    traces.push_back({time_s, std::lerp(a.reference_N, b.reference_N, share),
                      std::lerp(a.comparison_N, b.comparison_N, share), a.contact});
  }
  return traces;
}

// The force weighted by a Hann window; the first and the last value continue beyond the ends.
void smooth(Traces& traces, double Trace::*force_N) {
  constexpr std::size_t kWidth = 2 * kSmoothing_ticks + 1;
  const Traces raw = traces;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    double sum_N = 0.0;
    for (std::size_t k = 0; k < kWidth; ++k) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(k + 1) / (kWidth + 1);
      const std::size_t at = std::clamp(i + k, kSmoothing_ticks, raw.size() - 1 + kSmoothing_ticks) - kSmoothing_ticks;
      sum_N += (1.0 - std::cos(angle)) / (kWidth + 1) * raw[at].*force_N;
    }
    traces[i].*force_N = sum_N;
  }
}

// Whether the limits allow the presentation of the interval that begins at tick `from`.
bool can_be_presented(const Traces& traces, std::size_t from, double Trace::*force_N) {
  double before_N = 0.0, squares_N2 = 0.0;
  for (std::uint32_t i = 0; i < kInterval_ticks; ++i) {
    const double now_N = traces[from + i].*force_N * interval_share(i);
    if (std::abs(now_N) > kLargestStroke_N || std::abs(now_N - before_N) > kFastestStroke_N_per_s * kHapticTick_s)
      return false;
    before_N = now_N;
    squares_N2 += now_N * now_N;
  }
  return squares_N2 <= kStrongestStroke_N * kStrongestStroke_N * kInterval_ticks;
}

// The first tick of the piece with the largest difference, and its errors as they are presented, with the ramps at both
// ends. They have no samples if no piece in contact can be presented.
std::pair<std::size_t, ErrorFigures> hardest_piece(const Traces& traces, const JndLine& jnd) {
  std::pair<std::size_t, ErrorFigures> hardest;
  double largest_sum = -1.0;
  for (std::size_t from = 0; from + kInterval_ticks <= traces.size(); from += kBetweenPieces_ticks) {
    ErrorFigures errors;
    for (std::uint32_t i = 0; i < kInterval_ticks; ++i) {
      const Trace& at = traces[from + i];
      const double share = interval_share(i);
      if (at.contact) errors.add(share * at.comparison_N, share * at.reference_N, false, jnd);
    }
    const double sum = static_cast<double>(errors.samples()) * errors.mean_error_over_jnd();
    if (errors.samples() == 0 || sum <= largest_sum || !can_be_presented(traces, from, &Trace::reference_N) ||
        !can_be_presented(traces, from, &Trace::comparison_N))
      continue;
    hardest = {from, errors};
    largest_sum = sum;
  }
  return hardest;
}

// Rounds to the resolution of the file, so that the file has what was presented: 0.1 mN, 1 ms, ratios to 1e-4.
double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

// Mean between the ramps.
double mean_of(const std::vector<double>& stroke_N) {
  const auto begin = stroke_N.begin() + kRamp_ticks;
  return rounded(std::accumulate(begin, begin + kHold_ticks, 0.0) / kHold_ticks, 1e4);
}

Result<Recording> test_recording(const Scene& scene, const std::string& recording) {
  if (!recording.empty()) return read_recording(recording);
  if (!scene.material) {
    return Error{"the scene \"" + scene.name +
                 "\" has no virtual material to record; name a recording: --discriminate REC.csv"};
  }
  return record_sensors({*scene.material, kTestSeed});
}

}  // namespace

Result<StrokesPointer> prepare_strokes(const std::string& scene, const std::vector<std::string>& models,
                                       const std::string& recording) {
  const Result<Scene> loaded = load_scene(scene);
  if (!loaded) return loaded.error();
  if (models.size() > 2) {
    return Error{"found " + std::to_string(models.size()) +
                 " models, expected one, to compare with the recorded force, or two; leave some out"};
  }
  const std::vector<std::string> wanted = models.empty() ? std::vector<std::string>{plan_name(ModelPlan{})} : models;
  const Result<std::vector<ModelRequest>> plans = requested_models(*loaded, wanted);
  if (!plans) return plans.error();
  const Result<Recording> rendered = test_recording(*loaded, recording);
  if (!rendered) return rendered.error();
  ModelWorker worker(*loaded, kTrainingSeed, {}, ready_models_folder());
  std::vector<Model> made;
  for (const ModelRequest& plan : *plans) {
    auto model = worker.make(plan);
    if (!model) return model.error();
    made.push_back(std::move(*model));
  }
  return strokes_of(*rendered, made.size() == 2 ? made.front() : nullptr, made.back(), loaded->jnd);
}

Result<StrokesPointer> strokes_of(const Recording& recording, const Model& reference, const Model& comparison,
                                  const JndLine& jnd) {
  Traces traces = resampled(forces_of(recording, reference, comparison));
  smooth(traces, &Trace::reference_N);
  smooth(traces, &Trace::comparison_N);
  const auto [from, errors] = hardest_piece(traces, jnd);
  if (errors.samples() == 0) {
    return Error{"found no piece of a stroke of 1.1 s, up to 3.8 N (2.5 N root mean square) and 90 N/s, in " +
                 recording.name + ", expected one that can be rendered to a still hand; name another recording"};
  }
  auto strokes = std::make_shared<StrokePair>();
  strokes->reference = printable(reference != nullptr ? reference->name() : "recorded force", kLongestName);
  strokes->comparison = printable(comparison->name(), kLongestName);
  strokes->recording = printable(recording.name, kLongestName);
  strokes->from_s = rounded(traces[from].time_s, 1e3);
  strokes->jnd = jnd;
  strokes->mean_over_jnd = rounded(errors.mean_error_over_jnd(), 1e4);
  strokes->max_over_jnd = rounded(errors.max_error_over_jnd(), 1e4);
  Recording hashed;  // the hash is of numbers, whatever their meaning
  for (std::size_t i = 0; i < kInterval_ticks; ++i) {
    const Trace& at = traces[from + i];
    strokes->reference_N.push_back(rounded(at.reference_N, 1e4));
    strokes->comparison_N.push_back(rounded(at.comparison_N, 1e4));
    hashed.rows.push_back({.position_m = strokes->comparison_N.back(), .force_N = strokes->reference_N.back()});
  }
  strokes->reference_mean_N = mean_of(strokes->reference_N);
  strokes->comparison_mean_N = mean_of(strokes->comparison_N);
  strokes->checksum = content_hash(hashed);
  return StrokesPointer(std::move(strokes));
}

}  // namespace palpate
