#include "scenes/report/measure.h"

#include <iterator>
#include <set>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "engine/base/text.h"
#include "engine/recording/recording.h"
#include "models/correction/methods.h"
#include "scenes/material/rig.h"

namespace palpate {
namespace {

constexpr double kPrepareSeconds = 1.0;   // estimate for one base
constexpr double kEvaluateSeconds = 0.1;  // estimate for one model
constexpr double kStretchSeconds = 5.0;   // length of the worst stretch
constexpr double kShownAir_s = 0.1;       // free air at the ends of the worst stretch

// `models`: up to kMaxModels. Samples before `counted_from_s` are replayed, but do not count.
// The replay has the force zero and the beginning of `request`.
TestCurves test_curves(const Recording& recording, const std::vector<ModelPointer>& models, const JndLine& jnd,
                       const EvaluationRequest& request) {
  TestCurves curves;
  curves.recording = &recording;
  std::vector<ComparedMoment>& rows = curves.moments;
  // Over the rows before each: the sum of (error / JND)^2 of the first model, and the samples in contact.
  std::vector<double> squares{0.0};
  std::vector<std::size_t> contacts{0};
  const auto visit = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
    if (row.time_s < request.counted_from_s) return;
    const bool contact = snapshot.in_contact;
    const double ratio = contact ? jnd.error_over_jnd(snapshot.force_N[0], row.force_N) : 0.0;
    squares.push_back(squares.back() + ratio * ratio);
    contacts.push_back(contacts.back() + (contact ? 1 : 0));
    const auto begin = snapshot.force_N.begin();
    rows.push_back({row.time_s, row.force_N, contact, {begin, begin + snapshot.model_count}});
  };
  replay(with_force_zero(recording, request.force_zero_N), models, visit, 0.0, request.after);
  const double length_s = std::min(kStretchSeconds, rows.back().time_s - rows.front().time_s);
  std::size_t first = 0;
  for (std::size_t last = 0; last < rows.size(); ++last) {
    if (rows[last].time_s - rows.front().time_s < length_s) continue;
    while (rows[last].time_s - rows[first].time_s > length_s) ++first;
    // A quarter of the window is the least divisor, so that a window with little contact has a low score.
    const std::size_t contact = std::max(contacts[last + 1] - contacts[first], (last - first) / 4 + 1);
    const double score = (squares[last + 1] - squares[first]) / static_cast<double>(contact);
    if (score <= curves.score) continue;
    curves.score = score;
    curves.first = first;
    curves.last = last;
  }
  // Leaves out the free air before the first contact of the stretch, and after the last.
  std::size_t begin = curves.first, end = curves.last;
  while (begin < end && !rows[begin].in_contact) ++begin;
  while (begin < end && !rows[end].in_contact) --end;
  while (rows[begin].time_s - rows[curves.first].time_s > kShownAir_s) ++curves.first;
  while (rows[curves.last].time_s - rows[end].time_s > kShownAir_s) --curves.last;
  return curves;
}

class Measurement {
 public:
  Measurement(ReportData& data, bool quick, const FitControl& control)
      : data_(data), models_(data.models), progress_(control, plan_models(quick)) {}

  Status run() {
    for (const Split& fold : data_.recordings.folds)
      for (const PreparedRecordingPointer& one : fold.tested) tares_ = tares_ || one->surface.force_zero_N != 0.0;
    for (const Split& fold : data_.recordings.folds) {
      if (const Status status = run_fold(fold); !status) return status;
    }
    for (ModelResult& one : models_) finish(one);
    models_.front().errors = evaluation_.no_force.unit_errors();
    if (models_.front().errors.samples == 0)
      return Error{
          "no sample of the test is in contact: none is beyond the surface of a model or has a certain force; " +
          std::string("test with a recording of the same rig and zero (palpate import FILE --zero contact)")};
    models_.front().moved = evaluation_.no_force.summary();
    std::vector<const PreparedRecording*> tested;
    for (const TestedRecording& one : data_.tested) tested.push_back(one.recording.get());
    data_.floor = noise_floor(tested, data_.scene.jnd);
    merge_seeds();
    merge_equal();
    time_all();
    data_.choice = choose(models_, data_.budget_ns);
    find_worst();
    return progress_.next(0.0).may_continue(1.0) ? Status{} : Status{interrupted()};
  }

