#include "scenes/report/judge.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/tick/replay.h"

namespace palpate {
namespace {

constexpr std::size_t kMostCoveragePoints = 20000;  // each kind, before the figure thins them

}  // namespace

Result<std::vector<ErrorSummary>> Jury::judge(const Recording& recording, const std::vector<ModelPointer>& models,
                                              const FitControl& control, double surface_offset_m) {
  std::vector<ErrorSummary> summaries;
  for (std::size_t first = 0; first < models.size(); first += kMaxModels) {
    if (!control.go_on(static_cast<double>(first) / static_cast<double>(models.size()))) return interrupted();
    const std::size_t count = std::min(kMaxModels, models.size() - first);
    const auto begin = models.begin() + static_cast<std::ptrdiff_t>(first);
    std::vector<ErrorStatistics> here(count, ErrorStatistics(jnd_));
    const auto replayed = replay(
        recording, ForceModels(begin, begin + static_cast<std::ptrdiff_t>(count)),
        [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
          if (!snapshot.in_contact) return;
          for (std::size_t i = 0; i < count; ++i) {
            const bool outside = (snapshot.out_of_domain_mask >> i & 1U) != 0;
            here[i].add(snapshot.force_N[i], row.force_N, outside);
            pooled_[first + i].add(snapshot.force_N[i], row.force_N, outside);
          }
        },
        surface_offset_m);
    if (!replayed) return replayed.error();
    for (const ErrorStatistics& one : here) summaries.push_back(one.summary());
  }
  return summaries;
}

std::vector<ErrorSummary> Jury::pooled() const {
  std::vector<ErrorSummary> summaries;
  for (const ErrorStatistics& one : pooled_) summaries.push_back(one.summary());
  return summaries;
}

BinnedErrors::BinnedErrors(double largest_force_N) : width_N_(1.0) {
  const double wanted = std::max(largest_force_N, 1e-6) / 12.0;
  const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double step : {1.0, 2.0, 5.0, 10.0}) {
    width_N_ = step * decade;
    if (width_N_ >= wanted) break;
  }
}

void BinnedErrors::add(double model_N, double measured_N) {
  const auto index = static_cast<std::size_t>(std::max(0.0, measured_N) / width_N_);
  while (bins_.size() <= index) {
    ErrorBin bin;
    bin.force_from_N = width_N_ * static_cast<double>(bins_.size());
    bin.force_to_N = width_N_ * static_cast<double>(bins_.size() + 1);
    bins_.push_back(bin);
  }
  ErrorBin& bin = bins_[index];
  const double error_N = std::abs(model_N - measured_N);
  ++bin.count;
  const double change = error_N - bin.mean_abs_error_N;  // Welford (1962)
  bin.mean_abs_error_N += change / static_cast<double>(bin.count);
  bin.std_abs_error_N += change * (error_N - bin.mean_abs_error_N);
  bin.max_abs_error_N = std::max(bin.max_abs_error_N, error_N);
}

std::vector<ErrorBin> BinnedErrors::bins() const {
  std::vector<ErrorBin> filled;
  for (ErrorBin bin : bins_) {
    if (bin.count == 0) continue;
    bin.std_abs_error_N = std::sqrt(bin.std_abs_error_N / static_cast<double>(bin.count));
    filled.push_back(bin);
  }
  return filled;
}

