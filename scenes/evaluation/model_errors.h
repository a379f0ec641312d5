// The errors of one model over the samples in contact: the definition of every figure of merit, their confidence
// intervals, and the choice of the best model by them.
//
//   within the JND   share of the samples with |model - measured| <= JND(measured)
//   99 % error       the smallest error over the JND that 99 % of the samples do not exceed
//                    (nearest rank)
//   RMS, maximum     of |model - measured|
// Every bin of the measured force is two just noticeable differences wide. With JND(F) = o + w F the number
// of JNDs between 0 and F is
//   u(F) = integral_0^F dF / JND = log(1 + w F / o) / w,   F / o where w is 0,
// and bin k holds the forces with k <= u / 2 < k + 1. With the paper's JND line this gives about
// 3 bins up to 0.3 N, 15 up to 6 N and 63 up to 3 kN.
// Neighbouring samples are correlated, so intervals come from independent units: whole recordings where there are
// several, else strokes (from touch to release). With fewer than kLeastUnits units there is no interval.
//   99 % error       cluster bootstrap: kResamples times, as many whole units as there are are drawn with replacement,
//                    and the 99 % error of their samples is taken. The interval is the expanded percentile interval:
//                    between the quantiles of these 99 % errors at Phi(-sqrt(n / (n - 1)) t) and at 1 minus this, with
//                    t the 97.5 % quantile of Student's t with n - 1 degrees of freedom.
//   within the JND   the standard error of a ratio of means, and Student's t. If no unit has an error above one JND,
//                    the exact binomial bound applies: at the 95 % level at most 1 - 0.05^(1/n) of all units have one.
// All models draw the same strokes, so two models are compared draw by draw.
// Sources: figures 4 to 7 of Hoever & Harders (2009); Davison & Hinkley (1997), Bootstrap Methods and their
// Application, 2.4 and 3.8; Hesterberg (2015), The American Statistician 69; Cochran (1977), Sampling Techniques, 6.4;
// Clopper & Pearson (1934).
// Thread guarantee: value types; slow side (allocates); one thread per object.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/tick/jnd.h"

namespace palpate {

// The one definition, as every page shows it.
inline constexpr const char* kJndDefinition =
    "One JND is the difference that people notice in three of four trials; 0.065 N + 6.33 % is the line of Hoever & "
    "Harders (2009), below their measured points.";

// Mean, population standard deviation and maximum of non-negative values, updated without cancellation. Without values
// all are 0.
// Source: Welford (1962).
class Moments {
 public:
  void add(double value);

  std::uint64_t count() const noexcept { return count_; }
  double mean() const noexcept { return mean_; }
  double deviation() const noexcept;
  double largest() const noexcept { return largest_; }

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;  // sum of squared deviations from the mean
  double largest_ = 0.0;
};

// The samples with force_from_N <= measured force < force_to_N.
struct ForceBin {
  double force_from_N = 0.0;
  double force_to_N = 0.0;
  double jnd_N = 0.0;  // at the middle of the bin
  Moments force_N;     // measured
  Moments error_N;     // absolute value
  Moments over_jnd;    // error / JND, computed sample by sample
  Moments relative;    // error / force, of the samples with a force other than 0
};

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// A model's predicted 95 % error bounds. All figures are NaN for a model without bounds.
struct BoundFigures {
  double coverage = kUnknown;         // share of the errors within the bound
  double median_N = kUnknown;         // of the bounds
  double median_over_jnd = kUnknown;  // of bound / JND; NaN where `median_N` exceeds the largest force: it says nothing

  bool has_bounds() const { return std::isfinite(coverage); }
};

// The figures of merit. Without samples every figure is 0 and `bins` is empty; check `samples` first.
struct ErrorSummary {
  std::uint64_t samples = 0;
  double rms_error_N = 0.0;
  double max_error_N = 0.0;
  double within_jnd = 0.0;  // share of the samples with an error up to one JND
  double p99_error_over_jnd = 0.0;
  double max_error_over_jnd = 0.0;
  std::uint64_t out_of_domain_samples = 0;
  std::vector<ForceBin> bins;  // from 0 to the largest measured force
  BoundFigures bound{};
};

class ErrorFigures {
 public:
  // Adds one sample in contact. Both forces are finite, and `jnd` is the same in every call.
  void add(double model_N, double reference_N, bool out_of_domain, const JndLine& jnd);

  std::uint64_t samples() const noexcept { return sum_.samples; }
  // Without samples the following figures are 0.
  double within_jnd() const noexcept { return share(within_); }  // share of the samples with an error up to one JND
  double mean_error_over_jnd() const noexcept { return share(ratios_); }
  double max_error_over_jnd() const noexcept { return sum_.max_error_over_jnd; }
  // All but the 99 % error and the bound, which need every sample.
  ErrorSummary summary(const JndLine& jnd) const;

