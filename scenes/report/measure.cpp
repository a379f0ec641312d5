#include "scenes/report/measure.h"

#include <algorithm>
#include <utility>

#include "models/correction/methods.h"
#include "scenes/evaluation/ranking.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

constexpr double kPrepareSeconds = 1.0;   // estimate for one recipe
constexpr double kEvaluateSeconds = 0.1;  // estimate for one model

// Combines the progress of parts of different lengths, which are given in expected seconds.
class Progress {
 public:
  Progress(FitControl whole, double total) : whole_(std::move(whole)), total_(total) {}

  // Begins the next part and returns its control, which is valid until the next call.
  FitControl next(double seconds) {
    done_ += part_;
    part_ = seconds;
    return FitControl{
        [this](double fraction) { return whole_.may_continue(std::min(1.0, (done_ + part_ * fraction) / total_)); }};
  }

 private:
  FitControl whole_;
  double total_;
  double done_ = 0.0;
  double part_ = 0.0;
};

class Measurement {
 public:
  Measurement(ReportData& data, bool quick, const FitControl& control)
      : data_(data), models_(data.models), progress_(control, plan_models(quick)) {}

  Status run() {
    for (const Split& fold : data_.recordings.folds) {
      if (const Status status = run_fold(fold); !status) return status;
    }
    for (ModelResult& one : models_) finish(one);
    data_.floor = noise_floor(tested_, data_.scene.jnd);
    time_all();
    merge_equal();
    data_.choice = choose(models_);
    find_worst();
    // Frees the samples, hundreds of MB for long recordings: the figures are computed.
    for (ModelResult& one : models_) one.recorded_samples = one.moved_samples = ModelErrors(data_.scene.jnd);
    return progress_.next(0.0).may_continue(1.0) ? Status{} : Status{interrupted()};
  }

 private:
  // Returns the expected time of the whole measurement, s.
  double plan_models(bool quick) {
    double total = 2.0 * kPrepareSeconds;
    models_.emplace_back();
    for (const ModelPlan& plan : report_plans(quick, data_.scene.features.size())) {
      ModelResult& model = models_.emplace_back();
      model.plan = plan;
      model.name = plan_name(plan);
      total += plan.method->expected_seconds + kEvaluateSeconds;
    }
    for (ModelResult& model : models_) model.recorded_samples = model.moved_samples = ModelErrors(data_.scene.jnd);
    return static_cast<double>(data_.recordings.folds.size()) * total;
  }

  // Fits all planned models of one fold.
  Status fit(ModelFits& fits) {
    for (ModelResult& result : models_) {
      if (!result.plan) continue;
      auto one = fits.fit(*result.plan, progress_.next(result.plan->method->expected_seconds));
      if (!one && !progress_.next(0.0).may_continue(0.0)) return interrupted();
      if (!one) return Error{result.name + ": " + one.error().message};
      result.fit_seconds += one->seconds / static_cast<double>(data_.recordings.folds.size());
      result.model = std::make_shared<const FittedModel>(std::move(one->data));
      result.size = std::max(result.size, result.model->centre_count());
      result.fits.push_back(result.model);
    }
    return {};
  }

  Status run_fold(const Split& fold) {
    ModelFits fits(fold.train, training_scene(data_.scene));
    const auto paper = fits.prepare({.base = Base::force}, progress_.next(kPrepareSeconds));
    if (!paper) return paper.error();
    const auto palpate = fits.prepare({}, progress_.next(kPrepareSeconds));
    if (!palpate) return palpate.error();
    if (data_.gains.empty()) remember(**paper, **palpate);
    if (const Status fitted = fit(fits); !fitted) return fitted;
    for (const PreparedRecordingPointer& recording : fold.tested) {
      if (const Status status = evaluate_test(recording, fold.counted_from_s); !status) return status;
    }
    return {};
  }

  static void finish(ModelResult& result) {
    result.errors = result.recorded_samples.unit_errors();
    result.moved = result.moved_samples.summary();
    // A fit has at most as many centres as sites; the name has the actual number.
    if (!result.model || !result.plan->selects_centres() || result.size == 0) return;
    ModelPlan actual = *result.plan;
    actual.centres = result.size;
    result.name = plan_name(actual);
  }

  void remember(const PreparedTraining& paper, const PreparedTraining& palpate) {
    data_.surfaces = palpate.common.provenance.offsets;
    data_.gains = palpate.gains;
    if (palpate.correction) data_.corrects = palpate.correction->used;
    data_.papers_times_s = relaxation_times_s(paper.common.features);
  }

  Status evaluate_test(const PreparedRecordingPointer& tested, double counted_from_s) {
    std::vector<EvaluatedModel> models;
    EvaluationRequest request;
    request.counted_from_s = counted_from_s;
    for (const ModelResult& one : models_) {
      if (!one.model) continue;
      models.push_back({one.model, data_.scene.jnd});
      if (is_main(*one.plan) && one.plan->base == Base::trend) request.surface_models.push_back(one.model);
    }
    request.control = progress_.next(kEvaluateSeconds * static_cast<double>(models.size()));
    const auto result = evaluate(rows_of(tested->recording), models, request);
    if (!result) return result.error();
    auto errors = result->models.begin();
    for (ModelResult& one : models_) {
      one.recorded_samples.append(one.model ? errors->as_recorded : result->no_force);
      one.moved_samples.append(one.model ? errors->surface_moved : result->no_force);
      if (one.model) ++errors;
    }
    timing_.push_back(result->timing);
    data_.tested.push_back({tested->recording.name, result->models.front().surface.at});
    tested_.push_back(tested.get());
    return {};
  }