 private:
  // Returns the expected time of the whole measurement, s.
  double plan_models(bool quick) {
    double total = 2.0 * kPrepareSeconds;
    models_.emplace_back();
    for (const ModelPlan& plan : all_plans()) {
      if (quick && !is_main(plan)) continue;
      for (const bool selects : {false, true}) {
        if (selects && (quick || !plan.selects_centres())) continue;
        for (std::uint64_t seed = 1; seed <= (plan.method->can_take(kTakesSeed) ? kSeeds : 1); ++seed) {
          ModelResult& model = models_.emplace_back();
          model.place = models_.size() - 2;  // the first model has none
          model.plan = plan;
          model.plan->seed = seed;
          model.selects_size = selects;
          total += plan.method->expected_seconds + kEvaluateSeconds;
        }
      }
    }
    return static_cast<double>(data_.recordings.folds.size()) * total;
  }

  bool first_fold() const { return data_.tested.empty(); }

  Result<MethodFit> fit_once(ModelFits& fits, const ModelPlan& plan) {
    for (const auto& [asked, fit] : fitted_) {
      if (asked == plan) return fit;
    }
    const double expected_s = plan.method->expected_seconds;
    auto one = fits.fit(plan, progress_.next(expected_s));
    if (!one && !progress_.next(0.0).may_continue(0.0)) return interrupted();
    if (!one) return Error{plan_name(plan) + ": " + one.error().message};
    if (first_fold() && one->choices)
      data_.choices.try_emplace(plan.selects_centres() ? plan.centres : 0, *one->choices);
    return fitted_.emplace_back(plan, std::move(*one)).second;
  }

  // The number of centres of this fold, from the cross-validated errors of random centres.
  Result<int> select_size(ModelFits& fits, Base base) {
    ErrorBySize errors;
    for (const int size : kSizes) {
      const auto one = fit_once(fits, {.base = base, .method = &kRandomMethod, .centres = size});
      if (!one) return one.error();
      errors.emplace_back(size, one->error_over_jnd);
    }
    if (first_fold()) data_.by_size[base] = errors;
    return std::ranges::min_element(errors, {}, &std::pair<int, double>::second)->first;
  }

