#include "scenes/evaluation/evaluate.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>

#include "engine/base/statistics.h"
#include "engine/base/text.h"
#include "engine/tick/features.h"
#include "engine/tick/motion_estimator.h"

namespace palpate {
namespace {

constexpr double kStill_m_per_s = 0.002;  // the slowest speed that is a movement
// A loss of contact of at most this time does not end a stroke: noise at the surface causes it.
constexpr double kStrokePause_s = 0.05;

class Evaluator {
 public:
  Evaluator(const Recording& recording, const std::vector<EvaluatedModel>& models, const EvaluationRequest& request,
            Evaluation& pooled)
      : recording_(recording), models_(models), request_(request), pooled_(pooled) {}

  Status run() {
    if (pooled_.models.empty()) {
      pooled_.no_force = ModelErrors(models_.front().jnd);
      for (const EvaluatedModel& one : models_)
        pooled_.models.push_back({ModelErrors(one.jnd), ModelErrors(one.jnd), ModelErrors(one.jnd), {}});
    }
    pooled_.timing.emplace_back();
    pooled_.no_force.begin_recording();
    for (std::size_t i = 0; i < models_.size(); ++i) {
      pooled_.models[i].as_recorded.begin_recording();
      pooled_.models[i].surface_moved.begin_recording();
      pooled_.models[i].beginning_moved.begin_recording();
      const auto same = std::ranges::find_if(
          different_, [&](const Places& places) { return models_[places.front()].model == models_[i].model; });
      (same == different_.end() ? different_.emplace_back() : *same).push_back(i);
    }
    find_surfaces();
    std::map<double, std::vector<Places>> by_offset;
    for (const Places& places : different_) {
      const double offset_m = pooled_.models[places.front()].surfaces.back().at;
      if (offset_m != 0.0) by_offset[offset_m].push_back(places);
    }
    if (const Status status = replay_at(0.0, different_, request_.control.part(0.0, 0.5)); !status) return status;
    for (const auto& [offset_m, which] : by_offset) {
      if (const Status status = replay_at(offset_m, which, request_.control.part(0.5, 1.0)); !status) return status;
    }
    for (const Places& places : different_) {
      ModelEvaluation& first = pooled_.models[places.front()];
      if (!request_.move_beginning || first.began != kBeganAtRest) continue;
      const double offset_m = preload_offset_m(recording_, models_[places.front()]);
      for (const std::size_t i : places) pooled_.models[i].beginning_m = offset_m;
      if (offset_m == 0.0) continue;
      const Status status =
          replay_at(offset_m, {places}, request_.control.part(1.0, 1.0), &ModelEvaluation::beginning_moved);
      if (!status) return status;
    }
    return {};
  }

 private:
  using Places = std::vector<std::size_t>;  // of one model in `models_`

  void find_surfaces() {
    std::vector<Sample> rows;
    if (request_.move_surface) rows = thinned_rows(recording_, kSearchRows);
    const std::vector<ModelPointer>& common = request_.surface_models;
    const OffsetEstimate of_all = locate_surface(rows, common, models_.front().jnd);
    for (const Places& places : different_) {
      const EvaluatedModel& one = models_[places.front()];
      const OffsetEstimate surface = common.empty() ? locate_surface(rows, {one.model}, one.jnd) : of_all;
      for (const std::size_t i : places) pooled_.models[i].surfaces.push_back(surface);
    }
  }