 private:
  double share(double total) const noexcept { return total / std::max(1.0, static_cast<double>(sum_.samples)); }

  // Counts and largest errors. Of the bins, at most kMaximumForceBins, only the moments are set.
  ErrorSummary sum_;
  double within_ = 0.0;
  double squares_N2_ = 0.0;
  double ratios_ = 0.0;  // sum
};

struct Interval {
  double low = 0.0;
  double high = 0.0;

  bool known() const { return std::isfinite(low) && std::isfinite(high); }
};

// With two units t is 12.7, and the interval would be useless.
inline constexpr std::size_t kLeastUnits = 3;
inline constexpr std::size_t kResamples = 2000;

// The figures of the draws of units; empty with fewer than kLeastUnits units.
struct Draws {
  std::size_t units = 0;
  std::vector<float> within, p99;  // share within the JND, 99 % error over the JND
};

// The figures of merit over all samples and of each unit.
struct UnitErrors : ErrorSummary {
  bool units_are_recordings = false;  // false: units are strokes
  std::uint64_t units_above_jnd = 0;  // number of units with an error above one JND
  std::vector<double> unit_samples;
  std::vector<double> unit_within;  // samples within the JND
  Draws drawn_units, drawn_strokes;

  std::size_t units() const { return unit_samples.size(); }
  // The following are NaN with fewer than kLeastUnits units.
  Interval p99_interval() const;  // 95 %, two-sided
  // 95 % lower bound of the share of samples within the JND; if units_above_jnd is 0, of the share of such units.
  double within_at_least() const;
};

// The 95 % interval, two-sided, of the 99 % error of one model minus that of another over the same samples, JND; NaN
// with fewer than kLeastUnits strokes.
Interval p99_difference(const UnitErrors& one, const UnitErrors& other);

// Collects the errors of one model. It stores 4 bytes per sample, so that the 99 % error is exact, and 8 for a bound.
class ModelErrors {
 public:
  explicit ModelErrors(const JndLine& jnd) : jnd_(jnd) {}

  void begin_recording() { recordings_.push_back(ratios_.size()); }
  void begin_stroke() { strokes_.push_back(ratios_.size()); }
  // Adds one sample in contact to the stroke that began last. Both forces are finite. `bound_N`: the predicted bound of
  // the error; NaN: the model has none.
  void add(double model_N, double measured_N, bool out_of_domain, double bound_N = kUnknown);

  ErrorSummary summary() const;
  UnitErrors unit_errors() const;

 private:
  JndLine jnd_;
  ErrorFigures figures_;
  std::vector<float> ratios_, bounds_N_, bounds_over_jnd_;
  std::size_t covered_ = 0;  // errors within the bound
  double largest_force_N_ = 0.0;
  // The index in `ratios_` of the first sample of each.
  std::vector<std::size_t> strokes_, recordings_;
};

// A model to choose from. All are over the same samples.
struct Candidate {
  double within_jnd = 0.0, p99_error_over_jnd = 0.0;
  double tick_ns = 0.0;            // median
  const Draws* strokes = nullptr;  // null or empty: the sizes of the differences alone decide
};

inline constexpr double kManyWithin = 0.99;
// Smaller differences do not count: half a point of the share, and a tenth of what people notice.
inline constexpr double kLeastShare = 0.005, kLeastDifference_jnd = 0.1;
inline constexpr double kBudget_ns = 50e3;  // 5 % of the period of 1 ms

struct Ranking {
  std::size_t best = 0;         // the largest share, or the lowest 99 % error
  std::size_t recommended = 0;  // of the models that are not worse than `best`, the one with the shortest tick
  std::vector<bool> as_good;    // for each candidate: not worse than `best`, within the budget
  // The shortest tick of those whose 99 % error stays below the JND.
  std::optional<std::size_t> fastest_below_jnd;
};

// The one rule, as every page shows it.
inline constexpr const char* kBestRule =
    "The best model has the largest share of samples within one JND; where several have at least 99 %, the lowest 99 % "
    "error. Differences that a paired bootstrap over strokes does not tell from zero, or below 0.5 points and 0.1 JND, "
    "do not count; then the shortest tick decides.";
// A model below 99 % is compared with one of several above in both figures. A tick above `budget_ns` excludes a
// candidate, unless all are above. `candidates`: at least one, each with samples.
Ranking rank(const std::vector<Candidate>& candidates, double budget_ns = kBudget_ns);

// The sentence of the rule: "Use NAME: 99.9 % of the test is within one JND, a tick takes 0.33 us." Below
// kGoodShare it begins "No model is good enough; the rule takes NAME".
inline constexpr double kGoodShare = 0.9;
std::string recommendation(const std::string& name, const Candidate& of);
// "99.9 %", rounded down.
std::string share_text(double share);
// "0.33 us"
std::string tick_text(double tick_ns);

}  // namespace palpate
