#include "scenes/evaluation/evaluate.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/tick/sensor_identification.h"

namespace palpate {
namespace {

using Models = std::vector<EvaluatedModel>;

double median_of(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

// The results of all models over all rows.
struct Passed {
  ReplaySummary summary;
  ModelErrors no_force;
  std::vector<ModelErrors> errors;
  std::vector<BoundErrors> bounds;
};

// Replays the rows with up to kMaxModels models at a time. `also` is called for every row with the first of these
// groups. `from`: progress of the evaluation at the beginning.
Result<Passed> pass_over(const RowSource& rows, const Models& models, double surface_offset_m,
                         const EvaluationRequest& request, double from, const ReplayVisitor& also) {
  Passed passed{{}, ModelErrors(models.front().jnd), {}, std::vector<BoundErrors>(models.size())};
  for (const EvaluatedModel& one : models) passed.errors.emplace_back(one.jnd);
  // Contact of each row, from the first group of models, so that all models have the same samples.
  std::vector<bool> contact;
  for (std::size_t first = 0; first < models.size(); first += kMaxModels) {
    const double done = static_cast<double>(first) / static_cast<double>(models.size());
    if (!request.control.may_continue(from + 0.5 * done)) return interrupted();
    const std::size_t end = std::min(first + kMaxModels, models.size());
    ForceModels batch;
    for (std::size_t i = first; i < end; ++i) batch.push_back(models[i].model);
    StrokeCounter strokes;
    std::size_t row_number = 0;
    const auto visitor = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
      if (first == 0 && also) also(row, snapshot, tick);
      if (first == 0) contact.push_back(snapshot.in_contact);
      const bool in_contact = contact[row_number++];
      const bool begins = strokes.begins_stroke(row.time_s, in_contact);
      if (!in_contact || row.time_s < request.counted_from_s) return;
      const auto add = [&](ModelErrors& errors, double model_N, bool out_of_domain) {
        if (begins) errors.begin_stroke();
        errors.add(model_N, row.force_N, out_of_domain);
      };
      if (first == 0) add(passed.no_force, 0.0, false);
      for (std::size_t i = first; i < end; ++i) {
        const double model_N = snapshot.force_N[i - first];
        add(passed.errors[i], model_N, (snapshot.out_of_domain_mask >> (i - first) & 1U) != 0);
        passed.bounds[i].add(snapshot.predicted_error_N[i - first], model_N, row.force_N, models[i].jnd);
      }
    };
    const auto summary = rows(batch, visitor, surface_offset_m);
    if (!summary) return summary.error();
    passed.summary = *summary;
  }
  return passed;
}

}  // namespace

void BoundErrors::add(double bound_N, double model_N, double measured_N, const JndLine& jnd) {
  if (std::isnan(bound_N)) return;
  bound_N_.push_back(static_cast<float>(bound_N));
  over_jnd_.push_back(static_cast<float>(bound_N / jnd.at(measured_N)));
  if (std::abs(model_N - measured_N) <= bound_N) ++covered_;
  largest_force_N_ = std::max(largest_force_N_, std::abs(measured_N));
}

void BoundErrors::append(const BoundErrors& other) {
  bound_N_.insert(bound_N_.end(), other.bound_N_.begin(), other.bound_N_.end());
  over_jnd_.insert(over_jnd_.end(), other.over_jnd_.begin(), other.over_jnd_.end());
  covered_ += other.covered_;
  largest_force_N_ = std::max(largest_force_N_, other.largest_force_N_);
}

BoundFigures BoundErrors::figures() const {
  if (bound_N_.empty()) return {};
  const double median_N = median_of(bound_N_);
  return {static_cast<double>(covered_) / static_cast<double>(bound_N_.size()), median_N,
          median_N <= largest_force_N_ ? median_of(over_jnd_) : kUnknown};
}

RowSource rows_of(const Recording& recording) {
  return [&recording](const ForceModels& models, const ReplayVisitor& visitor, double surface_offset_m) {
    return replay(recording, models, visitor, surface_offset_m);
  };
}

RowSource rows_of_file(const std::string& path) {
  return [path](const ForceModels& models, const ReplayVisitor& visitor,
                double surface_offset_m) -> Result<ReplaySummary> {
    Result<RecordingReader> reader = RecordingReader::open(path);
    if (!reader) return reader.error();
    return replay(*reader, models, visitor, surface_offset_m);
  };
}

Result<RecordingEvaluation> evaluate(const RowSource& rows, const Models& models, const EvaluationRequest& request) {
  RecordingEvaluation result;
  GrowingStride surface_rows(2 * kSearchRows);
  const auto visitor = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
    const ToolSample sample = tool_sample(row);
    surface_rows.add({sample, tick.motion(), row.force_N});
    if (snapshot.in_contact && result.timing.samples.size() < kTimedSamples) result.timing.samples.push_back(sample);
    if (request.also) request.also(row, snapshot, tick);
  };
  const auto recorded = pass_over(rows, models, 0.0, request, 0.0, visitor);
  if (!recorded) return recorded.error();
  result.samples = recorded->summary.samples;
  result.contact_samples = recorded->no_force.summary().samples;
  result.timing.sensor = recorded->summary.sensor;
  result.no_force = recorded->no_force;
  for (std::size_t i = 0; i < models.size(); ++i) {
    result.models.push_back({recorded->errors[i], recorded->errors[i], recorded->bounds[i], recorded->bounds[i], {}});
  }
  if (!request.move_surface) return result;
  const std::vector<Sample> searched = thinned_rows(surface_rows.rows(), kSearchRows);
  std::map<double, std::vector<std::size_t>> by_offset;
  OffsetEstimate common;
  if (!request.surface_models.empty()) common = locate_surface(searched, request.surface_models, models.front().jnd);
  for (std::size_t i = 0; i < models.size(); ++i) {
    OffsetEstimate& surface = result.models[i].surface;
    surface = request.surface_models.empty() ? locate_surface(searched, {models[i].model}, models[i].jnd) : common;
    if (surface.at != 0.0) by_offset[surface.at].push_back(i);
  }
  for (const auto& [offset_m, which] : by_offset) {
    Models there;
    for (const std::size_t i : which) there.push_back(models[i]);
    const auto moved = pass_over(rows, there, offset_m, request, 0.5, {});
    if (!moved) return moved.error();
    for (std::size_t i = 0; i < which.size(); ++i) {
      result.models[which[i]].surface_moved = moved->errors[i];
      result.models[which[i]].bound_surface_moved = moved->bounds[i];
    }
  }
  return result;
}

}  // namespace palpate