  // Replays the recording with the models `which`, up to kMaxModels at a time. `only`: the errors to add to; null: all
  // with this offset.
  Status replay_at(double offset_m, const std::vector<Places>& which, const FitControl& control,
                   ModelErrors ModelEvaluation::*only = nullptr) {
    TimedSamples& timed = pooled_.timing.back();
    // Contact of each row, from the first of these groups, so that all models have the same samples.
    std::vector<bool> contact;
    for (std::size_t first = 0; first < which.size(); first += kMaxModels) {
      if (!control.may_continue(static_cast<double>(first) / static_cast<double>(which.size()))) return interrupted();
      const std::size_t count = std::min(kMaxModels, which.size() - first);
      ForceModels group;
      for (std::size_t k = 0; k < count; ++k) group.push_back(models_[which[first + k].front()].model);
      const bool is_first = first == 0 && offset_m == 0.0;
      std::size_t row_number = 0;
      double last_contact_s = -1e300;
      bool in_air = true;  // since the last row in contact
      const auto visitor = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
        if (is_first && request_.also) request_.also(row, snapshot, tick);
        if (is_first && snapshot.in_contact && timed.samples.size() < kTimedSamples)
          timed.samples.push_back(tool_sample(row));
        if (first == 0) contact.push_back(snapshot.in_contact);
        const bool in_contact = contact[row_number++];
        const bool begins = in_contact && in_air && row.time_s - last_contact_s > kStrokePause_s;
        in_air = !in_contact;
        if (in_contact) last_contact_s = row.time_s;
        if (!in_contact || row.time_s < request_.counted_from_s) return;
        const auto add = [&](ModelErrors& errors, double model_N, bool out_of_domain, double bound_N) {
          if (begins) errors.begin_stroke();
          errors.add(model_N, row.force_N, out_of_domain, bound_N);
        };
        if (is_first) add(pooled_.no_force, 0.0, false, kUnknown);
        for (std::size_t k = 0; k < count; ++k) {
          const bool out_of_domain = (snapshot.out_of_domain_mask >> k & 1U) != 0;
          const double model_N = snapshot.force_N[k], bound_N = snapshot.predicted_error_N[k];
          for (const std::size_t i : which[first + k]) {
            ModelEvaluation& to = pooled_.models[i];
            if (only != nullptr) add(to.*only, model_N, out_of_domain, bound_N);
            if (only != nullptr) continue;
            if (offset_m == 0.0) add(to.as_recorded, model_N, out_of_domain, bound_N);
            if (offset_m == to.surfaces.back().at) add(to.surface_moved, model_N, out_of_domain, bound_N);
          }
        }
      };
      const ReplaySummary summary = replay(recording_, group, visitor, offset_m, request_.after);
      for (std::size_t k = 0; offset_m == 0.0 && k < count; ++k)
        for (const std::size_t i : which[first + k]) pooled_.models[i].began = summary.began[k];
      if (is_first) {
        pooled_.samples += summary.samples;
        timed.sensor = summary.sensor;
      }
    }
    return {};
  }

  const Recording& recording_;
  const std::vector<EvaluatedModel>& models_;
  const EvaluationRequest& request_;
  Evaluation& pooled_;
  std::vector<Places> different_;
};

using Clock = std::chrono::steady_clock;
constexpr std::size_t kBlock = 64;

// Appends the mean time of `step(index)` over every block of indices below `count`.
template <typename Step>
void add_blocks(std::size_t count, std::vector<double>& means_ns, const Step& step) {
  const std::size_t block = std::min(count, kBlock);
  for (std::size_t first = 0; first + block <= count; first += block) {
    const auto start = Clock::now();
    for (std::size_t i = first; i < first + block; ++i) step(i);
    const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
    means_ns.push_back(elapsed.count() / static_cast<double>(block));
  }
}

// The mean times of one model's blocks of calls, in one round over all samples.
struct Round {
  std::vector<double> tick_ns;
  std::vector<double> evaluation_ns;
};

Round time_round(const ModelPointer& model, const std::vector<TimedSamples>& stretches) {
  Round round;
  double force_N = 0.0;
  for (const TimedSamples& stretch : stretches) {
    if (stretch.samples.empty()) continue;
    // A long time before, in air: a stream that begins in contact costs more (engine/tick/haptics_tick.h).
    ToolSample before = stretch.samples.front();
    before.time_s -= 1000.0;
    before.position_m = model->surface_m() - 1.0;
    // The first pass computes the features, and warms up caches and the processor's clock.
    std::vector<std::array<double, kMaxFeatures>> features;
    HapticsTick first(stretch.sensor, {model});
    first.step(before);
    for (const ToolSample& one : stretch.samples) {
      first.step(one);
      features.push_back(first.features_of(0).values);
    }
    HapticsTick tick(stretch.sensor, {model});
    tick.step(before);
    add_blocks(features.size(), round.tick_ns,
               [&](std::size_t i) { force_N = tick.step(stretch.samples[i]).force_N[0]; });
    add_blocks(features.size(), round.evaluation_ns, [&](std::size_t i) {
      std::array<double, kMaxFeatures> x = features[i];
      x[0] += 0.0 * force_N;  // adds 0; each call depends on the last, as in the tick
      force_N = model->force(x.data());
    });
  }
  // The forces must be used, or the compiler may remove the calls.
  volatile double wanted = force_N;
  static_cast<void>(wanted);
  return round;
}

std::vector<TimedSamples> own_strokes(const ForceModel& model) {
  const ProbingStrokes strokes(model);
  TimedSamples all;
  for (std::size_t i = 0; i < ProbingStrokes::kSamples; ++i) all.samples.push_back(strokes.at(i));
  return {all};
}

Timing timing_of(const std::vector<Round>& rounds, std::vector<double> Round::*times) {
  std::vector<double> medians, p99s;
  for (const Round& round : rounds) {
    medians.push_back(quantile_of(round.*times, 50));
    p99s.push_back(quantile_of(round.*times, 99));
  }
  return {quantile_of(medians, 50), quantile_of(medians, 0), quantile_of(medians, 100), quantile_of(p99s, 50)};
}

constexpr double kCoarseSearch_m = 0.1e-3;
constexpr double kMostCoarseSteps = 200.0;
constexpr double kSearchHuberLimit = 1.0;  // JND

using ForceErrors = std::vector<double>;  // model minus measured, N, by row

ForceErrors errors_of(const ForceModel& model, const std::vector<Sample>& rows, double offset_m) {
  FeatureFilter filter(model.features());
  ForceErrors errors(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ToolSample sample = rows[i].tool;
    MotionEstimate motion = rows[i].motion;
    sample.position_m -= offset_m;
    motion.position_m -= offset_m;
    const FeatureVector& vector = filter.update(sample, motion);
    const double force_N = vector.in_contact ? model.force(vector.values.data()) : 0.0;
    errors[i] = force_N - rows[i].force_N;
  }
  return errors;
}

}  // namespace

