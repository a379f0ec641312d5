#include "models/training/feature_selection.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "models/training/cross_validated_trend.h"
#include "models/training/memory_law.h"

namespace palpate {
namespace {

constexpr std::size_t kMostRows = 8000;
constexpr double kTimesPerDecade = 4.0;
constexpr double kShortest_s = 1e-3;
constexpr double kLongest_s = 100.0;
constexpr int kBands = 3;
constexpr std::array kThresholds_m{0.05e-3, 0.1e-3, 0.2e-3, 0.4e-3, 0.8e-3};
constexpr double kThresholdDepth_m = 4e-3;  // in shallower recordings they shrink with the depth
constexpr std::array kPeakTimes_s{0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
constexpr int kPressesForPeak = 3;  // of each recording
// A candidate that lowers the error by less ends the forward selection.
constexpr double kLeastGain = 0.003;

enum class Family { velocity, relaxation, stops, peak };

struct Candidate {
  Family family = Family::velocity;
  std::string name;
  ColumnList columns;
  std::vector<double> constants;  // times or thresholds
};

struct TimeScales {
  double sample_s = 0.0;
  double longest_recording_s = 0.0;
  int strokes = 0;
  int recordings = 0;
};

Result<TimeScales> measure_times(MotionSource& source, const FitControl& control, double fraction) {
  double start_s = 0.0;
  double last_s = 0.0;
  double duration_s = 0.0;
  std::size_t steps = 0;
  bool run_up = false;
  TimeScales scales;
  const Status status = source.for_each([&](const MotionRow& row) {
    scales.strokes = row.stroke;
    if (row.first) {
      ++scales.recordings;
      start_s = row.sample.time_s;
    } else if (!run_up && !row.run_up) {
      duration_s += row.sample.time_s - last_s;
      ++steps;
    }
    run_up = row.run_up;
    last_s = row.sample.time_s;
    scales.longest_recording_s = std::max(scales.longest_recording_s, last_s - start_s);
    return true;
  }, control, fraction);
  if (!status) return status.error();
  scales.sample_s = duration_s / static_cast<double>(std::max<std::size_t>(steps, 1));
  return scales;
}

std::vector<double> ladder(const TimeScales& scales) {
  const double shortest_s = std::max(kShortest_s, 2.0 * scales.sample_s);
  const double longest_s = std::min(kLongest_s, scales.longest_recording_s / 3.0);
  std::vector<double> times_s;
  const double ratio = std::pow(10.0, 1.0 / kTimesPerDecade);
  for (double time_s = shortest_s; time_s <= longest_s; time_s *= ratio) times_s.push_back(time_s);
  return times_s;
}

TrendTerms candidate_terms(const SelectionInput& input, const TimeScales& scales) {
  TrendTerms terms{input.reference_depth_m, input.rms_velocity_m_per_s, ladder(scales), {}, {}};
  const double shrink = std::min(1.0, input.reference_depth_m / kThresholdDepth_m);
  for (const double threshold_m : kThresholds_m) terms.stop_thresholds_m.push_back(shrink * threshold_m);
  // One press of a fresh material cannot tell a memory of its deepest depth from
  // other differences between the way in and the way out.
  const bool presses_again = scales.strokes >= kPressesForPeak * scales.recordings;
  for (const double time_s : kPeakTimes_s) {
    if (presses_again && time_s <= scales.longest_recording_s / 2.0) terms.peak_times_s.push_back(time_s);
  }
  return terms;
}

std::string range_text(const char* words, const std::vector<double>& values, double unit, const char* unit_name) {
  char text[96];
  if (values.size() == 1) {
    std::snprintf(text, sizeof text, "%s %.3g %s", words, unit * values.front(), unit_name);
  } else {
    std::snprintf(text, sizeof text, "%s %.3g-%.3g %s", words, unit * values.front(), unit * values.back(), unit_name);
  }
  return text;
}

void append_columns(ColumnList& columns, std::size_t first, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) columns.push_back(static_cast<Eigen::Index>(first + i));
}

std::vector<Candidate> make_candidates(const TrendRows& rows) {
  const TrendTerms& terms = rows.terms();
  std::vector<Candidate> candidates;
  Candidate velocity{Family::velocity, "velocity", {}, {}};
  append_columns(velocity.columns, rows.elastic_columns(), rows.viscous_columns());
  candidates.push_back(std::move(velocity));
  const std::size_t times = terms.relaxation_times_s.size();
  for (int band = 0; band < kBands; ++band) {
    Candidate one{Family::relaxation, "", {}, {}};
    for (std::size_t t = times * static_cast<std::size_t>(band) / kBands;
         t < times * static_cast<std::size_t>(band + 1) / kBands; ++t) {
      append_columns(one.columns, rows.first_branch() + t * rows.branch_terms(), rows.branch_terms());
      one.constants.push_back(terms.relaxation_times_s[t]);
    }
    if (one.constants.empty()) continue;
    one.name = range_text("relaxation", one.constants, 1.0, "s");
    candidates.push_back(std::move(one));
  }
  Candidate stops{Family::stops, range_text("stops", terms.stop_thresholds_m, 1e3, "mm"), {}, terms.stop_thresholds_m};
  append_columns(stops.columns, rows.first_stop(), kStopTerms * terms.stop_thresholds_m.size());
  candidates.push_back(std::move(stops));
  for (std::size_t p = 0; p < terms.peak_times_s.size(); ++p) {
    Candidate peak{Family::peak, range_text("fading peak", {terms.peak_times_s[p]}, 1.0, "s"), {},
                   {terms.peak_times_s[p]}};
    append_columns(peak.columns, rows.first_softening() + p * kSofteningTerms, kSofteningTerms);
    candidates.push_back(std::move(peak));
  }
  return candidates;
}

// The search over sets of candidates.
class Search {
 public:
  Search(const CrossValidatedTrend& problem, std::vector<Candidate> candidates, std::size_t elastic_columns)
      : problem_(problem), candidates_(std::move(candidates)), elastic_columns_(elastic_columns) {}

