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

// Calls `one(batch, index of its first model)` for up to kMaxModels models at a time.
template <typename One>
Status in_batches(const Models& models, const FitControl& control, double from, const One& one) {
  for (std::size_t first = 0; first < models.size(); first += kMaxModels) {
    const double done = static_cast<double>(first) / static_cast<double>(models.size());
    if (!control.may_continue(from + 0.5 * done)) return interrupted();
    const auto begin = models.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(std::min(kMaxModels, models.size() - first));
    if (const Status status = one(Models(begin, end), first); !status) return status;
  }
  return {};
}

ForceModels force_models(const Models& models) {
  ForceModels list;
  for (const EvaluatedModel& one : models) list.push_back(one.model);
  return list;
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
  const Status recorded =
      in_batches(models, request.control, 0.0, [&](const Models& batch, std::size_t first) -> Status {
        ErrorPass pass(batch, rows.seconds, request.counted_s);
        const auto visitor = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
          pass.add(row, snapshot);
          if (first > 0) return;
          const ToolSample sample = tool_sample(row);
          surface_rows.add({sample, tick.motion(), row.force_N});
          if (snapshot.in_contact) result.timing.add(sample);
          if (request.also) request.also(row, snapshot, tick);
        };
        const auto summary = rows.replay(force_models(batch), visitor, 0.0);
        if (!summary) return summary.error();
        if (first == 0) {
          result.samples = summary->samples;
          result.contact_samples = pass.no_force().summary().samples;
          result.sensor = summary->sensor;
          result.no_force = pass.no_force();
        }
        for (std::size_t i = 0; i < batch.size(); ++i) {
          result.models.push_back({pass.errors(i), pass.errors(i), pass.predicted(i), {}});
        }
        return {};
      });
  if (!recorded) return recorded.error();
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
  for (const auto& group : by_offset) {  // named below: a lambda may not hold a binding (clang 14)
    const double offset_m = group.first;
    const std::vector<std::size_t>& which = group.second;
    Models moved;
    for (const std::size_t i : which) moved.push_back(models[i]);
    const auto replay_moved = [&](const Models& batch, std::size_t first) -> Status {
      ErrorPass pass(batch, rows.seconds, request.counted_s);
      const auto visitor = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
        pass.add(row, snapshot);
      };
      const auto summary = rows.replay(force_models(batch), visitor, offset_m);
      if (!summary) return summary.error();
      for (std::size_t i = 0; i < batch.size(); ++i) {
        result.models[which[first + i]].surface_moved = pass.errors(i);
        result.models[which[first + i]].predicted = pass.predicted(i);
      }
      return {};
    };
    if (const Status status = in_batches(moved, request.control, 0.5, replay_moved); !status) return status.error();
  }
  return result;
}

}  // namespace palpate