bool same_preload(double first_N, double other_first_N, const JndLine& jnd) {
  constexpr double kLeastPreload_N = 0.2, kSame_jnd = 3.0;
  return std::abs(first_N) > kLeastPreload_N && std::abs(other_first_N) > kLeastPreload_N &&
         std::abs(first_N - other_first_N) < kSame_jnd * jnd.at(first_N);
}

double preload_offset_m(const Recording& recording, const EvaluatedModel& model) {
  constexpr double kLeastMove = 0.02;
  const RecordingRow& first = recording.rows.front();
  const std::vector<RecordingEnds>& ends = model.model->ends();
  const auto away_N = [&](const RecordingEnds& one) { return std::abs(one.first_force_N - first.force_N); };
  const auto nearest = std::ranges::min_element(ends, {}, away_N);
  if (nearest == ends.end() || !same_preload(first.force_N, nearest->first_force_N, model.jnd) ||
      !in_contact(tool_sample(first), model.model->surface_m()))
    return 0.0;
  const double offset_m = first.position_m - nearest->first_position_m;
  return std::abs(offset_m) >= kLeastMove * model.model->deepest_m() ? offset_m : 0.0;
}

Recording with_force_zero(Recording recording, double force_zero_N) {
  for (RecordingRow& row : recording.rows) row.force_N -= force_zero_N;
  return recording;
}

Result<Evaluation> evaluate(const Recording& recording, const std::vector<EvaluatedModel>& models,
                            const EvaluationRequest& request, Evaluation pooled) {
  if (request.force_zero_N != 0.0) {
    EvaluationRequest same = request;
    same.force_zero_N = 0.0;
    return evaluate(with_force_zero(recording, request.force_zero_N), models, same, std::move(pooled));
  }
  if (const Status status = Evaluator(recording, models, request, pooled).run(); !status) return status.error();
  return pooled;
}

Motion motion_at(std::size_t at, std::size_t count,
                 const std::function<std::pair<double, double>(std::size_t)>& time_and_position) {
  constexpr double kSpan_s = 0.02;
  const auto velocity = [&](std::size_t i) {
    std::size_t from = i, to = i;
    const double time_s = time_and_position(i).first;
    while (from > 0 && time_s - time_and_position(from).first < 0.5 * kSpan_s) --from;
    while (to + 1 < count && time_and_position(to).first - time_s < 0.5 * kSpan_s) ++to;
    const auto [first_s, first_m] = time_and_position(from);
    const auto [last_s, last_m] = time_and_position(to);
    return last_s > first_s ? (last_m - first_m) / (last_s - first_s) : 0.0;
  };
  const auto still = [&](std::size_t i) { return std::abs(velocity(i)) < kStill_m_per_s; };
  Motion motion{time_and_position(at).second, velocity(at), 0.0};
  std::size_t begin = at;
  if (!still(at))
    while (begin > 0 && !still(begin)) --begin;
  const double end_s = time_and_position(begin).first;
  while (begin > 0 && still(begin)) --begin;
  motion.hold_s = end_s - time_and_position(begin).first;
  return motion;
}