  using Set = std::vector<char>;  // by candidate: taken
  struct Scored {
    Set set;
    CrossValidation error;
  };

  const std::vector<Candidate>& candidates() const { return candidates_; }

  ColumnList columns(const Set& set) const {
    ColumnList list;
    append_columns(list, 0, elastic_columns_);
    for (std::size_t i = 0; i < set.size(); ++i) {
      if (set[i]) list.insert(list.end(), candidates_[i].columns.begin(), candidates_[i].columns.end());
    }
    return list;
  }

  Scored score(Set set, const CrossValidation* near) const {
    CrossValidation error = problem_.left_out(columns(set), near);
    return {std::move(set), std::move(error)};
  }

  // Whether `i` may join: one fading peak is enough.
  bool may_join(const Set& set, std::size_t i) const {
    if (set[i]) return false;
    if (candidates_[i].family != Family::peak) return true;
    for (std::size_t j = 0; j < set.size(); ++j) {
      if (set[j] && candidates_[j].family == Family::peak) return false;
    }
    return true;
  }

  // The best set that has one candidate more; nothing when there is none. Of sets as
  // good as the best, that of the more common cause: one press alone cannot tell
  // relaxation from friction and softening.
  std::optional<Scored> best_with_one_more(const Scored& from) const;

  std::optional<Scored> best_with_one_less(const Scored& from) const {
    std::optional<Scored> best;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (!from.set[i]) continue;
      Set set = from.set;
      set[i] = 0;
      Scored one = score(std::move(set), &from.error);
      if (!best || one.error.mean() < best->error.mean()) best = std::move(one);
    }
    return best;
  }

 private:
  const CrossValidatedTrend& problem_;
  std::vector<Candidate> candidates_;
  std::size_t elastic_columns_;
};

bool as_good(const Search::Scored& small, const Search::Scored& best) {
  return small.error.mean() - best.error.mean() <= small.error.standard_error_against(best.error);
}

std::optional<Search::Scored> Search::best_with_one_more(const Scored& from) const {
  constexpr std::array kByCause{Family::relaxation, Family::velocity, Family::stops, Family::peak};
  std::array<std::optional<Scored>, kByCause.size()> best_of;
  const Scored* best = nullptr;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (!may_join(from.set, i)) continue;
    Set set = from.set;
    set[i] = 1;
    Scored one = score(std::move(set), &from.error);
    const auto cause = std::find(kByCause.begin(), kByCause.end(), candidates_[i].family) - kByCause.begin();
    auto& so_far = best_of[static_cast<std::size_t>(cause)];
    if (!so_far || one.error.mean() < so_far->error.mean()) so_far = std::move(one);
  }
  for (const auto& one : best_of) {
    if (one && (best == nullptr || one->error.mean() < best->error.mean())) best = &*one;
  }
  if (best == nullptr) return std::nullopt;
  for (const auto& one : best_of) {
    const bool gains = one && one->error.mean() < (1.0 - kLeastGain) * from.error.mean();
    if (gains && as_good(*one, *best)) return one;
  }
  return *best;
}