  // Fits all planned models of one fold. Without a correction every model of Base::trend is the trend.
  Status fit(ModelFits& fits, bool corrects) {
    fitted_.clear();
    std::map<Base, int> sizes;
    for (ModelResult& result : models_) {
      if (!result.plan) continue;
      ModelPlan plan = *result.plan;
      if (plan.base == Base::trend && !corrects) plan = {.method = &kTrendMethod};
      if (result.selects_size && plan.selects_centres()) {
        if (sizes.count(plan.base) == 0) {
          const auto size = select_size(fits, plan.base);
          if (!size) return size.error();
          sizes[plan.base] = *size;
        }
        plan.centres = sizes[plan.base];
      }
      const auto one = fit_once(fits, plan);
      if (!one) return one.error();
      result.fit_seconds += one->seconds / static_cast<double>(data_.recordings.folds.size());
      result.model = one->model;
      result.rank = one->rank;
      const int size = result.model->centre_count();
      result.least_size = result.fits.empty() ? size : std::min(result.least_size, size);
      result.size = std::max(result.size, size);
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
    if (first_fold()) remember(**paper, **palpate);
    if (const Status done = fit(fits, (*palpate)->corrects()); !done) return done;
    count_contact(fold);
    for (const PreparedRecordingPointer& recording : fold.tested) {
      if (const Status status = evaluate_test(recording, fold.counted_from_s); !status) return status;
    }
    return {};
  }

  // With the models that are the first group of an evaluation. The models of its own test count for a recording.
  void count_contact(const Split& fold) {
    ForceModels first;
    for (const ModelResult& one : models_)
      if (one.model && first.size() < kMaxModels && std::ranges::count(first, ModelPointer(one.model)) == 0)
        first.push_back(one.model);
    const auto count = [&](const PreparedRecordingPointer& one) {
      const Recording tared = with_force_zero(one->recording, one->surface.force_zero_N);
      const RecordedContact contact(tared, first);
      return std::ranges::count_if(tared.rows, [&](const RecordingRow& row) { return contact.at(row); });
    };
    for (const PreparedRecordingPointer& one : fold.train) data_.contact.try_emplace(one.get(), count(one));
    for (const PreparedRecordingPointer& one : fold.tested) data_.contact[one.get()] = count(one);
  }

  void finish(ModelResult& result) const {
    if (!result.plan) return;
    const ModelEvaluation& found = evaluation_.models[result.place];
    result.errors = found.as_recorded.unit_errors();
    result.moved = found.surface_moved.summary();
    if (tares_) result.untared = untared_.models[result.place].as_recorded.summary();
    result.name = plan_name(*result.plan);
    if (!result.plan->selects_centres() || result.size == 0) return;
    // A fit has at most as many centres as sites; the name has the actual number.
    ModelPlan actual = *result.plan;
    actual.centres = result.size;
    result.name = plan_name(actual);
    if (!result.selects_size || result.least_size == result.size) return;
    actual.centres = result.least_size;
    result.name = plan_name(actual) + "-to-" + std::to_string(result.size);
  }

  void remember(const PreparedTraining& paper, const PreparedTraining& palpate) {
    data_.surfaces = palpate.common.provenance.offsets;
    data_.gains = palpate.gains;
    data_.corrects = palpate.corrects();
    data_.papers_times_s = relaxation_times_s(paper.common.features);
  }

  Status evaluate_test(const PreparedRecordingPointer& tested, double counted_from_s) {
    std::vector<EvaluatedModel> models;
    EvaluationRequest request{.counted_from_s = counted_from_s, .after = data_.after};
    for (const ModelResult& one : models_) {
      if (!one.model) continue;
      models.push_back({one.model, data_.scene.jnd});
      if (one.plan->base == Base::trend && is_main(*one.plan) &&
          std::ranges::count(request.surface_models, ModelPointer(one.model)) == 0)
        request.surface_models.push_back(one.model);
    }
    request.control = progress_.next(kEvaluateSeconds * static_cast<double>(models.size()));
    if (tares_) {
      EvaluationRequest as_recorded = request;
      as_recorded.move_surface = false;
      auto untared = evaluate(tested->recording, models, as_recorded, std::move(untared_));
      if (!untared) return untared.error();
      untared_ = std::move(*untared);
    }
    request.force_zero_N = tested->surface.force_zero_N;
    auto evaluated = evaluate(tested->recording, models, request, std::move(evaluation_));
    if (!evaluated) return evaluated.error();
    evaluation_ = std::move(*evaluated);
    data_.tested.push_back({tested, evaluation_.models.front().surfaces.back()});
    return {};
  }

  // Times the models of the last fold.
  void time_all() {
    std::vector<ModelPointer> fitted;
    for (const ModelResult& one : models_) {
      if (one.model) fitted.push_back(one.model);
    }
    const std::vector<ModelTiming> times = time_models(fitted, evaluation_.timing);
    auto time = times.begin();
    for (ModelResult& one : models_) {
      if (one.model) one.time = *time++;
    }
  }

  // Merges the models of one plan with several seeds: the median of each figure by itself, also draw by draw. Model,
  // time and bins are those of the seed with the median 99 % error.
  void merge_seeds() {
    const auto p99 = [](const ModelResult& one) { return one.errors.p99_error_over_jnd; };
    std::vector<ModelResult> kept;
    for (auto first = models_.begin(); first != models_.end();) {
      const auto last = std::find_if(first + 1, models_.end(),
                                     [](const ModelResult& one) { return !one.plan || one.plan->seed == 1; });
      std::ranges::stable_sort(first, last, {}, p99);
      ModelResult median = *(first + (last - first) / 2);
      median.seeds = static_cast<std::uint64_t>(last - first);
      // `of`: a reference to one figure of a model. Returns its least and greatest value.
      const auto take_median = [&](const auto& of) {
        std::vector<double> values;
        for (auto one = first; one != last; ++one) values.push_back(static_cast<double>(of(*one)));
        std::ranges::sort(values);
        auto& to = of(median);
        to = static_cast<std::remove_reference_t<decltype(to)>>(values[values.size() / 2]);
        return Interval{values.front(), values.back()};
      };
      median.within_range = take_median([](ModelResult& one) -> double& { return one.errors.within_jnd; });
      median.p99_range = take_median([](ModelResult& one) -> double& { return one.errors.p99_error_over_jnd; });
      take_median([](ModelResult& one) -> std::uint64_t& { return one.errors.out_of_domain_samples; });
      take_median([](ModelResult& one) -> std::uint64_t& { return one.errors.units_above_jnd; });
      for (const auto figure :
           {&ErrorSummary::rms_error_N, &ErrorSummary::max_error_N, &ErrorSummary::max_error_over_jnd})
        take_median([&](ModelResult& one) -> double& { return one.errors.*figure; });
      for (const auto figure :
           {&ErrorSummary::within_jnd, &ErrorSummary::p99_error_over_jnd, &ErrorSummary::rms_error_N})
        take_median([&](ModelResult& one) -> double& { return one.moved.*figure; });
      take_median([](ModelResult& one) -> double& { return one.untared.within_jnd; });
      take_median([](ModelResult& one) -> double& { return one.errors.bound.coverage; });
      take_median([](ModelResult& one) -> double& { return one.moved.bound.coverage; });
      for (std::size_t i = 0; i < median.errors.unit_within.size(); ++i)
        take_median([&](ModelResult& one) -> double& { return one.errors.unit_within[i]; });
      for (const auto draws : {&UnitErrors::drawn_units, &UnitErrors::drawn_strokes})
        for (const auto figure : {&Draws::within, &Draws::p99})
          for (std::size_t i = 0; i < (median.errors.*draws.*figure).size(); ++i)
            take_median([&](ModelResult& one) -> float& { return (one.errors.*draws.*figure)[i]; });
      kept.push_back(std::move(median));
      first = last;
    }
    models_ = std::move(kept);
  }

  // Merges models with equal forces into the first of them: without a correction every method equals the trend, and
  // with fewer sites than centres two sizes are equal.
  void merge_equal() {
    std::vector<ModelResult> kept;
    std::map<ModelPointer, ProbedForces> probed;
    for (const ModelResult& one : models_)
      for (const ModelPointer& fit : one.fits)
        if (!probed.contains(fit)) probed.emplace(fit, probed_forces(fit));
    const auto same = [&](const ModelPointer& a, const ModelPointer& b) { return probed.at(a) == probed.at(b); };
    for (ModelResult& one : models_) {
      const auto first = std::ranges::find_if(kept, [&](const ModelResult& other) {
        return one.model && other.model && std::ranges::equal(one.fits, other.fits, same);
      });
      if (first == kept.end()) {
        kept.push_back(std::move(one));
      } else if (first->name != one.name && std::ranges::count(first->same, one.name) == 0) {
        first->same.push_back(one.name);
      }
    }
    models_ = std::move(kept);
  }

  // The recommended model, the best one and the greedy method of the paper, and then those of the first table.
  std::vector<std::size_t> shown_models() const {
    std::vector<std::size_t> shown{data_.choice.recommended};
    const auto add = [&](std::size_t i) {
      if (i > 0 && shown.size() < kMaxModels && std::ranges::count(shown, i) == 0) shown.push_back(i);
    };
    add(data_.choice.best);
    for (std::size_t i = 1; i < models_.size(); ++i)
      if (models_[i].plan->base == Base::force && models_[i].plan->method == &kGreedyMethod && !models_[i].selects_size)
        add(i);
    for (const std::size_t i : headline_models(data_)) add(i);
    return shown;
  }

  void find_worst() {
    const std::vector<std::size_t> shown = shown_models();
    for (std::size_t fold = 0; fold < data_.recordings.folds.size(); ++fold) {
      std::vector<ModelPointer> models;
      for (const std::size_t i : shown) models.push_back(models_[i].fits[fold]);
      for (const PreparedRecordingPointer& recording : data_.recordings.folds[fold].tested) {
        TestCurves curves = test_curves(recording->recording, models, data_.scene.jnd,
                                        {.counted_from_s = data_.recordings.folds[fold].counted_from_s,
                                         .after = data_.after,
                                         .force_zero_N = recording->surface.force_zero_N});
        if (curves.score > data_.curves.score) data_.curves = std::move(curves);
      }
    }
    data_.curves.models = shown;
  }

  ReportData& data_;
  std::vector<ModelResult>& models_;
  Progress progress_;
  std::vector<std::pair<ModelPlan, MethodFit>> fitted_;  // of the current fold; several rows may have the same
  Evaluation evaluation_;                                // of all models but the first on all test recordings
  Evaluation untared_;                                   // the same with the forces as recorded, if `tares_`
  bool tares_ = false;                                   // a test recording has a force zero
};

}  // namespace

Result<ReportData> measure(const RecordingSet& recordings, const Scene& scene, bool quick, double budget_ns,
                           const FitControl& control, const Recording* after) {
  ReportData data{.scene = scene, .budget_ns = budget_ns, .recordings = recordings, .after = after};
  if (const Status status = Measurement(data, quick, control).run(); !status) return status.error();
  return data;
}

bool is_main(const ModelPlan& plan) {
  return plan.method == &kGreedyMethod ||
         (plan.base == Base::force ? plan.method != &kDirectMethod : plan.method == &kTrendMethod);
}

Ranking choose(const std::vector<ModelResult>& models, double budget_ns) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 1; i < models.size(); ++i) candidates.push_back(models[i].candidate());
  Ranking ranking = rank(candidates, budget_ns);
  ++ranking.best;
  ++ranking.recommended;
  ranking.as_good.insert(ranking.as_good.begin(), false);
  if (ranking.fastest_below_jnd) ++*ranking.fastest_below_jnd;
  return ranking;
}