std::string motion_words(const Motion& motion) {
  constexpr double kSlow_m_per_s = 0.008, kFast_m_per_s = 0.03, kLeastHold_s = 0.5;
  const double speed = std::abs(motion.velocity_m_per_s);
  const std::string depth = general(1e3 * motion.position_m, 2) + " mm", hold = general(motion.hold_s, 2) + " s";
  const bool held = motion.hold_s >= kLeastHold_s;
  if (speed < kStill_m_per_s) return "hold, " + depth + (held ? ", for " + hold : "");
  return std::string(speed < kSlow_m_per_s   ? "slow "
                     : speed > kFast_m_per_s ? "fast "
                                             : "") +
         (motion.velocity_m_per_s > 0.0 ? "press, " : "release, ") + depth + (held ? ", after a hold of " + hold : "");
}

std::vector<ModelTiming> time_models(const std::vector<ModelPointer>& models,
                                     const std::vector<TimedSamples>& stretches) {
  std::vector<ModelTiming> timings(models.size());
  const bool anything =
      std::any_of(stretches.begin(), stretches.end(), [](const TimedSamples& one) { return !one.samples.empty(); });
  if (!anything && !stretches.empty()) return timings;
  std::vector<std::vector<Round>> rounds(models.size());
  for (int round = 0; round < kTimingRounds; ++round) {
    for (std::size_t i = 0; i < models.size(); ++i)
      rounds[i].push_back(time_round(models[i], stretches.empty() ? own_strokes(*models[i]) : stretches));
  }
  for (std::size_t i = 0; i < models.size(); ++i)
    timings[i] = {timing_of(rounds[i], &Round::tick_ns), timing_of(rounds[i], &Round::evaluation_ns), true};
  return timings;
}

OffsetEstimate locate_surface(const std::vector<Sample>& rows, const std::vector<ModelPointer>& models,
                              const JndLine& jnd) {
  if (rows.empty() || models.empty()) return {};
  const auto [low_m, high_m] = position_range_m(rows);
  // The range reaches from a recording that is all in air to one that begins at the greatest depth of this one.
  const double reach_m = std::max({high_m - low_m, std::abs(low_m), std::abs(high_m)});
  const std::vector<std::size_t> blocks = blocks_by_path(rows);
  const auto errors_at = [&](double offset_m) {
    std::vector<ForceErrors> errors;
    for (const ModelPointer& model : models) errors.push_back(errors_of(*model, rows, offset_m));
    return errors;
  };
  // `force_offset_N`: of the measured force.
  const auto costs_of = [&](const std::vector<ForceErrors>& of_models, double force_offset_N) {
    BlockCosts costs(kBlocks, 0.0);
    for (const ForceErrors& errors : of_models)
      for (std::size_t i = 0; i < rows.size(); ++i)
        costs[blocks[i]] += huber((errors[i] + force_offset_N) / jnd.at(rows[i].force_N), kSearchHuberLimit);
    return costs;
  };
  const OffsetEstimate shift = estimate_offset(
      [&](double offset_m) { return costs_of(errors_at(offset_m), 0.0); },
      {-reach_m, reach_m, std::max(kCoarseSearch_m, 2.0 * reach_m / kMostCoarseSteps), kFinest_m, kWidestSurface_m});
  if (!shift.identified || !shift.not_zero) return shift;
  const std::vector<ForceErrors> unmoved = errors_at(0.0);
  double most_N = 0.0;
  for (const ForceErrors& errors : unmoved)
    for (const double error_N : errors) most_N = std::max(most_N, std::abs(error_N));
  return unless_force_offset(
      shift, [&](double offset_N) { return costs_of(unmoved, offset_N); }, most_N);
}

}  // namespace palpate