Search::Scored smallest_as_good(const Search& search, std::vector<Search::Scored> path) {
  const auto best = std::min_element(path.begin(), path.end(), [](const auto& a, const auto& b) {
    return a.error.mean() < b.error.mean();
  });
  Search::Scored chosen = *std::find_if(path.begin(), path.end(), [&](const auto& one) { return as_good(one, *best); });
  while (auto less = search.best_with_one_less(chosen)) {
    if (!as_good(*less, *best)) break;
    chosen = std::move(*less);
  }
  return chosen;
}

std::vector<FeatureWorth> table_of_worth(const Search& search, const Search::Scored& chosen) {
  const double with_all = std::sqrt(chosen.error.mean());
  std::vector<FeatureWorth> taken;
  std::vector<FeatureWorth> left;
  std::optional<FeatureWorth> best_peak;
  for (std::size_t i = 0; i < search.candidates().size(); ++i) {
    const Candidate& candidate = search.candidates()[i];
    Search::Set other = chosen.set;
    if (chosen.set[i]) {
      other[i] = 0;
      const double without = std::sqrt(search.score(std::move(other), &chosen.error).error.mean());
      taken.push_back({candidate.name, true, with_all, without});
    } else if (search.may_join(chosen.set, i)) {
      other[i] = 1;
      const double with = std::sqrt(search.score(std::move(other), &chosen.error).error.mean());
      FeatureWorth worth{candidate.name, false, with, with_all};
      if (candidate.family != Family::peak) {
        left.push_back(std::move(worth));
      } else if (!best_peak || with < best_peak->error_with) {
        best_peak = std::move(worth);
      }
    }
  }
  if (best_peak) left.push_back(std::move(*best_peak));
  taken.insert(taken.end(), left.begin(), left.end());
  return taken;
}

// The constants of a candidate that carry something in the solution.
std::vector<double> in_use(const Candidate& candidate, const Eigen::VectorXd& solution) {
  const std::size_t terms = candidate.columns.size() / candidate.constants.size();
  std::vector<double> constants;
  for (std::size_t c = 0; c < candidate.constants.size(); ++c) {
    double largest = 0.0;
    for (std::size_t k = 0; k < terms; ++k) largest = std::max(largest, solution(candidate.columns[c * terms + k]));
    if (largest > 0.0) constants.push_back(candidate.constants[c]);
  }
  return constants;
}

FeatureList list_of(const Search& search, const Search::Set& set, const Eigen::VectorXd& solution, FeatureList list) {
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (!set[i]) continue;
    const Candidate& candidate = search.candidates()[i];
    if (candidate.family == Family::velocity) {
      list.velocity = true;
      continue;
    }
    std::vector<double> constants = in_use(candidate, solution);
    if (constants.empty()) continue;
    if (candidate.family == Family::relaxation) list.relaxation_times_s.push_back(std::move(constants));
    if (candidate.family == Family::stops) list.stop_thresholds_m = std::move(constants);
    if (candidate.family == Family::peak) list.peak_times_s = std::move(constants);
  }
  return list;
}

Status add_rows(TrendRows& rows, MotionSource& source, const FoldDealer& dealer, const FitControl& control,
                double fraction) {
  FoldDealer folds = dealer;
  return source.for_each([&](const MotionRow& row) {
    if (row.first) rows.begin_recording();
    const int fold = folds.next(row);
    if (row.run_up) rows.advance(row.sample, row.motion);
    else rows.add(row.sample, row.motion, row.force_N, fold);
    return true;
  }, control, fraction);
}

