#include "scenes/study/prepare_strokes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "engine/base/csv_scanner.h"
#include "engine/tick/replay.h"
#include "scenes/evaluation/error_figures.h"
#include "scenes/material/rig.h"
#include "scenes/study/study_presenter.h"
#include "scenes/worker/model_worker.h"
#include "scenes/worker/slot_plan.h"

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

// Forces with one value per ms.
struct Traces {
  double from_s = 0.0;
  std::vector<double> reference_N;
  std::vector<double> comparison_N;
  std::vector<bool> contact;
};

// The forces after the tick of one row.
struct Sample {
  double time_s = 0.0;
  double reference_N = 0.0;
  double comparison_N = 0.0;
  bool contact = false;
};

Result<std::vector<Sample>> samples_of(const Recording& recording, const Model& reference, const Model& comparison) {
  ForceModels models{comparison};
  if (reference != nullptr) models.push_back(reference);
  std::vector<Sample> samples;
  const auto summary =
      replay(recording, models, [&](const RecordingRow& row, const TickSnapshot& tick, const HapticsTick&) {
        samples.push_back(
            {row.time_s, reference != nullptr ? tick.force_N[1] : row.force_N, tick.force_N[0], tick.in_contact});
      });
  if (!summary) return summary.error();
  return samples;
}

std::vector<double> smoothed(const std::vector<double>& values) {
  std::array<double, 2 * kSmoothing_ticks + 1> window{};
  double sum = 0.0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    window[i] =
        1.0 - std::cos(2.0 * std::numbers::pi * static_cast<double>(i + 1) / static_cast<double>(window.size() + 1));
    sum += window[i];
  }
  std::vector<double> result(values.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t k = 0; k < window.size(); ++k) {
      const std::size_t at =
          std::clamp(i + k, kSmoothing_ticks, values.size() - 1 + kSmoothing_ticks) - kSmoothing_ticks;
      result[i] += window[k] / sum * values[at];
    }
  }
  return result;
}

// Interpolates linearly between the rows, and smooths the forces.
Traces traces_of(const std::vector<Sample>& samples) {
  Traces traces;
  traces.from_s = samples.front().time_s;
  const double seconds = std::min(samples.back().time_s - traces.from_s, kLongestRecording_s);
  const auto ticks = static_cast<std::size_t>(seconds / kStudyTick_s) + 1;
  std::size_t row = 0;
  for (std::size_t i = 0; i < ticks; ++i) {
    const double time_s = traces.from_s + kStudyTick_s * static_cast<double>(i);
    while (row + 2 < samples.size() && samples[row + 1].time_s <= time_s) ++row;
    const Sample& before = samples[row];
    const Sample& after = samples[row + 1];
    const double share = std::clamp((time_s - before.time_s) / (after.time_s - before.time_s), 0.0, 1.0);
    traces.reference_N.push_back(before.reference_N + share * (after.reference_N - before.reference_N));
    traces.comparison_N.push_back(before.comparison_N + share * (after.comparison_N - before.comparison_N));
    traces.contact.push_back(before.contact);
  }
  traces.reference_N = smoothed(traces.reference_N);
  traces.comparison_N = smoothed(traces.comparison_N);
  return traces;
}

// Whether the limits allow the presentation of the interval that begins at tick `from`.
bool can_be_presented(const std::vector<double>& force_N, std::size_t from) {
  double before_N = 0.0, squares_N2 = 0.0;
  for (std::uint32_t i = 0; i < kInterval_ticks; ++i) {
    const double now_N = force_N[from + i] * interval_share(i);
    if (std::abs(now_N) > kLargestStroke_N || std::abs(now_N - before_N) > kFastestStroke_N_per_s * kStudyTick_s)
      return false;
    before_N = now_N;
    squares_N2 += now_N * now_N;
  }
  return squares_N2 <= kStrongestStroke_N * kStrongestStroke_N * kInterval_ticks;
}

// The errors as they are presented, with the ramps at both ends.
ErrorFigures errors_from(const Traces& traces, std::size_t from, const JndLine& jnd) {
  ErrorFigures errors;
  for (std::uint32_t i = 0; i < kInterval_ticks; ++i) {
    if (!traces.contact[from + i]) continue;
    const double share = interval_share(i);
    errors.add(share * traces.comparison_N[from + i], share * traces.reference_N[from + i], false, jnd);
  }
  return errors;
}

// First tick of the piece with the largest difference; empty if no piece can be presented.
std::optional<std::size_t> hardest_piece(const Traces& traces, const JndLine& jnd) {
  std::optional<std::size_t> hardest;
  double most = -1.0;
  for (std::size_t from = 0; from + kInterval_ticks <= traces.contact.size(); from += kBetweenPieces_ticks) {
    const ErrorFigures errors = errors_from(traces, from, jnd);
    const double all_over_jnd = static_cast<double>(errors.samples()) * errors.mean_error_over_jnd();
    if (errors.samples() == 0 || all_over_jnd <= most) continue;
    if (!can_be_presented(traces.reference_N, from) || !can_be_presented(traces.comparison_N, from)) continue;
    hardest = from;
    most = all_over_jnd;
  }
  return hardest;
}