Status TraceFinder::look_at(const Recording& recording, const std::vector<ModelPointer>& models) {
  std::vector<TraceRow> rows;
  std::vector<double> squares;  // per row, summed over the models
  rows.reserve(recording.rows.size());
  const auto replayed = replay(recording, ForceModels(models.begin(), models.end()),
                               [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
                                 TraceRow trace;
                                 trace.time_s = row.time_s;
                                 trace.measured_N = row.force_N;
                                 trace.in_contact = snapshot.in_contact;
                                 double sum = 0.0;
                                 for (std::size_t i = 0; i < models.size(); ++i) {
                                   trace.force_N.push_back(static_cast<float>(snapshot.force_N[i]));
                                   const double ratio = jnd_.error_over_jnd(snapshot.force_N[i], row.force_N);
                                   if (snapshot.in_contact) sum += ratio * ratio;
                                 }
                                 rows.push_back(trace);
                                 squares.push_back(sum);
                               });
  if (!replayed) return replayed.error();
  // A window from `first` to `last`, both inside.
  double sum = 0.0;
  std::size_t contact = 0;
  std::size_t first = 0;
  std::size_t best_first = 0;
  std::size_t best_last = 0;
  double best = -1.0;
  const double whole_s = rows.back().time_s - rows.front().time_s;
  for (std::size_t last = 0; last < rows.size(); ++last) {
    sum += squares[last];
    contact += rows[last].in_contact ? 1 : 0;
    while (rows[last].time_s - rows[first].time_s > kTraceSeconds) {
      sum -= squares[first];
      contact -= rows[first].in_contact ? 1 : 0;
      ++first;
    }
    const bool full = first > 0 || (last + 1 == rows.size() && whole_s <= kTraceSeconds);
    // A window that is mostly air has few samples to be judged by.
    const double score = sum / static_cast<double>(std::max(contact, (last - first) / 4 + 1));
    if (full && score > best) {
      best = score;
      best_first = first;
      best_last = last;
    }
  }
  if (best > worst_score_) {
    worst_score_ = best;
    worst_.recording = recording.name;
    worst_.rows.assign(rows.begin() + static_cast<std::ptrdiff_t>(best_first),
                       rows.begin() + static_cast<std::ptrdiff_t>(best_last + 1));
  }
  return {};
}

CoverageFinder::CoverageFinder(const JndLine& jnd, std::vector<std::string> model_names, double largest_force_N)
    : names_(std::move(model_names)),
      inside_(names_.size(), ErrorStatistics(jnd)),
      outside_(names_.size(), ErrorStatistics(jnd)),
      bins_(names_.size(), BinnedErrors(largest_force_N)) {}

void CoverageFinder::add_sites(const TrainingSet& set) {
  if (coverage_.features.empty()) {
    for (const FeatureSpec& spec : set.features) coverage_.features.push_back(spec);
  }
  for (const TrainingSite& site : set.sites) coverage_.sites.push_back({site.features, site.force_N});
}

Status CoverageFinder::look_at(const Recording& recording, const std::vector<ModelPointer>& models) {
  const std::size_t reference = models.size() - 1;
  const auto replayed = replay(
      recording, ForceModels(models.begin(), models.end()),
      [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
        if (!snapshot.in_contact) return;
        const bool away = (snapshot.out_of_domain_mask >> reference & 1U) != 0;
        for (std::size_t i = 0; i < models.size(); ++i) {
          (away ? outside_ : inside_)[i].add(snapshot.force_N[i], row.force_N, away);
          bins_[i].add(snapshot.force_N[i], row.force_N);
        }
        auto& points = away ? coverage_.test_outside : coverage_.test_inside;
        points.push_back({tick.features_of(reference).values, row.force_N});
      });
  if (!replayed) return replayed.error();
  coverage_.test_inside = thinned(coverage_.test_inside, kMostCoveragePoints);
  coverage_.test_outside = thinned(coverage_.test_outside, kMostCoveragePoints);
  return {};
}

Coverage CoverageFinder::result() const {
  Coverage coverage = coverage_;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    coverage.errors.push_back({names_[i], inside_[i].summary(), outside_[i].summary()});
  }
  return coverage;
}

std::vector<CoveragePoint> thinned(const std::vector<CoveragePoint>& points, std::size_t most) {
  if (points.size() <= most) return points;
  std::vector<CoveragePoint> kept;
  for (std::size_t i = 0; i < most; ++i) kept.push_back(points[i * points.size() / most]);
  return kept;
}

}  // namespace palpate
