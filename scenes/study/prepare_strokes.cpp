#include "scenes/study/prepare_strokes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "engine/base/csv_scanner.h"
#include "engine/recording/content_hash.h"
#include "engine/tick/replay.h"
#include "scenes/evaluation/error_figures.h"
#include "scenes/material/rig.h"
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

// Forces over time: after the tick of each row, or with one value per ms.
struct Traces {
  std::vector<double> time_s;
  std::vector<double> reference_N;
  std::vector<double> comparison_N;
  std::vector<bool> contact;
};

Result<Traces> forces_of(const Recording& recording, const Model& reference, const Model& comparison) {
  ForceModels models{comparison};
  if (reference != nullptr) models.push_back(reference);
  Traces rows;
  const auto summary =
      replay(recording, models, [&](const RecordingRow& row, const TickSnapshot& tick, const HapticsTick&) {
        rows.time_s.push_back(row.time_s);
        rows.reference_N.push_back(reference != nullptr ? tick.force_N[1] : row.force_N);
        rows.comparison_N.push_back(tick.force_N[0]);
        rows.contact.push_back(tick.in_contact);
      });
  if (!summary) return summary.error();
  return rows;
}

std::vector<double> smoothed(const std::vector<double>& values) {
  constexpr std::size_t kWidth = 2 * kSmoothing_ticks + 1;
  std::array<double, kWidth> window{};  // the weights of a Hann window sum to (kWidth + 1) / 2
  for (std::size_t k = 0; k < kWidth; ++k)
    window[k] = (1.0 - std::cos(2.0 * std::numbers::pi * static_cast<double>(k + 1) / (kWidth + 1))) / (kWidth + 1);
  std::vector<double> result(values.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t k = 0; k < kWidth; ++k)
      result[i] += window[k] *
                   values[std::clamp(i + k, kSmoothing_ticks, values.size() - 1 + kSmoothing_ticks) - kSmoothing_ticks];
  }
  return result;
}

// One value per ms, interpolated linearly between the rows; smooths the forces.
Traces resampled(const Traces& rows) {
  Traces traces;
  const double from_s = rows.time_s.front();
  const double seconds = std::min(rows.time_s.back() - from_s, kLongestRecording_s);
  const auto ticks = static_cast<std::size_t>(seconds / kStudyTick_s) + 1;
  std::size_t row = 0;
  for (std::size_t i = 0; i < ticks; ++i) {
    const double time_s = from_s + kStudyTick_s * static_cast<double>(i);
    while (row + 2 < rows.time_s.size() && rows.time_s[row + 1] <= time_s) ++row;
    const double share = std::clamp((time_s - rows.time_s[row]) / (rows.time_s[row + 1] - rows.time_s[row]), 0.0, 1.0);
    traces.time_s.push_back(time_s);
    traces.reference_N.push_back(std::lerp(rows.reference_N[row], rows.reference_N[row + 1], share));
    traces.comparison_N.push_back(std::lerp(rows.comparison_N[row], rows.comparison_N[row + 1], share));
    traces.contact.push_back(rows.contact[row]);
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

// Cuts out an interval and returns its mean between the ramps.
double cut(const std::vector<double>& force_N, std::size_t from, std::vector<double>& stroke_N) {
  double mean_N = 0.0;
  for (std::uint32_t i = 0; i < kInterval_ticks; ++i) {
    stroke_N.push_back(rounded(force_N[from + i], 1e4));
    if (is_held(i)) mean_N += stroke_N.back() / kHold_ticks;
  }
  return rounded(mean_N, 1e4);
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
                 " models, expected one, to compare with the recorded force, or two; leave some out"};
  }
  Result<std::vector<SlotPlan>> plans = plan_slots(request.scene, request.models, false);
  if (!plans) return plans.error();
  plans->resize(std::max<std::size_t>(request.models.size(), 1));
  const Result<Recording> recording = test_recording(request);
  if (!recording) return recording.error();
  ModelWorker worker(request.scene, kTrainingSeed);
  std::vector<Model> models;
  for (const SlotPlan& plan : *plans) {
    auto made = worker.make(plan);
    if (!made) return made.error();
    models.push_back(std::move(*made));
  }
  return strokes_of(*recording, models.size() == 2 ? models.front() : nullptr, models.back(), request.scene.jnd);
}

Result<std::shared_ptr<const StrokePair>> strokes_of(const Recording& recording, const Model& reference,
                                                     const Model& comparison, const JndLine& jnd) {
  const Result<Traces> rows = forces_of(recording, reference, comparison);
  if (!rows) return rows.error();
  const Traces traces = resampled(*rows);
  const std::optional<std::size_t> from = hardest_piece(traces, jnd);
  if (!from) {
    return Error{"found no piece of a stroke of 1.1 s, up to 3.8 N (2.5 N root mean square) and 90 N/s, in " +
                 recording.name + ", expected one that can be rendered to a still hand; name another recording"};
  }
  auto strokes = std::make_shared<StrokePair>();
  strokes->reference = printable(reference != nullptr ? reference->name() : kRecordedForce, kLongestName);
  strokes->comparison = printable(comparison->name(), kLongestName);
  strokes->recording = printable(recording.name, kLongestName);
  strokes->from_s = rounded(traces.time_s[*from], 1e3);
  strokes->jnd = jnd;
  const ErrorFigures errors = errors_from(traces, *from, jnd);
  strokes->mean_over_jnd = rounded(errors.mean_error_over_jnd(), 1e4);
  strokes->max_over_jnd = rounded(errors.max_error_over_jnd(), 1e4);
  strokes->reference_mean_N = cut(traces.reference_N, *from, strokes->reference_N);
  strokes->comparison_mean_N = cut(traces.comparison_N, *from, strokes->comparison_N);
  ContentHash hash;
  for (std::size_t i = 0; i < kInterval_ticks; ++i) {
    RecordingRow row;
    row.position_m = strokes->comparison_N[i];  // the hash is of numbers, whatever their meaning
    row.force_N = strokes->reference_N[i];
    hash.add(row);
  }
  strokes->checksum = hash.value();
  return std::shared_ptr<const StrokePair>(std::move(strokes));
}

}  // namespace palpate