std::vector<std::size_t> headline_models(const ReportData& data) {
  std::vector<std::size_t> rows{0};
  for (std::size_t i = 1; i < data.models.size(); ++i) {
    if (is_main(*data.models[i].plan) || i == data.choice.best || i == data.choice.recommended) rows.push_back(i);
  }
  return rows;
}

namespace {

constexpr std::size_t kLeakValues = 12;
constexpr std::size_t kSmallestRecording = 1000;  // rows; a shorter recording is not divided

// Each recording is tested once, with models that are fitted to the other folds.
std::vector<Split> folds_of(const std::vector<PreparedRecordingPointer>& all) {
  std::vector<Split> folds(std::min(kMostFolds, all.size()));
  for (Split& fold : folds) fold.words = std::to_string(folds.size()) + "-fold cross-validation over the training";
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t f = 0; f < folds.size(); ++f)
      (i % folds.size() == f ? folds[f].tested : folds[f].train).push_back(all[i]);
  }
  return folds;
}

using Forces = std::vector<double>;

Forces forces_of(const Recording& recording) {
  Forces forces_N;
  forces_N.reserve(recording.rows.size());
  for (const RecordingRow& row : recording.rows) forces_N.push_back(row.force_N + 0.0);
  return forces_N;
}

// The bytes of kLeakRows forces from `first` on.
std::string_view window_at(const Forces& forces_N, std::size_t first) {
  return {reinterpret_cast<const char*>(&forces_N[first]), kLeakRows * sizeof(double)};
}

