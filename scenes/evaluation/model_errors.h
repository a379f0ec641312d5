// The errors of one model over the samples in contact: the definition of every figure of merit, and its
// confidence interval.
//
//   within the JND   share of the samples with |model - measured| <= JND(measured)
//   99 % error       the smallest error over the JND that 99 % of the samples do not exceed
//                    (nearest rank)
//   RMS, maximum     of |model - measured|
// Neighbouring samples are correlated, so intervals come from independent units: whole recordings where there are
// several, else strokes (from touch to release). With fewer than kLeastUnits units there is no interval.
//   99 % error       cluster bootstrap: kResamples times, as many whole units as there are are drawn with replacement,
//                    and the 99 % error of their samples is taken. The interval is the expanded percentile interval:
//                    between the quantiles of these 99 % errors at Phi(-sqrt(n / (n - 1)) t) and at 1 minus this, with
//                    t the 97.5 % quantile of Student's t with n - 1 degrees of freedom.
//   within the JND   the standard error of a ratio of means, and Student's t. If no unit has an error above one JND,
//                    the exact binomial bound applies: at the 95 % level at most 1 - 0.05^(1/n) of all units have one.
// All models draw the same units, so the 99 % errors of two models are compared draw by draw.
// Sources: Davison & Hinkley (1997), Bootstrap Methods and their Application, 2.4 and 3.8; Hesterberg (2015), The
// American Statistician 69; Cochran (1977), Sampling Techniques, 6.4; Clopper & Pearson (1934).
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/tick/jnd.h"
#include "scenes/evaluation/error_figures.h"

namespace palpate {

struct Interval {
  double low = 0.0;
  double high = 0.0;

  bool known() const { return std::isfinite(low) && std::isfinite(high); }
};
inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// With two units t is 12.7, and the interval would be useless.
inline constexpr std::size_t kLeastUnits = 3;
inline constexpr std::size_t kResamples = 2000;

// A loss of contact of at most this time does not end a stroke: noise at the surface causes it.
inline constexpr double kStrokePause_s = 0.05;

// The figures of merit over all samples and of each unit.
struct UnitErrors : ErrorSummary {
  bool units_are_recordings = false;  // false: units are strokes
  std::uint64_t units_above_jnd = 0;  // number of units with an error above one JND
  std::vector<double> unit_samples;
  std::vector<double> unit_within;   // samples within the JND
  std::vector<float> resampled_p99;  // 99 % errors of the draws of units; empty with fewer than kLeastUnits units

  std::size_t units() const { return unit_samples.size(); }
  bool has_intervals() const { return units() >= kLeastUnits; }
  // The following are NaN with fewer than kLeastUnits units.
  Interval p99_interval() const;  // 95 %, two-sided
  // 95 % lower bound of the share of samples within the JND; if units_above_jnd is 0, of the share of such units.
  double within_at_least() const;
};

// The 99 % error of one model minus that of another, in JND, over the same samples.
struct PairedDifference {
  double p99 = 0.0;
  Interval interval;  // 95 %, two-sided; NaN with fewer than kLeastUnits units
};
PairedDifference paired_difference(const UnitErrors& one, const UnitErrors& other);

// A model's predicted 95 % error bounds. All figures are NaN for a model without bounds.
struct BoundFigures {
  double coverage = kUnknown;         // share of the errors within the bound
  double median_N = kUnknown;         // of the bounds
  double median_over_jnd = kUnknown;  // of bound / JND; NaN where `median_N` exceeds the largest force: it says nothing

  bool has_bounds() const { return std::isfinite(coverage); }
};

// Detects the beginnings of strokes in one recording.
class StrokeCounter {
 public:
  // Call it for every row in time order. Returns true when the row begins a stroke.
  bool begins_stroke(double time_s, bool in_contact);

 private:
  double last_contact_s_ = -1e300;
  bool in_air_ = true;  // since the last row in contact
};

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
  BoundFigures bounds() const;

 private:
  JndLine jnd_;
  ErrorFigures figures_;
  std::vector<float> ratios_, bounds_N_, bounds_over_jnd_;
  std::size_t covered_ = 0;  // errors within the bound
  double largest_force_N_ = 0.0;
  // The index in `ratios_` of the first sample of each.
  std::vector<std::size_t> strokes_, recordings_;
};

}  // namespace palpate
