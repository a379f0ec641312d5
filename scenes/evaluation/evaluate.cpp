#include "scenes/evaluation/evaluate.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/tick/sensor_identification.h"

namespace palpate {
namespace {

// One pass over the rows, the errors model by model.
class ErrorPass {
 public:
  ErrorPass(const std::vector<EvaluatedModel>& models, double seconds, const Interval& counted_s)
      : strokes_(seconds), counted_s_(counted_s), no_force_(models.front().jnd), bounds_(models.size()) {
    for (const EvaluatedModel& one : models) errors_.emplace_back(one.jnd);
  }

  void add(const RecordingRow& row, const TickSnapshot& snapshot) {
    const bool contact = counts(snapshot, row.force_N);
    const bool block = strokes_.begins_block(row.time_s, contact);
    if (!contact || row.time_s < counted_s_.low || row.time_s >= counted_s_.high) return;
    if (block) no_force_.begin_block(strokes_.begins_stroke());
    no_force_.add(0.0, row.force_N, false);
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      if (block) errors_[i].begin_block(strokes_.begins_stroke());
      errors_[i].add(snapshot.force_N[i], row.force_N, (snapshot.out_of_domain_mask >> i & 1U) != 0);
      const double bound_N = snapshot.predicted_error_N[i];
      if (std::isnan(bound_N)) continue;
      bounds_[i].bound_N.push_back(static_cast<float>(bound_N));
      if (std::abs(snapshot.force_N[i] - row.force_N) <= bound_N) ++bounds_[i].held;
    }
  }

  const ModelErrors& errors(std::size_t model) const { return errors_[model]; }
  const ModelErrors& no_force() const { return no_force_; }

  PredictedErrors predicted(std::size_t model) const {
    std::vector<float> all = bounds_[model].bound_N;
    if (all.empty()) return {};
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    return {static_cast<double>(bounds_[model].held) / static_cast<double>(all.size()), static_cast<double>(*middle)};
  }

 private:
  struct Bounds {
    std::vector<float> bound_N;
    std::size_t held = 0;
  };
  StrokeCounter strokes_;
  Interval counted_s_;
  ModelErrors no_force_;
  std::vector<ModelErrors> errors_;
  std::vector<Bounds> bounds_;
};

using Models = std::vector<EvaluatedModel>;

// What all models made of all rows.
struct Passed {
  ReplaySummary summary;
  ModelErrors no_force{JndLine{}};
  std::vector<ModelErrors> errors;
  std::vector<PredictedErrors> predicted;
};

// Up to kMaxModels models at a time; `also` sees every row with the first of them. `from`: what of
// the whole is done before.
Result<Passed> pass_over(const RowSource& rows, const Models& models, double surface_offset_m,
                         const EvaluationRequest& request, double from, const ReplayVisitor& also) {
  Passed passed;
  for (std::size_t first = 0; first < models.size(); first += kMaxModels) {
    const double done = static_cast<double>(first) / static_cast<double>(models.size());
    if (!request.control.may_continue(from + 0.5 * done)) return interrupted();
    const auto begin = models.begin() + static_cast<std::ptrdiff_t>(first);
    const Models batch(begin, begin + static_cast<std::ptrdiff_t>(std::min(kMaxModels, models.size() - first)));
    ForceModels force_models;
    for (const EvaluatedModel& one : batch) force_models.push_back(one.model);
    ErrorPass pass(batch, rows.seconds, request.counted_s);
    const auto visitor = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
      pass.add(row, snapshot);
      if (first == 0 && also) also(row, snapshot, tick);
    };
    const auto summary = rows.replay(force_models, visitor, surface_offset_m);
    if (!summary) return summary.error();
    if (first == 0) {
      passed.summary = *summary;
      passed.no_force = pass.no_force();
    }
    for (std::size_t i = 0; i < batch.size(); ++i) {
      passed.errors.push_back(pass.errors(i));
      passed.predicted.push_back(pass.predicted(i));
    }
  }
  return passed;
}

}  // namespace

RowSource rows_of(const Recording& recording) {
  const double seconds = recording.rows.empty() ? 0.0 : recording.rows.back().time_s - recording.rows.front().time_s;
  return {[&recording](const ForceModels& models, const ReplayVisitor& visitor, double surface_offset_m) {
            return replay(recording, models, visitor, surface_offset_m);
          },
          seconds};
}

RowSource rows_of_file(const std::string& path) {
  return {[path](const ForceModels& models, const ReplayVisitor& visitor,
                 double surface_offset_m) -> Result<ReplaySummary> {
    Result<RecordingReader> reader = RecordingReader::open(path);
    if (!reader) return reader.error();
    return replay(*reader, models, visitor, surface_offset_m);
  }};
}

Result<RecordingEvaluation> evaluate(const RowSource& rows, const Models& models, const EvaluationRequest& request) {
  RecordingEvaluation result;
  GrowingStride surface_rows(2 * kSearchRows);
  const auto visitor = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
    const ToolSample sample = tool_sample(row);
    surface_rows.add({sample, tick.motion(), row.force_N});
    if (snapshot.in_contact) result.timing.add(sample);
    if (request.also) request.also(row, snapshot, tick);
  };
  const auto recorded = pass_over(rows, models, 0.0, request, 0.0, visitor);
  if (!recorded) return recorded.error();
  result.samples = recorded->summary.samples;
  result.contact_samples = recorded->no_force.summary().samples;
  result.sensor = recorded->summary.sensor;
  result.no_force = recorded->no_force;
  for (std::size_t i = 0; i < models.size(); ++i) {
    result.models.push_back({recorded->errors[i], recorded->errors[i], recorded->predicted[i], {}});
  }
  if (!request.move_surface) return result;
  const std::vector<SurfaceRow> searched = thinned_rows(surface_rows.rows(), kSearchRows);
  std::map<double, std::vector<std::size_t>> by_offset;
  Located common;
  if (!request.surface_models.empty()) common = locate_surface(searched, request.surface_models, models.front().jnd);
  for (std::size_t i = 0; i < models.size(); ++i) {
    Located& surface = result.models[i].surface;
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
      result.models[which[i]].predicted = moved->predicted[i];
    }
  }
  return result;
}

}  // namespace palpate