// Whether the window has so many different forces that two recordings cannot have it in common by chance.
bool is_telling(const Forces& forces_N, std::size_t first) {
  const auto begin = forces_N.begin() + static_cast<std::ptrdiff_t>(first);
  return std::set<double>(begin, begin + static_cast<std::ptrdiff_t>(kLeakRows)).size() >= kLeakValues;
}

// The longest stretch of equal forces that contains these rows.
SharedStretch extended(const Forces& trained, const Forces& tested, std::size_t trained_row, std::size_t tested_row) {
  const auto known = trained.begin() + static_cast<std::ptrdiff_t>(trained_row);
  const auto asked = tested.begin() + static_cast<std::ptrdiff_t>(tested_row);
  const std::reverse_iterator before(known);
  const auto first = std::mismatch(before, trained.rend(), std::reverse_iterator(asked), tested.rend()).first.base();
  const auto last = std::mismatch(known, trained.end(), asked, tested.end()).first;
  const auto back = static_cast<std::size_t>(known - first);
  return {tested_row - back, trained_row - back, static_cast<std::size_t>(last - first)};
}

// A time of a recording, counted from its beginning.
std::string seconds(const Recording& recording, std::size_t row) {
  return three_digits(recording.rows[row].time_s - recording.rows.front().time_s);
}

// Splits off a block of up to 40 % at the end of a recording as test data (first_test_row). A recording of fewer than
// 1000 rows gives an empty split.
Split leave_out(const PreparedRecordingPointer& training) {
  Split split;
  const Recording& whole = training->recording;
  if (whole.rows.size() < kSmallestRecording) return split;
  const auto cut = whole.rows.begin() + static_cast<std::ptrdiff_t>(first_test_row(whole));
  split.train.push_back(prepare_recording({whole.name, whole.columns, {whole.rows.begin(), cut}}));
  split.tested.push_back(training);
  split.counted_from_s = cut->time_s;
  split.words = "a block at the end of the training recording, " +
                std::to_string(100 - 100 * split.train[0]->recording.rows.size() / whole.rows.size()) +
                " % of it, left out of these fits";
  return split;
}