// Rounds to the resolution of the file, so that the file has what was presented: 0.1 mN, 1 ms, ratios to 1e-4.
double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

std::vector<double> cut(const std::vector<double>& force_N, std::size_t from) {
  std::vector<double> part;
  for (std::size_t i = 0; i < kInterval_ticks; ++i) part.push_back(rounded(force_N[from + i], 1e4));
  return part;
}

double held_mean_N(const std::vector<double>& force_N) {
  const auto held = force_N.begin() + kRamp_ticks;
  return rounded(std::accumulate(held, held + kHold_ticks, 0.0) / kHold_ticks, 1e4);
}

std::uint32_t checksum_of(const StrokePair& strokes) {
  std::uint32_t hash = 0x811c9dc5u;  // FNV-1a over tenths of mN
  for (const auto* force_N : {&strokes.reference_N, &strokes.comparison_N}) {
    for (const double value : *force_N) {
      const auto tenths = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * 1e4)));
      for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (tenths >> shift & 0xffu)) * 0x01000193u;
    }
  }
  return hash;
}

// Fits or loads the models of the plans, as the window does.
Result<std::vector<Model>> make_models(const Scene& scene, const std::vector<SlotPlan>& plans) {
  ModelWorker worker(scene, kTrainingSeed);
  std::vector<Model> models;
  for (const SlotPlan& plan : plans) {
    auto made = worker.make(plan);
    if (!made) return made.error();
    models.push_back(std::move(*made));
  }
  return models;
}

Result<Recording> test_recording(const StrokeRequest& request) {
  if (!request.recording.empty()) return read_recording(request.recording);
  if (!request.scene.material) {
    return Error{"the scene \"" + request.scene.name +
                 "\" has no virtual material to record; name a recording: --discriminate REC.csv"};
  }
  RigSettings settings;
  settings.material = *request.scene.material;
  settings.seed = kTestSeed;
  return record_sensors(settings);
}

}  // namespace

Result<std::shared_ptr<const StrokePair>> prepare_strokes(const StrokeRequest& request) {
  if (request.models.size() > 2) {
    return Error{"found " + std::to_string(request.models.size()) +
                 " models, expected one, to tell from the recorded force, or two; leave some out"};
  }
  Result<std::vector<SlotPlan>> plans = plan_slots(request.scene, request.models, false);
  if (!plans) return plans.error();
  plans->resize(std::max<std::size_t>(request.models.size(), 1));  // without a model as the reference, one model only
  const Result<Recording> recording = test_recording(request);
  if (!recording) return recording.error();
  const Result<std::vector<Model>> models = make_models(request.scene, *plans);
  if (!models) return models.error();
  return strokes_of(*recording, models->size() == 2 ? models->front() : nullptr, models->back(), request.scene.jnd);
}

Result<std::shared_ptr<const StrokePair>> strokes_of(const Recording& recording, const Model& reference,
                                                     const Model& comparison, const JndLine& jnd) {
  const Result<std::vector<Sample>> samples = samples_of(recording, reference, comparison);
  if (!samples) return samples.error();
  const Traces traces = traces_of(*samples);
  const std::optional<std::size_t> from = hardest_piece(traces, jnd);
  if (!from) {
    return Error{"found no piece of a stroke of 1.1 s, up to 3.8 N (2.5 N root mean square) and 90 N/s, in " +
                 recording.name + ", expected one that a still hand can be given; name another recording"};
  }
  auto strokes = std::make_shared<StrokePair>();
  strokes->reference = printable(reference != nullptr ? reference->name() : kRecordedForce, kLongestName);
  strokes->comparison = printable(comparison->name(), kLongestName);
  strokes->recording = printable(recording.name, kLongestName);
  strokes->from_s = rounded(traces.from_s + kStudyTick_s * static_cast<double>(*from), 1e3);
  strokes->to_s = rounded(strokes->from_s + kStudyTick_s * kInterval_ticks, 1e3);
  strokes->jnd = jnd;
  const ErrorFigures errors = errors_from(traces, *from, jnd);
  strokes->mean_over_jnd = rounded(errors.mean_error_over_jnd(), 1e4);
  strokes->max_over_jnd = rounded(errors.max_error_over_jnd(), 1e4);
  strokes->reference_N = cut(traces.reference_N, *from);
  strokes->comparison_N = cut(traces.comparison_N, *from);
  strokes->reference_mean_N = held_mean_N(strokes->reference_N);
  strokes->comparison_mean_N = held_mean_N(strokes->comparison_N);
  strokes->checksum = checksum_of(*strokes);
  return std::shared_ptr<const StrokePair>(std::move(strokes));
}

}  // namespace palpate