  // Times the models of the last fold.
  void time_all() {
    std::vector<ModelPointer> fitted;
    for (const ModelResult& one : models_) {
      if (one.model) fitted.push_back(one.model);
    }
    const std::vector<ModelTiming> times = time_models(fitted, timing_);
    auto time = times.begin();
    for (ModelResult& one : models_) {
      if (one.model) one.time = *time++;
    }
  }

  // Merges models with equal forces into the first of them: without a correction every method equals the trend, and
  // with fewer sites than centres two sizes are equal.
  void merge_equal() {
    std::vector<ModelResult> kept;
    for (ModelResult& one : models_) {
      const auto first = std::ranges::find_if(kept, [&](const ModelResult& other) {
        return one.model && other.model && other.recorded_samples.equals(one.recorded_samples);
      });
      if (first == kept.end()) {
        kept.push_back(std::move(one));
      } else if (first->name != one.name) {
        first->same.push_back(one.name);
      }
    }
    models_ = std::move(kept);
  }

  // Finds the worst stretch of the recommended model. Shows it with the greedy models of 2009 and the best model.
  void find_worst() {
    const Choice& choice = data_.choice;
    std::vector<std::size_t> shown{choice.recommended};
    for (const std::size_t i : choice.candidates) {
      if (i != choice.recommended && (i == choice.best || is_papers_greedy(*models_[i].plan))) shown.push_back(i);
    }
    for (std::size_t fold = 0; fold < data_.recordings.folds.size(); ++fold) {
      std::vector<ModelPointer> models;
      for (const std::size_t i : shown) models.push_back(models_[i].fits[fold]);
      for (const PreparedRecordingPointer& recording : data_.recordings.folds[fold].tested) {
        WorstStretch stretch =
            worst_stretch(recording->recording, models, data_.scene.jnd, data_.recordings.folds[fold].counted_from_s);
        if (stretch.score > data_.worst.score) data_.worst = std::move(stretch);
      }
    }
    data_.worst.models = std::move(shown);
  }

  ReportData& data_;
  std::vector<ModelResult>& models_;
  Progress progress_;
  std::vector<const PreparedRecording*> tested_;
  std::vector<TimedSamples> timing_;  // one per test recording
};

}  // namespace

WorstStretch worst_stretch(const Recording& recording, const std::vector<ModelPointer>& models, const JndLine& jnd,
                           double from_s) {
  std::vector<StretchRow> rows;
  // Over the rows before each: the sum of (error / JND)^2 of the first model, and the samples in contact.
  std::vector<double> squares{0.0};
  std::vector<std::size_t> contacts{0};
  const auto visitor = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
    if (row.time_s < from_s) return;
    const bool contact = snapshot.in_contact;
    const double ratio = contact ? jnd.error_over_jnd(snapshot.force_N[0], row.force_N) : 0.0;
    squares.push_back(squares.back() + ratio * ratio);
    contacts.push_back(contacts.back() + (contact ? 1 : 0));
    rows.push_back({row.time_s, row.force_N, contact, {}});
    rows.back().force_N.assign(snapshot.force_N.begin(), snapshot.force_N.begin() + snapshot.model_count);
  };
  WorstStretch worst;
  worst.recording = recording.name;
  replay(recording, models, visitor);
  const double length_s = std::min(kStretchSeconds, rows.back().time_s - rows.front().time_s);
  std::size_t first = 0;
  std::pair<std::size_t, std::size_t> stretch{0, rows.size() - 1};  // includes both rows
  for (std::size_t last = 0; last < rows.size(); ++last) {
    if (rows[last].time_s - rows.front().time_s < length_s) continue;
    while (rows[last].time_s - rows[first].time_s > length_s) ++first;
    // A quarter of the window is the least divisor, so that a window with little contact has a low score.
    const std::size_t contact = std::max(contacts[last + 1] - contacts[first], (last - first) / 4 + 1);
    const double score = (squares[last + 1] - squares[first]) / static_cast<double>(contact);
    if (score <= worst.score) continue;
    worst.score = score;
    stretch = {first, last};
  }
  worst.rows.assign(rows.begin() + static_cast<std::ptrdiff_t>(stretch.first),
                    rows.begin() + static_cast<std::ptrdiff_t>(stretch.second + 1));
  return worst;
}

Result<ReportData> measure(const RecordingSet& recordings, const Scene& scene, bool quick, const FitControl& control) {
  ReportData data;
  data.scene = scene;
  data.recordings = recordings;
  if (const Status status = Measurement(data, quick, control).run(); !status) return status.error();
  return data;
}

Choice choose(const std::vector<ModelResult>& models) {
  Choice choice;
  bool corrected = false;
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const ModelResult& one = models[i];
    corrected = corrected || (one.model && one.plan->base == Base::trend && one.plan->method != &kTrendMethod);
    if (!one.model || !is_main(*one.plan)) continue;
    choice.candidates.push_back(i);
    candidates.push_back({one.errors, one.time.tick});
  }
  const Ranking ranking = rank(candidates);
  choice.correction_off = !corrected;
  choice.best = choice.candidates[ranking.best];
  choice.recommended = choice.candidates[ranking.recommended];
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (ranking.qualified[i]) choice.qualified.push_back(choice.candidates[i]);
  }
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (!models[i].model || is_main(*models[i].plan)) continue;
    const UnitErrors& errors = models[i].errors;
    if (!dominates({errors, models[i].time.tick}, candidates[ranking.recommended])) continue;
    if (choice.dominating && errors.p99_error_over_jnd >= models[*choice.dominating].errors.p99_error_over_jnd)
      continue;
    choice.dominating = i;
  }
  return choice;
}

std::vector<std::size_t> headline_models(const ReportData& data) {
  std::vector<std::size_t> rows{0};
  rows.insert(rows.end(), data.choice.candidates.begin(), data.choice.candidates.end());
  return rows;
}

}  // namespace palpate