// The first `trained` recordings of `all` are training data, the others test data; without others, all pairs are
// compared.
Status refuse_leakage(const std::vector<PreparedRecordingPointer>& all, std::size_t trained) {
  const bool tests = trained < all.size();
  for (std::size_t i = tests ? trained : 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < (tests ? trained : i); ++k) {
      const Recording& trained_on = all[k]->recording;
      const Recording& tested = all[i]->recording;
      const SharedStretch stretch = shared_stretch(trained_on, tested);
      if (stretch.rows == 0) continue;
      return Error{tested.name + ": the forces of " + std::to_string(stretch.rows) + " rows from " +
                   seconds(tested, stretch.first_row) + " s on are those of " + trained_on.name + " from " +
                   seconds(trained_on, stretch.trained_row) +
                   " s on, expected a test that was not trained on; leave that stretch out of one of them"};
    }
  }
  return {};
}

}  // namespace

Result<std::vector<PreparedRecordingPointer>> virtual_recordings(const std::string& material, double share) {
  std::vector<PreparedRecordingPointer> made;
  for (const double seconds : {41.499, 45.272}) {
    auto recording = record_sensors({material, made.size() + 1, share * seconds});
    if (!recording) return recording.error();
    made.push_back(prepare_recording(std::move(*recording)));
  }
  return made;
}

SharedStretch shared_stretch(const Recording& trained, const Recording& tested) {
  const Forces known = forces_of(trained);
  const Forces asked = forces_of(tested);
  // Compares every kLeakRows-th window of the first with all windows of the second.
  std::unordered_map<std::string_view, std::size_t> windows;
  for (std::size_t first = 0; first + kLeakRows <= known.size(); first += kLeakRows) {
    if (is_telling(known, first)) windows.try_emplace(window_at(known, first), first);
  }
  for (std::size_t first = 0; first + kLeakRows <= asked.size(); ++first) {
    const auto found = windows.find(window_at(asked, first));
    if (found != windows.end()) return extended(known, asked, found->second, first);
  }
  return {};
}

Result<RecordingSet> split_recordings(std::vector<PreparedRecordingPointer> train,
                                      std::vector<PreparedRecordingPointer> test) {
  RecordingSet set;
  const bool is_virtual = train.empty();
  // The result does not depend on the order in which the recordings are given.
  for (auto* recordings : {&train, &test}) {
    std::ranges::sort(*recordings, {}, [](const PreparedRecordingPointer& one) {
      return std::tie(one->recording.name, one->content_hash);
    });
  }
  std::vector<PreparedRecordingPointer>& all = set.all = std::move(train);
  if (is_virtual) {
    auto made = virtual_recordings("silicone");
    if (!made) return made.error();
    all = std::move(*made);
  }
  set.trained = is_virtual ? 1 : all.size();
  all.insert(all.end(), test.begin(), test.end());
  if (const Status status = refuse_leakage(all, set.trained); !status) return status.error();
  if (set.trained < all.size()) {
    Split& split = set.folds.emplace_back();
    for (std::size_t i = 0; i < all.size(); ++i) (set.is_tested(i) ? split.tested : split.train).push_back(all[i]);
  } else {
    set.folds = all.size() == 1 ? std::vector<Split>{leave_out(all.front())} : folds_of(all);
  }
  if (set.folds.front().tested.empty()) {
    const Recording& only = all.front()->recording;
    return Error{only.name + ": found " + std::to_string(only.rows.size()) +
                 " rows and no test recording, expected at least " + std::to_string(kSmallestRecording) +
                 " to leave a part out; give another recording with --test"};
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto pressed = [](const RecordingRow& row) { return row.position_m > 0.0; };
    if (!set.is_tested(i) || std::ranges::any_of(all[i]->recording.rows, pressed)) continue;
    return Error{all[i]->recording.name +
                 ": no sample is in contact (position_m > 0), expected a press to test on; check the "
                 "sign and zero of position_m"};
  }
  return set;
}

}  // namespace palpate