// Polynomials, or splines for the elastic response or for everything: of the bases
// within one standard error of the best the first.
Status choose_basis(FeatureSelection& selection, MotionSource& source, const FoldDealer& dealer,
                    const SelectionInput& input, const FitControl& control, double fraction) {
  struct Basis {
    FeatureList list;
    CrossValidation error;
    double training_error = 0.0;
  };
  std::vector<Basis> bases;
  FeatureList list = selection.list;
  if (list.surface.empty()) bases.push_back({list, {}});
  list.spline_elastic = true;
  bases.push_back({list, {}});
  list.spline_branches = true;
  if (!list.relaxation_times_s.empty()) bases.push_back({list, {}});
  for (Basis& basis : bases) {
    TrendRows rows(terms_of(basis.list, input.reference_depth_m, input.rms_velocity_m_per_s), kMostRows);
    if (Status status = add_rows(rows, source, dealer, control, fraction); !status) return status;
    ColumnList all;
    append_columns(all, 0, rows.columns());
    const CrossValidatedTrend problem(rows, dealer.folds(), input.weighting, input.jnd, input.force_floor_N);
    basis.error = problem.left_out(all);
    basis.training_error = problem.training_error(problem.solve(all));
  }
  const auto best = std::min_element(bases.begin(), bases.end(),
                                     [](const Basis& a, const Basis& b) { return a.error.mean() < b.error.mean(); });
  const auto chosen = std::find_if(bases.begin(), bases.end(), [&](const Basis& basis) {
    return basis.error.mean() - best->error.mean() <= basis.error.standard_error_against(best->error);
  });
  selection.list = chosen->list;
  selection.left_out_error_over_jnd = std::sqrt(chosen->error.mean());
  selection.training_error_over_jnd = std::sqrt(chosen->training_error);
  return {};
}

}  // namespace

Result<FeatureSelection> select_features(MotionSource& source, const FoldDealer& dealer, const SelectionInput& input,
                                         const FitControl& control, double fraction) {
  const auto scales = measure_times(source, control, fraction);
  if (!scales) return scales.error();
  TrendTerms terms = candidate_terms(input, *scales);
  FeatureSelection selection;
  std::vector<FeatureWorth> law_worth;
  if (input.turns_round) {
    auto law = find_memory_law(source, dealer, input, terms, control, fraction);
    if (!law) return law.error();
    selection.list.slowing = terms.slowing = law->slowing;
    selection.list.surface = terms.surface = law->surface;
    law_worth = std::move(law->worth);
    terms.spline_elastic = true;
  }
  TrendRows rows(std::move(terms), kMostRows);
  if (Status status = add_rows(rows, source, dealer, control, fraction); !status) return status.error();
  const CrossValidatedTrend problem(rows, dealer.folds(), input.weighting, input.jnd, input.force_floor_N);
  const Search search(problem, make_candidates(rows), rows.elastic_columns());

  std::vector<Search::Scored> path{search.score(Search::Set(search.candidates().size(), 0), nullptr)};
  selection.turns_round = input.turns_round;
  while (selection.turns_round) {
    auto more = search.best_with_one_more(path.back());
    if (!more) break;
    if (!control.may_continue(fraction)) return interrupted();
    const bool worthwhile = more->error.mean() < (1.0 - kLeastGain) * path.back().error.mean();
    if (!worthwhile) break;
    path.push_back(std::move(*more));
  }
  const Search::Scored chosen = smallest_as_good(search, std::move(path));

  const Eigen::VectorXd solution = problem.solve(search.columns(chosen.set));
  selection.list = list_of(search, chosen.set, solution, selection.list);
  if (const auto& times_s = rows.relaxation_times_s(); !times_s.empty()) {
    selection.shortest_s = times_s.front();
    selection.longest_s = times_s.back();
  }
  selection.worth = table_of_worth(search, chosen);
  for (const bool taken : {false, true}) {
    for (FeatureWorth& worth : law_worth) {
      if (worth.taken != taken) continue;
      selection.worth.insert(taken ? selection.worth.begin() : selection.worth.end(), std::move(worth));
    }
  }
  selection.left_out_error_over_jnd = std::sqrt(chosen.error.mean());
  selection.training_error_over_jnd = std::sqrt(problem.training_error(solution));
  if (selection.turns_round) {
    const Status chosen_basis = choose_basis(selection, source, dealer, input, control, fraction);
    if (!chosen_basis) return chosen_basis.error();
  }
  if (!control.may_continue(fraction)) return interrupted();
  return selection;
}

}  // namespace palpate
